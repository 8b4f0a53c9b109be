"""Netlists: Yosys JSON, buffering, registers and their equivalence, macros, names."""
