"""Cells as they are laid out: GDS in, a SPICE subcircuit with measured transistors and parasitics out."""
