"""Depth map of every view, for time of flight."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from models.parameters import FOCUS_MAX

from .views import view


def view_depths(
    depth: npt.NDArray[np.floating], disparity: npt.NDArray[np.floating] | None, steps: npt.NDArray[np.float64]
) -> Iterator[tuple[int, int, npt.NDArray[np.floating]]]:
    """Depth at every pixel of every view, view after view.

    The disparity is warped to the view, the nearest surface wins; inverse depth is affine in disparity.

    Parameters
    ----------
    depth : array (rows, cols)
        Depth of the centre view in m.
    disparity : array (rows, cols) or None
        Disparity of the centre view in px per view step; None is the same depth in all views.
    steps : float64 (views,)
        Offset of each view from the centre in view steps.

    Yields
    ------
    v, u : int
        View row and column.
    depth : array (rows, cols)
        In m.
    """
    line = None if disparity is None else _inverse_depth(disparity, depth)
    image = np.zeros(depth.shape)
    for v, dv in enumerate(steps):
        for u, du in enumerate(steps):
            if disparity is None or line is None:
                yield v, u, depth
                continue
            start, slope = line
            surface = view(image, np.asarray(disparity, float), dv, du)[1]
            yield v, u, 1 / np.maximum(start + slope * surface, 1 / FOCUS_MAX)


def _inverse_depth(disparity: npt.NDArray[np.floating], depth: npt.NDArray[np.floating]) -> tuple[float, float] | None:
    """(a, b) of 1 / depth = a + b * disparity, from the nearest and the farthest pixel; None where all are equal."""
    disparity, inverse = np.ravel(disparity), 1 / np.ravel(depth)
    finite = inverse > 2 / FOCUS_MAX  # at infinity depth is cut off
    if not finite.any() or not np.ptp(disparity[finite]):
        return None
    near, far = np.argmax(np.where(finite, disparity, -np.inf)), np.argmin(np.where(finite, disparity, np.inf))
    slope = (inverse[near] - inverse[far]) / (disparity[near] - disparity[far])
    return inverse[near] - slope * disparity[near], slope
