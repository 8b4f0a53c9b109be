"""Angle and degree of polarization, and highlights, from a raw frame of the chip: `talbot polar`."""
