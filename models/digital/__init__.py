"""Bit-true models of everything digital: the RTL equals them bit for bit."""
