"""Phi: from the light field to the diodes and back, applied, never built [Jayasuriya2017, Eq. 3.3 to 3.5]."""

from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit
from talbot.models.parameters import ParameterError, SensorParameters, check_choice
from talbot.models.pixel.weights import view_weights

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]


class _Some(NamedTuple):
    """Arguments of `_forward_some`; all rows at one position in the tile share their columns, as in every scan."""

    lines: Ints  # rows to visit
    columns: Ints  # (tile rows, most columns), padded
    counts: Ints  # (tile rows,) columns of each
    weights: Floats  # (tile rows, v, u, 2, most columns)


class CaptureOperator:
    """Linear map from a light field l[v, u, y, x] to the photocurrents of all diode pairs.

    Photocurrents are relative: 1 is the average diode in a flat white scene.

    sensor: the sensor.
    dtype: 'float32' or 'float64', the type of every array.
    angular: False where all views are equal: then the light field is (1, 1, rows, cols), and one view is read instead
        of views squared. The result differs by rounding only (see `rounding`).
    read: (rows, cols), pixels to compute; the others are 0. None computes all. The bits of a computed pixel do not
        depend on the others.

    Raises ParameterError for a wrong dtype or shape. Source: [Jayasuriya2017], Eq. 3.3 to 3.5.
    """

    def __init__(
        self,
        sensor: SensorParameters,
        dtype: str = "float64",
        angular: bool = True,
        read: npt.NDArray[np.bool_] | None = None,
    ) -> None:
        check_choice("dtype", dtype, ("float32", "float64"))
        self.sensor, self.dtype, self.angular = sensor, np.dtype(dtype), angular
        self.rows, self.cols = sensor.array.rows, sensor.array.cols
        weights = view_weights(sensor.tile, sensor.optics)
        if not angular:
            weights = weights.sum((2, 3), keepdims=True)
        self.weights = weights.astype(self.dtype)  # (types, 2, v, u)
        self.views = weights.shape[-1]
        if read is not None and read.shape != (self.rows, self.cols):
            raise ParameterError(f"read shape = {read.shape}: must be ({self.rows}, {self.cols})")
        self.read = None if read is None or read.all() else read

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Shape of the light field."""
        return self.views, self.views, self.rows, self.cols

    @property
    def _pixels(self) -> npt.NDArray[np.bool_]:
        return np.ones((self.rows, self.cols), bool) if self.read is None else self.read

    @cached_property
    def _spread(self) -> Floats:
        """Weights laid out along a row of pixels, for vector instructions: (tile rows, v, u, 2, cols)."""
        kinds = self.sensor.tile.type_map(self.sensor.tile.rows, self.cols)
        return np.ascontiguousarray(self.weights[kinds].transpose(0, 3, 4, 2, 1))

    @cached_property
    def _some(self) -> _Some:
        height = self.sensor.tile.rows
        masks = np.stack([self._pixels[r::height].any(0) for r in range(height)])
        counts = masks.sum(1)
        columns = np.zeros((height, counts.max()), np.int64)
        for r in range(height):
            columns[r, : counts[r]] = np.flatnonzero(masks[r])
        kinds = self.sensor.tile.type_map(height, self.cols)
        weights = self.weights[np.take_along_axis(kinds, columns, 1)]
        lines = np.flatnonzero(self._pixels.any(1))
        return _Some(lines, columns, counts, np.ascontiguousarray(weights.transpose(0, 3, 4, 2, 1)))

    @cached_property
    def _irregular(self) -> bool:
        """Return whether rows at one position in the tile differ in their columns (more work for `_forward_some`)."""
        lines, _, counts, _ = self._some
        return bool(counts[lines % len(counts)].sum() != self._pixels.sum())

    def forward(self, light_field: Floats) -> Floats:
        """Apply Phi.

        light_field: (views, views, rows, cols), l[v, u, y, x]. Returns (2, rows, cols), photocurrents of both diodes.
        Raises ParameterError for a wrong shape or type.
        """
        light_field = self._checked("light_field", light_field, self.shape)
        out = np.zeros((2, self.rows, self.cols), self.dtype)
        if self.read is None:
            _forward(light_field, self._spread, out)
        else:
            _forward_some(light_field, *self._some, out)
            if self._irregular:
                out *= self._pixels
        return out

    def transpose(self, pair: Floats) -> Floats:
        """Apply the transpose of Phi.

        pair: (2, rows, cols), photocurrents of both diodes; pixels that are not read do not count. Returns (views,
        views, rows, cols), l[v, u, y, x]. Raises ParameterError for a wrong shape or type.
        """
        pair = self._checked("pair", pair, (2, self.rows, self.cols))
        if self.read is not None:
            pair = pair * self.read
        out = np.empty(self.shape, self.dtype)
        _transpose(pair, self._spread, out)
        return out

    def _checked(self, field: str, values: Floats, shape: tuple[int, ...]) -> Floats:
        if values.shape != shape or values.dtype != self.dtype:
            raise ParameterError(f"{field} = {values.dtype} {values.shape}: must be {self.dtype} {shape}")
        return np.ascontiguousarray(values)


def rounding(dtype: str, views: int) -> float:
    """Largest relative difference between adding equal views one by one and using the sum of their weights.

    The terms are positive, so each of the views**2 additions adds at most one rounding of the sum.

    dtype: 'float32' or 'float64'. views: views along each axis. Returns the bound.
    """
    return (views**2 + 2) * float(np.finfo(dtype).eps)


# The kernels index whole arrays, not slices: only so does LLVM see that they do not overlap, and vectorizes.
@njit(cache=True)
def _forward(light_field: Floats, spread: Floats, out: Floats) -> None:
    views, rows, cols = light_field.shape[0], out.shape[1], out.shape[2]
    for y in range(rows):
        r = y % spread.shape[0]
        for v in range(views):
            for u in range(views):
                for x in range(cols):
                    light = light_field[v, u, y, x]
                    out[0, y, x] += spread[r, v, u, 0, x] * light
                    out[1, y, x] += spread[r, v, u, 1, x] * light


@njit(cache=True)
def _forward_some(light_field: Floats, lines: Ints, columns: Ints, counts: Ints, weights: Floats, out: Floats) -> None:
    views = light_field.shape[0]
    total = np.empty((2, columns.shape[1]), out.dtype)
    for y in lines:
        r = y % columns.shape[0]
        n = counts[r]
        total[:] = 0
        for v in range(views):
            for u in range(views):
                for i in range(n):
                    light = light_field[v, u, y, columns[r, i]]
                    total[0, i] += weights[r, v, u, 0, i] * light
                    total[1, i] += weights[r, v, u, 1, i] * light
        for i in range(n):
            out[0, y, columns[r, i]] = total[0, i]
            out[1, y, columns[r, i]] = total[1, i]


@njit(cache=True)
def _transpose(pair: Floats, spread: Floats, out: Floats) -> None:
    views, rows, cols = out.shape[0], out.shape[2], out.shape[3]
    for v in range(views):
        for u in range(views):
            for y in range(rows):
                r = y % spread.shape[0]
                for x in range(cols):
                    out[v, u, y, x] = spread[r, v, u, 0, x] * pair[0, y, x] + spread[r, v, u, 1, x] * pair[1, y, x]
