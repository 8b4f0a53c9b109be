"""Rectangles by the square bins that they reach into, for compiled look-ups."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit

Ints = npt.NDArray[np.int32]


class Bins(NamedTuple):
    """Rectangles by bin: ids[first[bin] : first[bin + 1]] touch the bin column * rows + row."""

    left: int
    bottom: int
    side: int
    columns: int
    rows: int
    first: npt.NDArray[np.int64]
    ids: Ints


def binned(boxes: Ints, side: int) -> Bins:
    """``boxes``, (n, 4) left, bottom, right, top, in bins of ``side``, the same unit."""
    left, bottom, right, top = boxes[:, 0].min(), boxes[:, 1].min(), boxes[:, 2].max(), boxes[:, 3].max()
    columns, rows = int(right - left) // side + 1, int(top - bottom) // side + 1
    first, ids = _fill(boxes, int(left), int(bottom), side, columns, rows)
    return Bins(int(left), int(bottom), side, columns, rows, first, ids)


@njit(cache=True)
def _fill(
    boxes: Ints, left: int, bottom: int, side: int, columns: int, rows: int
) -> tuple[npt.NDArray[np.int64], Ints]:
    first = np.zeros(columns * rows + 2, np.int64)
    ids = np.empty(0, np.int32)
    for writing in (False, True):
        if writing:
            first = np.cumsum(first)
            ids = np.empty(first[-1], np.int32)
        for n in range(len(boxes)):
            for column in range((boxes[n, 0] - left) // side, (boxes[n, 2] - left) // side + 1):
                for row in range((boxes[n, 1] - bottom) // side, (boxes[n, 3] - bottom) // side + 1):
                    if writing:
                        ids[first[column * rows + row + 1]] = n
                        first[column * rows + row + 1] += 1
                    else:
                        first[column * rows + row + 2] += 1
    return first[:-1], ids


@njit(cache=True)
def at(boxes: Ints, levels: Ints, bins: Bins, level: int, x: int, y: int) -> int:
    """The rectangle of ``level`` around a point, or -1."""
    column, row = (x - bins.left) // bins.side, (y - bins.bottom) // bins.side
    if not (0 <= column < bins.columns and 0 <= row < bins.rows):
        return -1
    place = column * bins.rows + row
    for n in bins.ids[bins.first[place] : bins.first[place + 1]]:
        if levels[n] == level and boxes[n, 0] <= x <= boxes[n, 2] and boxes[n, 1] <= y <= boxes[n, 3]:
            return n
    return -1
