"""Depth in a view, for time of flight."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import FOCUS_MAX

Floats = npt.NDArray[np.floating]


def depth_of_surface(depth: Floats, disparity: Floats | None) -> Callable[[Floats], Floats]:
    """Depth as a function of disparity: inverse depth is affine in it.

    depth: (rows, cols), depth of the centre view in m. disparity: array (rows, cols) or None, disparity of the centre
    view in px per view step; None is the same depth in all views. Returns callable: from the disparity map of a view,
    (rows, cols), to its depth in m.
    """
    line = None if disparity is None else _inverse_depth(disparity, depth)
    if line is None:
        return lambda surface: depth
    start, slope = line
    return lambda surface: 1 / np.maximum(start + slope * surface, 1 / FOCUS_MAX)


def _inverse_depth(disparity: npt.NDArray[np.floating], depth: npt.NDArray[np.floating]) -> tuple[float, float] | None:
    """(a, b) of 1 / depth = a + b * disparity, from the nearest and the farthest pixel; None where all are equal."""
    disparity, inverse = np.ravel(disparity), 1 / np.ravel(depth)
    finite = inverse > 2 / FOCUS_MAX  # at infinity depth is cut off
    if not finite.any() or not np.ptp(disparity[finite]):
        return None
    near, far = np.argmax(np.where(finite, disparity, -np.inf)), np.argmin(np.where(finite, disparity, np.inf))
    slope = (inverse[near] - inverse[far]) / (disparity[near] - disparity[far])
    return inverse[near] - slope * disparity[near], slope
