"""A sequence of pictures through one running simulation of the chip: `talbot sequence`."""
