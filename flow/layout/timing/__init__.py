"""Parasitics, STA, delays for simulation, and Liberty files."""
