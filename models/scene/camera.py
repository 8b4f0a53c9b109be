"""The camera in front of the sensor: depth, disparity and the time of flight share one geometry.

The focal length and the field of view are those of the Middlebury motorcycle pair [Scharstein2014] as scikit-image
ships it: 994.978 px, baseline 193.001 mm, the principal points 31.086 px apart, 500 x 741 px. All scenes use them.
"""

import numpy as np

FOCAL_LENGTH_PX = 994.978  # at the resolution of the stereo pair
BASELINE = 0.193001  # m
DOFFS_PX = 31.086
FIELD = (480, 720)  # px of the pair that fill the array: a margin stays for the outer views
APERTURE = BASELINE / 2  # m: width of the lens, all views together. Ours: it makes about -2..2 px a view step.
REFERENCE_DEPTH = 3.0  # m: where a scene without depth stands, and where disparity is 0

DEPTH_MAX = 1000.0  # m: stands for infinity


def zoom(sampling):
    """Pixels of the array a pixel of the stereo pair."""
    return max(sampling.rows / FIELD[0], sampling.cols / FIELD[1])


def _per_inverse_metre(sampling):
    return FOCAL_LENGTH_PX * zoom(sampling) * APERTURE / sampling.views


def disparity(depth, sampling):
    """Disparity of ``depth`` (m) against the reference plane, px a view step, positive towards the camera."""
    return _per_inverse_metre(sampling) * (1 / np.asarray(depth, float) - 1 / REFERENCE_DEPTH)


def depth(disparity_, sampling):
    """Depth in m of a disparity against the reference plane. What lies at or beyond infinity comes out as DEPTH_MAX."""
    inverse = np.asarray(disparity_, float) / _per_inverse_metre(sampling) + 1 / REFERENCE_DEPTH
    return 1 / np.maximum(inverse, 1 / DEPTH_MAX)
