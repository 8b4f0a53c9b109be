"""The pixel array and the analog blocks: their behavior in SystemVerilog, and their footprints on the die."""
