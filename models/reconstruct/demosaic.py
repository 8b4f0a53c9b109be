"""The samples of one pixel type lie a tile apart: gathered as small images, or spread over every pixel."""

import numpy as np


def edge_images(values, tile, read=None):
    """Values (rows, cols) by pixel type at tile resolution: (types, tile rows, tile cols), 0 where nothing was read.

    read: bool (rows, cols), pixels that were read; None = all. Tiles at the far edges may be partial.
    """
    rows, cols = values.shape
    high, wide = -(-rows // tile.rows), -(-cols // tile.cols)
    padded = np.zeros((high * tile.rows, wide * tile.cols), values.dtype)
    padded[:rows, :cols] = values if read is None else np.where(read, values, 0)
    by_place = padded.reshape(high, tile.rows, wide, tile.cols).transpose(1, 3, 0, 2).reshape(-1, high, wide)
    out = np.empty_like(by_place)
    out[list(tile.order)] = by_place
    return out


def demosaic(values, tile, read=None):
    """Every pixel type at every pixel, interpolated linearly between its own pixels: (types, rows, cols).

    values: (rows, cols). read: bool (rows, cols), pixels that were read, of each type whole rows by whole columns (as
    every scan reads); None = all. Outside a type's outermost pixels its nearest ones stand. A type without any pixel
    is 0.
    """
    rows, cols = values.shape
    kinds = tile.type_map(rows, cols)
    out = np.zeros((tile.n_types, rows, cols), values.dtype)
    for kind in range(tile.n_types):
        here = kinds == kind if read is None else (kinds == kind) & read
        lines, columns = np.flatnonzero(here.any(1)), np.flatnonzero(here.any(0))
        if len(lines):
            lattice = values[np.ix_(lines, columns)]
            out[kind] = _stretch(_stretch(lattice, lines, rows).T, columns, cols).T
    return out


def _stretch(lattice, places, length):
    """Rows of ``lattice`` at ``places`` -> rows at 0..length-1, linear between, constant outside."""
    at = np.interp(np.arange(length), places, np.arange(len(places), dtype=float))
    low = np.minimum(at.astype(int), len(places) - 1)
    high = np.minimum(low + 1, len(places) - 1)
    t = (at - low).astype(lattice.dtype)[:, None]
    return lattice[low] * (1 - t) + lattice[high] * t
