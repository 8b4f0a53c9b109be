"""Blocks of the chip behind Tiny Tapeout's pins, in plain Verilog: a top per project, and their byte bus."""
