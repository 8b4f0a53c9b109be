"""Conversion of depth and disparity by the camera of models/parameters/camera.py.

A scene's own metres are divided by the camera's scale: everything here and in a `Scene` is in metres from the camera.
"""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import FOCUS_MAX, CameraParameters
from talbot.models.scene.sampling import Sampling

REFERENCE = 3.0  # m of the scene: middle of the motorcycle and of the tilted plane
PLANE = 3.72  # m of the scene: where pictures without depth stand, 1 px a view step behind the default focal plane


def scaled(metres: npt.ArrayLike, camera: CameraParameters) -> npt.NDArray[np.float64]:
    """Convert metres of a scene to metres in front of the camera.

    metres: array, in m of the scene. camera: the camera. Returns float64: in m; at most FOCUS_MAX.
    """
    return np.minimum(np.asarray(metres, float) / camera.scale, FOCUS_MAX)


def per_inverse_metre(sampling: Sampling) -> float:
    """Disparity of a surface by how much nearer it is than the focal plane.

    sampling: views and camera. Returns float: in px per view step for each 1/m.
    """
    camera = sampling.camera
    return camera.principal_distance**2 * 2 * camera.nu_max / sampling.views / sampling.pitch


def disparity(depth: npt.ArrayLike, sampling: Sampling) -> npt.NDArray[np.float64]:
    """Disparity of a depth against the focal plane.

    depth: array, in m from the camera. sampling: views and camera. Returns float64: in px per view step, positive
    towards the camera.
    """
    return per_inverse_metre(sampling) * (1 / np.asarray(depth, float) - 1 / sampling.camera.focus)


def depth(disparity_: npt.ArrayLike, sampling: Sampling, reference: float | None = None) -> npt.NDArray[np.float64]:
    """Depth of a disparity.

    disparity_: array, in px per view step, positive towards the camera. sampling: views and camera. reference: depth of
    disparity 0 in m from the camera; None is the focal plane. Returns float64: in m; FOCUS_MAX at and beyond infinity.
    """
    start = 1 / (sampling.camera.focus if reference is None else reference)
    inverse = np.asarray(disparity_, float) / per_inverse_metre(sampling) + start
    return 1 / np.maximum(inverse, 1 / FOCUS_MAX)
