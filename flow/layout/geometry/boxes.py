"""Shapes as arrays of boxes."""

import numpy as np


def boxes(region):
    """Array (n, 4) of int, left, bottom, right, top in database units: the merged ``region`` (KLayout's) in boxes."""
    found = [
        part.bbox()
        for polygon in region.merged().each()
        for part in ([polygon] if polygon.is_box() else polygon.decompose_trapezoids())
    ]
    return np.array([(p.left, p.bottom, p.right, p.top) for p in found], int).reshape(-1, 4)
