"""Depth field by time of flight through the chip: `talbot depth`."""
