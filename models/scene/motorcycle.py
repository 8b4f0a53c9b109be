"""The Middlebury motorcycle pair of scikit-image [Scharstein2014] as a light field: the default scene.

The pair's calibration: focal length 994.978 px, baseline 193.001 mm, the principal points 31.086 px apart,
500 x 741 px. A camera of another focal length sees another part of it.
"""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import check_real
from talbot.models.scene import camera, of_skimage, resample, warp
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import Scene
from talbot.models.scene.views import Pictured, Second

FOCAL_LENGTH_PX = 994.978
BASELINE = 0.193001  # m
DOFFS_PX = 31.086


def motorcycle(sampling: Sampling) -> Scene:
    """Motorcycle scene: the left picture is the centre view; the right one fills what edges hide.

    sampling: array, views and camera. Returns Scene: with disparity and depth. [Scharstein2014].
    """
    left, right = (of_skimage.codes(f"motorcycle_{side}") for side in ("left", "right"))
    with np.load(of_skimage.folder() / "motorcycle_disp.npz") as file:
        measured = file["arr_0"]
    lens = sampling.camera
    _check_field(measured.shape, sampling)
    zoom = lens.principal_distance / sampling.pitch / FOCAL_LENGTH_PX  # px of the array per px of the pair
    measured = np.ascontiguousarray(measured, float)
    unknown = ~np.isfinite(measured)
    measured[unknown] = 0
    warp.fill_rows(measured, unknown)
    inverse_depth = (measured + DOFFS_PX) / (FOCAL_LENGTH_PX * BASELINE) * lens.scale
    disparity = camera.disparity(1 / inverse_depth, sampling)
    margin = _margin(measured.shape, disparity, sampling, zoom)
    crop = _Crop(measured.shape, sampling, zoom, margin)
    disparity = crop(disparity, resample.pick)
    image = crop(resample.linear(left), resample.resize)

    # A pixel of the left picture is measured * zoom to the left in the right one, whose crop
    # starts `start` px further left so that it holds the content of the left crop.
    scale = FOCAL_LENGTH_PX * zoom * BASELINE / lens.scale / camera.per_inverse_metre(sampling)
    offset = -float(camera.disparity(np.inf, sampling)) * scale - DOFFS_PX * zoom
    start = min(int(np.median(measured) * zoom), int(crop.box[0] * zoom))
    other = crop(resample.linear(right), resample.resize, -start / zoom)
    second = Second(other, disparity, scale, offset - start)

    seen = Pictured(image, disparity, sampling, second, margin)
    inner = (slice(margin, margin + sampling.rows), slice(margin, margin + sampling.cols))
    return Scene(
        "motorcycle",
        sampling.views,
        None,
        image[inner].astype(sampling.dtype),
        disparity[inner].copy(),
        1 / crop(inverse_depth, resample.pick)[inner],
        render=seen,
    )


def _check_field(shape: tuple[int, ...], sampling: Sampling) -> None:
    """The pair's pictures must fill the array."""
    lens = sampling.camera
    needed = max(sampling.rows / shape[0], sampling.cols / shape[1]) * sampling.pitch * FOCAL_LENGTH_PX
    low = needed * lens.focal_length / lens.principal_distance
    check_real("focal_length (of the scene motorcycle)", lens.focal_length, low, max(1.0, low))


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
    needed = np.ceil(np.abs(disparity).max() * sampling.views / 2) + 2  # of the pupil's rim
    present = min((shape[0] * zoom - sampling.rows) / 2, (shape[1] * zoom - sampling.cols) / 2)
    return int(min(needed, present))
