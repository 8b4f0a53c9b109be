"""The camera in front of the sensor: depth, disparity and time of flight share one geometry.

The focal length and the field of view are those of the Middlebury motorcycle pair [Scharstein2014] as scikit-image
ships it: 994.978 px, baseline 193.001 mm, the principal points 31.086 px apart, 500 x 741 px. All scenes use them.
"""

import numpy as np
import numpy.typing as npt

from .sampling import Sampling

FOCAL_LENGTH_PX = 994.978  # at the resolution of the stereo pair
BASELINE = 0.193001  # m
DOFFS_PX = 31.086
FIELD = (480, 720)  # px of the pair that fill the array; the rest is a margin for the outer views
APERTURE = BASELINE / 2  # m: width of the lens, all views together. Our choice: about -2..2 px per view step.
REFERENCE_DEPTH = 3.0  # m: depth of the reference plane (disparity 0), and of a scene without depth

DEPTH_MAX = 1000.0  # m: represents infinity


def zoom(sampling: Sampling) -> float:
    """Pixels of the array per pixel of the stereo pair.

    Parameters
    ----------
    sampling : Sampling
        Size of the array.

    Returns
    -------
    float
        Zoom.
    """
    return max(sampling.rows / FIELD[0], sampling.cols / FIELD[1])


def _per_inverse_metre(sampling: Sampling) -> float:
    return FOCAL_LENGTH_PX * zoom(sampling) * APERTURE / sampling.views


def disparity(depth: npt.ArrayLike, sampling: Sampling) -> npt.NDArray[np.float64]:
    """Disparity of a depth against the reference plane.

    Parameters
    ----------
    depth : array
        In m.
    sampling : Sampling
        Size of the array, and views.

    Returns
    -------
    float64
        In px per view step, positive towards the camera.
    """
    return _per_inverse_metre(sampling) * (1 / np.asarray(depth, float) - 1 / REFERENCE_DEPTH)


def depth(disparity_: npt.ArrayLike, sampling: Sampling) -> npt.NDArray[np.float64]:
    """Depth of a disparity against the reference plane.

    Parameters
    ----------
    disparity_ : array
        In px per view step, positive towards the camera.
    sampling : Sampling
        Size of the array, and views.

    Returns
    -------
    float64
        In m; DEPTH_MAX at and beyond infinity.
    """
    inverse = np.asarray(disparity_, float) / _per_inverse_metre(sampling) + 1 / REFERENCE_DEPTH
    return 1 / np.maximum(inverse, 1 / DEPTH_MAX)
