"""The depth that every view sees, for time of flight."""

import numpy as np

from .camera import DEPTH_MAX
from .views import view


def view_depths(scene, steps):
    """Depth in m at every pixel of every view, view after view: yields (v, u, (rows, cols)).

    scene: a Scene with depth. steps: offset of each view from the centre in view steps, (views,).
    The disparity is warped to the view, the nearest surface wins; inverse depth is affine in disparity.
    """
    known = None if scene.disparity is None else _inverse_depth(scene)
    image = np.zeros(scene.shape)
    for v, dv in enumerate(steps):
        for u, du in enumerate(steps):
            if known is None:
                yield v, u, scene.depth
                continue
            start, slope = known
            surface = view(image, np.asarray(scene.disparity, float), dv, du)[1]
            yield v, u, 1 / np.maximum(start + slope * surface, 1 / DEPTH_MAX)


def _inverse_depth(scene):
    """(a, b) of 1 / depth = a + b * disparity, from the nearest and the farthest pixel; None where all are alike."""
    disparity, inverse = np.ravel(scene.disparity), 1 / np.ravel(scene.depth)
    finite = inverse > 2 / DEPTH_MAX  # at infinity depth is cut off
    if not finite.any() or not np.ptp(disparity[finite]):
        return None
    near, far = np.argmax(np.where(finite, disparity, -np.inf)), np.argmin(np.where(finite, disparity, np.inf))
    slope = (inverse[near] - inverse[far]) / (disparity[near] - disparity[far])
    return inverse[near] - slope * disparity[near], slope
