"""Pictures as scenes: a file, or a photograph that scikit-image brings, with or without depth."""

from pathlib import Path

import numpy as np
from skimage import data

from . import camera, resample
from .depth_file import read_disparity
from .picture_file import read_luminance
from .scene import Scene
from .targets import FOCUS
from .views import light_field

PHOTOGRAPHS = ("astronaut", "camera", "chelsea", "coffee", "coins", "moon", "page", "rocket", "text")


def photograph(name, sampling):
    """A photograph of scikit-image, on a plane."""
    codes = getattr(data, name)()
    return _on_depth(name, resample.linear(codes), sampling)


def picture(path, sampling, depth=None):
    """The image file ``path``; ``depth``: a file (models/scene/depth_file.py), or None for a plane."""
    luminance = read_luminance(path, *sampling.shape)
    disparity = None if depth is None else read_disparity(depth, sampling, luminance.shape)
    return _on_depth(Path(path).stem, luminance, sampling, disparity)


def _on_depth(name, luminance, sampling, raw=None):
    """raw: disparity against the reference plane, or None for a plane `FOCUS` px a step behind the focal plane."""
    rows, cols = sampling.shape
    image = resample.resize(luminance, rows, cols, resample.centre_box(*luminance.shape, rows, cols))
    image = np.clip(image, 0, 1)  # rounding of the resampling
    focus = sampling.focus_or(FOCUS if raw is None else 0.0)
    disparity = np.zeros(sampling.shape) - focus if raw is None else raw - focus
    flat = not disparity.any()
    field = image[None, None].astype(sampling.dtype) if flat else light_field(image, disparity, sampling)
    depth = camera.depth(np.zeros(sampling.shape) if raw is None else raw, sampling)
    return Scene(name, sampling.views, field, image.astype(sampling.dtype), disparity, depth)
