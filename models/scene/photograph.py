"""Pictures as scenes: a file, or a photograph of scikit-image, with or without depth."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
from skimage import data

from . import camera, resample
from .depth_file import read_depth
from .picture_file import read_luminance
from .sampling import Sampling
from .scene import Scene
from .targets import IN_FOCUS, plane
from .views import Pictured

PHOTOGRAPHS = ("astronaut", "camera", "chelsea", "coffee", "coins", "moon", "page", "rocket", "text")


def photograph(name: str, sampling: Sampling) -> Scene:
    """Photograph of scikit-image, on a plane.

    Parameters
    ----------
    name : str
        One of PHOTOGRAPHS.
    sampling : Sampling
        Array, views and camera.

    Returns
    -------
    Scene
        With constant disparity and depth.
    """
    codes = getattr(data, name)()
    return _on_depth(name, resample.linear(codes), sampling)


def picture(path: str | Path, sampling: Sampling, depth: str | Path | None = None) -> Scene:
    """Image file as a scene.

    Parameters
    ----------
    path : path
        The image.
    sampling : Sampling
        Array, views and camera.
    depth : path, optional
        A depth file (models/scene/depth_file.py); None is a plane.

    Returns
    -------
    Scene
        With disparity and depth.

    Raises
    ------
    ParameterError
        For a file that is missing, damaged or of a wrong shape.
    """
    luminance = read_luminance(path, *sampling.shape)
    metres = None if depth is None else read_depth(depth, sampling, luminance.shape)
    return _on_depth(Path(path).stem, luminance, sampling, metres)


def _on_depth(
    name: str, luminance: npt.NDArray[np.float32], sampling: Sampling, depth: npt.NDArray[np.float64] | None = None
) -> Scene:
    """depth: in m from the camera; None is the plane of pictures without depth."""
    rows, cols = sampling.shape
    height, width = luminance.shape
    image = resample.resize(luminance, rows, cols, resample.centre_box(height, width, rows, cols))
    image = np.clip(image, 0, 1)  # rounding of the resampling
    if depth is None:
        _, depth = plane(sampling)
    disparity = camera.disparity(depth, sampling)
    flat = bool(np.abs(disparity).max() * sampling.views < IN_FOCUS)
    seen = None if flat else Pictured(image, disparity, sampling)
    field = image[None, None].astype(sampling.dtype) if seen is None else seen.light_field()
    return Scene(name, sampling.views, field, image.astype(sampling.dtype), disparity, depth, render=seen)
