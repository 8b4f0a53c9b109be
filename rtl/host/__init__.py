"""The host's side of the chip: its documents, and a driver in Python and one in C."""
