"""Documents for a host, generated from the register map, the chip's ports, the tile and the golden models."""
