"""Scan orders: a frame's samples cut into segments, each coded by itself and closed by a mark."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.digital.scan import Scan
from talbot.models.parameters import FrameParameters, TileParameters, Window

MARK_BYTES = 2
Indices = npt.NDArray[np.integer]


@dataclass(frozen=True)
class Order:
    """A scan order. segments: function of (rows, cols, tile) -> list of flat indices, int arrays.

    buffer: what must be held before it can be sent in this order. lost: what a wrong byte costs.
    """

    segments: Callable[[int, int, TileParameters], list[Indices]]
    buffer: str
    lost: str


def _raster(rows: int, cols: int, tile: TileParameters) -> list[Indices]:
    return list(np.arange(rows * cols).reshape(rows, cols))


def _type_in_row(rows: int, cols: int, tile: TileParameters) -> list[Indices]:
    frame = FrameParameters(Window(0, -(-rows // tile.rows) - 1, 0, -(-cols // tile.cols) - 1))
    scan = Scan(rows, cols, 8, frame, tile)
    return [row * cols + scan.row_samples(row)[0] for row in range(rows)]


def _type_in_frame(rows: int, cols: int, tile: TileParameters) -> list[Indices]:
    types = tile.type_map(rows, cols).ravel()
    return [np.flatnonzero(types == kind) for kind in range(tile.n_types)]


def _tiles(rows: int, cols: int, tile: TileParameters) -> list[Indices]:
    row, col = np.divmod(np.arange(rows * cols), cols)
    order = np.lexsort((col % tile.cols, row % tile.rows, col // tile.cols, row // tile.rows))
    return np.split(order, np.flatnonzero(np.diff(row[order] // tile.rows)) + 1)


ORDERS = {
    "raster": Order(_raster, "a row", "a row"),
    "type by type in the row": Order(_type_in_row, "none", "a row"),
    "type by type in the frame": Order(_type_in_frame, "a frame", "a type"),
    "tile by tile": Order(_tiles, "4 rows", "4 rows"),
}
CHIP = "type by type in the row"


def segments_of(name: str, rows: int, cols: int, tile: TileParameters = TileParameters()) -> list[Indices]:
    """Every sample of a (rows, cols) array once, as flat indices by segment."""
    return ORDERS[name].segments(rows, cols, tile)
