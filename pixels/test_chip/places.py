"""Places of the test chip's pixels: a tile, and a row without gratings, plain and covered with metal in turn."""

from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import TileParameters

ROWS, COLS = 5, 6
REFERENCE = ROWS - 1  # the row without gratings
PLAIN, COVERED = range(0, COLS, 2), range(1, COLS, 2)  # its columns


def by_type(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return the values (n, types, ...) of the tile's types from those of all places, (n, ROWS, COLS, ...)."""
    tile = values[:, :REFERENCE].reshape(len(values), -1, *values.shape[3:])
    return tile[:, np.argsort(TileParameters().order)]
