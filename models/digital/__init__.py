"""Bit-true models of everything digital: what the RTL must equal, bit for bit."""
