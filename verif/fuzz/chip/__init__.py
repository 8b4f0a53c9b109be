"""Sessions of random traffic at the pins of the verilated chip, guided by coverage, against the golden models."""
