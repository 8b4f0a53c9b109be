"""The Middlebury motorcycle pair of scikit-image [Scharstein2014] as a light field: the default scene."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from skimage.data import stereo_motorcycle

from . import camera, resample, warp
from .sampling import Sampling
from .scene import Scene
from .views import Second, light_field


def motorcycle(sampling: Sampling) -> Scene:
    """Motorcycle scene: the left picture is the centre view; the right one fills what edges hide.

    Parameters
    ----------
    sampling : Sampling
        Array, views and focal plane.

    Returns
    -------
    Scene
        With disparity and depth.

    References
    ----------
    [Scharstein2014].
    """
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

    # A pixel of the left picture is measured * zoom to the left in the right one, whose crop
    # starts `start` px further left so that it holds the content of the left crop.
    scale = camera.BASELINE * sampling.views / camera.APERTURE
    offset = (focus - float(camera.disparity(np.inf, sampling))) * scale - camera.DOFFS_PX * zoom
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

    def __init__(self, shape: tuple[int, ...], sampling: Sampling, zoom: float, margin: int) -> None:
        self.size = sampling.rows + 2 * margin, sampling.cols + 2 * margin
        height, width = (n / zoom for n in self.size)
        left, upper = (shape[1] - width) / 2, (shape[0] - height) / 2
        self.box = left, upper, left + width, upper + height

    def __call__(
        self, values: npt.NDArray[np.floating], how: Callable[..., npt.NDArray[np.float64]], shift: float = 0.0
    ) -> npt.NDArray[np.float64]:
        left, upper, right, lower = self.box
        return how(values, *self.size, (left + shift, upper, right + shift, lower))


def _margin(shape: tuple[int, ...], disparity: npt.NDArray[np.float64], sampling: Sampling, zoom: float) -> int:
    """Pixels around the array that the outer views need, as far as the pair has them."""
    needed = np.ceil(np.abs(disparity).max() * np.abs(sampling.steps).max()) + 2
    present = min((shape[0] * zoom - sampling.rows) / 2, (shape[1] * zoom - sampling.cols) / 2)
    return int(min(needed, present))
