"""A row of the sensor with its analog circuits in the loop of the chip's Verilog."""
