"""Blocks of the chip behind Tiny Tapeout's pins, in plain Verilog: a top a project, and the byte bus of all."""
