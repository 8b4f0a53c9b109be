"""What wrappers need of the golden models, as Verilog."""

TABLES = {}
