"""Shapes as arrays of boxes."""

import numpy as np
import numpy.typing as npt

from talbot.base.gds import db

GRID_NM = 5  # manufacturing grid of every process here
Box = tuple[int, int, int, int]  # left, bottom, right, top in database units
Boxes = npt.NDArray[np.int64]  # (n, 4) of the same, further columns possible


def corners(box: "db.Box") -> Box:
    """KLayout's ``box`` as a tuple."""
    return box.left, box.bottom, box.right, box.top


def on_grid(box: "db.Box") -> Box:
    """The smallest box around ``box`` on the grid: a check's edge may end where another one's space does."""
    low, high = (box.left // GRID_NM, box.bottom // GRID_NM), (-(-box.right // GRID_NM), -(-box.top // GRID_NM))
    return low[0] * GRID_NM, low[1] * GRID_NM, high[0] * GRID_NM, high[1] * GRID_NM


def boxes(region: "db.Region") -> Boxes:
    """The merged ``region`` in boxes: array (n, 4)."""
    found = []
    for polygon in region.merged().each():
        parts = [polygon] if polygon.is_box() else polygon.decompose_trapezoids()
        found += [corners(part.bbox()) for part in parts]
    return np.array(found, int).reshape(-1, 4)
