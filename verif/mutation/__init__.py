"""Mutants of the RTL, and whether the tests notice them."""
