"""A picture on a plane out of focus, as the pixels see it: photocurrents are a matrix times the picture.

Each type sees the picture correlated with its weights of the pupil's views, spread over the blur. For a plane this is
the capture of `models/capture` itself, computed for every pixel of the picture instead of every picture.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, SensorParameters, check_int, check_real
from talbot.models.pixel.weights import view_weights
from talbot.models.scene.warp import cubic_weights

VIEWS = 31  # along the pupil's diameter
BLUR_MAX = 200.0
MATRIX = 1 << 28  # elements at most: 1 GiB
MARGIN = 2  # dark picture px around the picture, for the light that the blur spreads

Floats = npt.NDArray[np.float64]


def kernels(sensor: SensorParameters, blur: float) -> Floats:
    """Correlation kernels of all diodes for a plane out of focus.

    sensor: tile and optics; the lens as it is on the axis. blur: diameter of the blur of a point in sensor px,
    -200..200: positive behind the focal plane. Returns (types, 2, k, k), of odd size k; a pixel measures the sum of
    kernel times picture around it, 1 of a flat white scene on average.
    """
    check_real("blur", blur, -BLUR_MAX, BLUR_MAX)
    weights = view_weights(sensor.tile, replace(sensor.optics, views=VIEWS))
    half = int(np.ceil(abs(blur) / 2)) + 2
    place = half - (np.arange(VIEWS) - (VIEWS - 1) / 2) * blur / VIEWS
    spread = np.zeros((VIEWS, 2 * half + 2))
    for i, at in enumerate(place):
        first = int(np.floor(at))
        spread[i, first - 1 : first + 3] += cubic_weights(at - first)
    return np.einsum("vy,tdvu,ux->tdyx", spread, weights, spread, optimize=True)[..., :-1, :-1]


@dataclass(frozen=True, eq=False)
class Display:
    """Pictures on a display before the sensor.

    sensor: its array is replaced by one that the picture and a margin fill.
    shape: height and width of the pictures in px, 2..256.
    scale: sensor px along an edge of a picture px, 1..32.
    blur: as in `kernels`.
    margin: dark picture px around the picture, 0..32.
    """

    sensor: SensorParameters
    shape: tuple[int, int]
    scale: int = 4
    blur: float = 0.0
    margin: int = MARGIN

    def __post_init__(self) -> None:
        for name, size in zip(("height", "width"), self.shape, strict=True):
            check_int(name, size, 2, 256)
        check_int("scale", self.scale, 1, 32)
        check_int("margin", self.margin, 0, 32)
        check_real("blur", self.blur, -BLUR_MAX, BLUR_MAX)
        if max(self.size) > 1024:
            raise ParameterError(f"scale = {self.scale}: must be at most {1024 // (max(self.shape) + 2 * self.margin)}")
        rows, cols = self.size
        if (pixels := self.shape[0] * self.shape[1] * rows * cols * 2) > MATRIX:
            most = int(self.scale * np.sqrt(MATRIX / pixels))
            if not most:
                raise ParameterError(
                    f"pictures = {self.shape[0]} x {self.shape[1]} px: must be at most about 100 x 100"
                )
            raise ParameterError(
                f"scale = {self.scale}: must be at most {most} for pictures of {self.shape[0]} x {self.shape[1]} px"
            )

    @property
    def size(self) -> tuple[int, int]:
        """Rows and columns of the array, in sensor px."""
        return tuple((n + 2 * self.margin) * self.scale for n in self.shape)  # pyright: ignore[reportReturnType]

    @cached_property
    def matrix(self) -> npt.NDArray[np.float32]:
        """Photocurrent of every diode of every picture px alone, (height width, 2 rows cols)."""
        kernel, s = kernels(self.sensor, self.blur), self.scale
        k, (rows, cols), (height, width) = kernel.shape[-1], self.size, self.shape
        half = k // 2
        # A picture px is a square of s x s: the kernel's sums over it, at offsets -half - s + 1 .. half
        padded = np.pad(kernel, ((0, 0), (0, 0), (s, s), (s, s)))
        total = np.pad(padded, ((0, 0), (0, 0), (1, 0), (1, 0))).cumsum(2).cumsum(3)
        square = total[..., s:, s:] - total[..., :-s, s:] - total[..., s:, :-s] + total[..., :-s, :-s]
        kinds = self.sensor.tile.type_map(rows, cols)

        def offsets(count: int, pixels: int) -> npt.NDArray[np.intp]:
            """Place in ``square`` of each sensor px (pixels) for each picture px (count)."""
            first = (np.arange(count) + self.margin) * s
            return np.clip(first[:, None] - np.arange(pixels) + half + s, 0, square.shape[-1] - 1)

        y, x = offsets(height, rows), offsets(width, cols)
        seen = square[kinds[None, None], :, y[:, None, :, None], x[None, :, None, :]]
        return np.moveaxis(seen, -1, 2).reshape(height * width, -1).astype(np.float32)

    def currents(self, pictures: npt.ArrayLike) -> npt.NDArray[np.float32]:
        """Photocurrents of pictures.

        pictures: (n, height, width), linear radiance, 1 = white. Returns (n, 2, rows, cols), 1 = the average diode in a
        flat white scene; not negative. Raises ParameterError for pictures of another size.
        """
        pictures = np.asarray(pictures, np.float32)
        if pictures.shape[1:] != self.shape:
            raise ParameterError(f"pictures = {pictures.shape}: must be (n, {self.shape[0]}, {self.shape[1]})")
        seen = pictures.reshape(len(pictures), -1) @ self.matrix
        return np.maximum(seen, 0).reshape(len(pictures), 2, *self.size)

    def channels(self, samples: npt.ArrayLike, types: npt.ArrayLike) -> npt.NDArray[np.float32]:
        """Channels of a network from the array's samples, each type's on the grid of the picture.

        A type is in one pixel of a tile; between two of them the samples are interpolated linearly.

        samples: (n, rows, cols), decoded samples. types: (channels,), types to take, one a channel. Returns (n, height
        + 2 margin, width + 2 margin, channels), at the middle of every picture px.
        """
        samples, tile = np.asarray(samples, np.float32), self.sensor.tile
        where = {int(kind): divmod(i, tile.cols) for i, kind in enumerate(tile.order)}
        out = []
        for kind in np.asarray(types):
            y, x = where[int(kind)]
            grid = samples[:, y :: tile.rows, x :: tile.cols]
            down, across = self._between(y, tile.rows, grid.shape[1], 0), self._between(x, tile.cols, grid.shape[2], 1)
            out.append(down @ grid @ across.T)
        return np.stack(out, -1)

    def _between(self, first: int, step: int, count: int, axis: int) -> npt.NDArray[np.float32]:
        """Matrix (picture px, samples) of linear interpolation of samples at first, first + step, ..."""
        pixels = self.shape[axis] + 2 * self.margin
        at = np.clip(((np.arange(pixels) + 0.5) * self.scale - 0.5 - first) / step, 0, count - 1)
        return np.maximum(1 - np.abs(at[:, None] - np.arange(count)), 0).astype(np.float32)


def phase_types(sensor: SensorParameters) -> npt.NDArray[np.int64]:
    """Return the pixel types that are the first layer [Jayasuriya2017, Sec. 6.3].

    sensor: its tile. Returns (types,), numbers of those of alpha 0; all, where there is none.
    """
    kinds = [i for i, kind in enumerate(sensor.tile.types) if kind.alpha == 0]
    return np.array(kinds or range(sensor.tile.n_types), np.int64)
