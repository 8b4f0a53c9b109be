"""Shapes as arrays of boxes."""

import numpy as np
import numpy.typing as npt

from talbot.base.gds import db

Box = tuple[int, int, int, int]  # left, bottom, right, top in database units
Boxes = npt.NDArray[np.int64]  # (n, 4) of the same, further columns possible


def corners(box: "db.Box") -> Box:
    """KLayout's ``box`` as a tuple."""
    return box.left, box.bottom, box.right, box.top


def boxes(region: "db.Region") -> Boxes:
    """The merged ``region`` in boxes: array (n, 4)."""
    found = []
    for polygon in region.merged().each():
        parts = [polygon] if polygon.is_box() else polygon.decompose_trapezoids()
        found += [corners(part.bbox()) for part in parts]
    return np.array(found, int).reshape(-1, 4)
