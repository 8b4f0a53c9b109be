"""Subjects of a layout: shapes, floorplan, macros, fill, labels, decks, antennas."""
