"""Cells and gate equivalents of every block: Yosys with the abstract library cells/gates.lib."""
