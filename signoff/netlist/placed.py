"""Orientations of cells in rows, by the numbers that a placement has for them."""

TURNS = {"0": "R0", "2": "R180", "4": "M90", "6": "M0"}  # KLayout's transformations
MIRRORED = {"0": (1, 1), "2": (-1, -1), "4": (-1, 1), "6": (1, -1)}  # factors of x and y
