"""Pictures as scenes: a file, or a photograph of scikit-image, with or without depth."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
from skimage import data

from . import camera, resample
from .depth_file import read_disparity
from .picture_file import read_luminance
from .sampling import Sampling
from .scene import Scene
from .targets import FOCUS
from .views import light_field

PHOTOGRAPHS = ("astronaut", "camera", "chelsea", "coffee", "coins", "moon", "page", "rocket", "text")


def photograph(name: str, sampling: Sampling) -> Scene:
    """Photograph of scikit-image, on a plane.

    Parameters
    ----------
    name : str
        One of PHOTOGRAPHS.
    sampling : Sampling
        Array, views and focal plane.

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
        Array, views and focal plane.
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
    disparity = None if depth is None else read_disparity(depth, sampling, luminance.shape)
    return _on_depth(Path(path).stem, luminance, sampling, disparity)


def _on_depth(
    name: str, luminance: npt.NDArray[np.float32], sampling: Sampling, raw: npt.NDArray[np.float64] | None = None
) -> Scene:
    """raw: disparity against the reference plane; None is a plane `FOCUS` px per step beyond the focal plane."""
    rows, cols = sampling.shape
    height, width = luminance.shape
    image = resample.resize(luminance, rows, cols, resample.centre_box(height, width, rows, cols))
    image = np.clip(image, 0, 1)  # rounding of the resampling
    focus = sampling.focus_or(FOCUS if raw is None else 0.0)
    disparity = np.zeros(sampling.shape) - focus if raw is None else raw - focus
    flat = not disparity.any()
    field = image[None, None].astype(sampling.dtype) if flat else light_field(image, disparity, sampling)
    depth = camera.depth(np.zeros(sampling.shape) if raw is None else raw, sampling)
    return Scene(name, sampling.views, field, image.astype(sampling.dtype), disparity, depth)
