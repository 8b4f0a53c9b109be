"""Phi: the light field to the diodes and back, applied, never built [Jayasuriya2017, Eq. 3.3 to 3.5]."""

from functools import cached_property

import numpy as np
from numba import njit

from models.parameters import ParameterError, check_choice
from models.pixel.weights import view_weights


class CaptureOperator:
    """The linear map from a light field l[v, u, y, x] to the photocurrents of all diode pairs.

    sensor: SensorParameters. dtype: 'float32' or 'float64', of every array in and out.
    angular: False where all views are equal: then the light field is (1, 1, rows, cols), and one view is read
        instead of views squared. The result differs by rounding only (see `rounding`).
    read: bool (rows, cols), pixels to compute; the others come out 0. None computes all. A pixel that is computed
        has the same bits whatever the others do.

    Photocurrents are relative: 1 is a diode's average in a flat white scene.
    """

    def __init__(self, sensor, dtype="float64", angular=True, read=None):
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
    def shape(self):
        """Of the light field."""
        return self.views, self.views, self.rows, self.cols

    @cached_property
    def _spread(self):
        """Weights laid out along a row of pixels, for vector instructions: (tile rows, v, u, 2, cols)."""
        kinds = self.sensor.tile.type_map(self.sensor.tile.rows, self.cols)
        return np.ascontiguousarray(self.weights[kinds].transpose(0, 3, 4, 2, 1))

    @cached_property
    def _some(self):
        """What `_forward_some` needs: rows to visit, columns of each row of a tile (padded), how many, their weights.

        All rows at one place in the tile share their columns, as in every scan.
        """
        height = self.sensor.tile.rows
        masks = np.stack([self.read[r::height].any(0) for r in range(height)])
        counts = masks.sum(1)
        columns = np.zeros((height, counts.max()), np.int64)
        for r in range(height):
            columns[r, : counts[r]] = np.flatnonzero(masks[r])
        kinds = self.sensor.tile.type_map(height, self.cols)
        weights = self.weights[np.take_along_axis(kinds, columns, 1)]
        return (
            np.flatnonzero(self.read.any(1)),
            columns,
            counts,
            np.ascontiguousarray(weights.transpose(0, 3, 4, 2, 1)),
        )

    @cached_property
    def _irregular(self):
        """Whether rows at one place in the tile differ in their columns, so that `_forward_some` computes too much."""
        lines, _, counts, _ = self._some
        return counts[lines % len(counts)].sum() != self.read.sum()

    def forward(self, light_field):
        """Phi l: photocurrents of both diodes, (2, rows, cols)."""
        light_field = self._checked("light_field", light_field, self.shape)
        out = np.zeros((2, self.rows, self.cols), self.dtype)
        if self.read is None:
            _forward(light_field, self._spread, out)
        else:
            _forward_some(light_field, *self._some, out)
            if self._irregular:
                out *= self.read
        return out

    def transpose(self, pair):
        """Phi' i: (2, rows, cols) back to (views, views, rows, cols). Pixels that are not read give nothing."""
        pair = self._checked("pair", pair, (2, self.rows, self.cols))
        if self.read is not None:
            pair = pair * self.read
        out = np.empty(self.shape, self.dtype)
        _transpose(pair, self._spread, out)
        return out

    def _checked(self, field, values, shape):
        if values.shape != shape or values.dtype != self.dtype:
            raise ParameterError(f"{field} = {values.dtype} {values.shape}: must be {self.dtype} {shape}")
        return np.ascontiguousarray(values)


def rounding(dtype, views):
    """Relative difference at most between adding equal views one by one and taking the sum of their weights.

    The terms are positive, so each of the views**2 additions errs by at most one rounding of the sum.
    """
    return (views**2 + 2) * float(np.finfo(dtype).eps)


# The kernels index whole arrays, not slices: only so does LLVM see that they do not overlap, and vectorizes.
@njit(cache=True)
def _forward(light_field, spread, out):
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
def _forward_some(light_field, lines, columns, counts, weights, out):
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
def _transpose(pair, spread, out):
    views, rows, cols = out.shape[0], out.shape[2], out.shape[3]
    for v in range(views):
        for u in range(views):
            for y in range(rows):
                r = y % spread.shape[0]
                for x in range(cols):
                    out[v, u, y, x] = spread[r, v, u, 0, x] * pair[0, y, x] + spread[r, v, u, 1, x] * pair[1, y, x]
