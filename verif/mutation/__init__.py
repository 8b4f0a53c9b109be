"""Mutants of the RTL, and whether the tests detect them."""
