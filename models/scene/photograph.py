"""Pictures as scenes: a file, or a photograph of scikit-image, with or without depth."""

from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.models.scene import camera, of_skimage, resample
from talbot.models.scene.depth_file import read_depth
from talbot.models.scene.picture_file import read_luminance
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import Scene
from talbot.models.scene.targets import IN_FOCUS, plane
from talbot.models.scene.views import Pictured, Shifted

PHOTOGRAPHS = ("astronaut", "camera", "chelsea", "coffee", "coins", "moon", "page", "rocket", "text")


def photograph(name: str, sampling: Sampling) -> Scene:
    """Photograph of scikit-image, on a plane.

    name: one of PHOTOGRAPHS. sampling: array, views and camera. Returns Scene: with constant disparity and depth.
    """
    return scene_of(name, resample.linear(of_skimage.codes(name)), sampling)


def picture(path: str | Path, sampling: Sampling, depth: str | Path | None = None) -> Scene:
    """Image file as a scene.

    path: the image. sampling: array, views and camera. depth: a depth file (models/scene/depth_file.py); None is a
    plane. Returns Scene: with disparity and depth. Raises ParameterError for a file that is missing, damaged or of a
    wrong shape.
    """
    luminance = read_luminance(path, *sampling.shape)
    metres = None if depth is None else read_depth(depth, sampling, luminance.shape)
    return scene_of(Path(path).stem, luminance, sampling, metres)


def scene_of(
    name: str, luminance: npt.NDArray[np.floating], sampling: Sampling, depth: npt.NDArray[np.float64] | None = None
) -> Scene:
    """Linear luminance as a scene.

    name: name in reports. luminance: (height, width), 0..16, 1 = diffuse white. The largest centred part with the
    array's proportions is taken. sampling: array, views and camera. depth: (rows, cols), in m from the camera; None is
    the plane of pictures without depth. Returns Scene: with disparity and depth.
    """
    rows, cols = sampling.shape
    height, width = luminance.shape
    image = resample.resize(luminance, rows, cols, resample.centre_box(height, width, rows, cols))
    image = np.clip(image, 0, max(1.0, float(luminance.max())))  # rounding of the resampling
    disparity, depth = plane(sampling) if depth is None else (camera.disparity(depth, sampling), depth)
    shown = image.astype(sampling.dtype)
    if np.abs(disparity).max() * sampling.views < IN_FOCUS:
        return Scene(name, sampling.views, shown[None, None], shown, disparity, depth)
    seen = Pictured(image, disparity, sampling) if np.ptp(disparity) else Shifted(image, float(disparity.flat[0]))
    return Scene(name, sampling.views, None, shown, disparity, depth, render=seen)
