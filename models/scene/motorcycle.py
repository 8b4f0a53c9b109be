"""The Middlebury motorcycle pair of scikit-image [Scharstein2014] as a light field: the default scene."""

import numpy as np
from skimage.data import stereo_motorcycle

from . import camera, resample, warp
from .scene import Scene
from .views import Second, light_field


def motorcycle(sampling):
    """The pair's left picture as the centre view, its measured disparity, the right picture behind the edges."""
    left, right, measured = stereo_motorcycle()
    zoom = camera.zoom(sampling)
    measured = np.ascontiguousarray(measured, float)
    unknown = ~np.isfinite(measured)
    measured[unknown] = 0
    warp.fill_rows(measured, unknown)
    inverse_depth = (measured + camera.DOFFS_PX) / (camera.FOCAL_LENGTH_PX * camera.BASELINE)

    focus = sampling.focus_or(0.0)
    disparity = camera.disparity(1 / inverse_depth, sampling) - focus
    margin = _margin(measured.shape, disparity, sampling, zoom)
    crop = _Crop(measured.shape, sampling, zoom, margin)
    disparity = crop(disparity, resample.pick)
    image = crop(resample.linear(left), resample.resize)

    # A pixel of the left picture lies measured * zoom to the left in the right one, whose crop
    # starts `start` px further left so that it holds what the left crop shows.
    scale = camera.BASELINE * sampling.views / camera.APERTURE
    offset = (focus - camera.disparity(np.inf, sampling)) * scale - camera.DOFFS_PX * zoom
    start = min(int(np.median(measured) * zoom), int(crop.box[0] * zoom))
    other = crop(resample.linear(right), resample.resize, -start / zoom)
    second = Second(other, disparity, scale, offset - start)

    field = light_field(image, disparity, sampling, second, margin)
    inner = (slice(margin, margin + sampling.rows), slice(margin, margin + sampling.cols))
    return Scene(
        "motorcycle",
        sampling.views,
        field,
        image[inner].astype(sampling.dtype),
        disparity[inner].copy(),
        1 / crop(inverse_depth, resample.pick)[inner],
    )


class _Crop:
    """The centred part of the pair that fills the array, and ``margin`` pixels of the array around it."""

    def __init__(self, shape, sampling, zoom, margin):
        self.size = sampling.rows + 2 * margin, sampling.cols + 2 * margin
        height, width = (n / zoom for n in self.size)
        left, upper = (shape[1] - width) / 2, (shape[0] - height) / 2
        self.box = left, upper, left + width, upper + height

    def __call__(self, values, how, shift=0.0):
        left, upper, right, lower = self.box
        return how(values, *self.size, (left + shift, upper, right + shift, lower))


def _margin(shape, disparity, sampling, zoom):
    """Pixels around the array that the outer views look at, as far as the pair has them."""
    wanted = np.ceil(np.abs(disparity).max() * np.abs(sampling.steps).max()) + 2
    there = min((shape[0] * zoom - sampling.rows) / 2, (shape[1] * zoom - sampling.cols) / 2)
    return int(min(wanted, there))
