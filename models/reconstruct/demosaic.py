"""Samples by pixel type: gathered as small images at tile resolution, or interpolated to every pixel."""

from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import TileParameters


def edge_images(
    values: npt.NDArray[Any], tile: TileParameters, read: npt.NDArray[np.bool_] | None = None
) -> npt.NDArray[Any]:
    """Images of the pixel types at tile resolution.

    values: (rows, cols), samples. Tiles at the far edges may be partial. tile: the tile. read: (rows, cols), pixels
    that are read; None is all. Returns (types, tile rows, tile cols), 0 where nothing is read.
    """
    rows, cols = values.shape
    high, wide = -(-rows // tile.rows), -(-cols // tile.cols)
    padded = np.zeros((high * tile.rows, wide * tile.cols), values.dtype)
    padded[:rows, :cols] = values if read is None else np.where(read, values, 0)
    by_place = padded.reshape(high, tile.rows, wide, tile.cols).transpose(1, 3, 0, 2).reshape(-1, high, wide)
    out = np.empty_like(by_place)
    out[list(tile.order)] = by_place
    return out


def demosaic(
    values: npt.NDArray[np.floating], tile: TileParameters, read: npt.NDArray[np.bool_] | None = None
) -> npt.NDArray[np.floating]:
    """Interpolate every pixel type linearly between its own pixels.

    values: (rows, cols), samples. tile: the tile. read: (rows, cols), pixels that are read, of each type whole rows by
    whole columns, as in every scan; None is all. Returns (types, rows, cols), constant outside a type's outermost
    pixels; 0 for a type without any pixel.
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


def _stretch(lattice: npt.NDArray[np.floating], places: npt.NDArray[np.int64], length: int) -> npt.NDArray[np.floating]:
    """Interpolate rows at ``places`` to rows at 0..length-1: linear between, constant outside."""
    at = np.interp(np.arange(length), places, np.arange(len(places), dtype=float))
    low = np.minimum(at.astype(int), len(places) - 1)
    high = np.minimum(low + 1, len(places) - 1)
    t = (at - low).astype(lattice.dtype)[:, None]
    return lattice[low] * (1 - t) + lattice[high] * t
