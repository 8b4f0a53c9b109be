"""The integral over the pupil: views rendered one by one and added to the diodes, no more of them than are kept.

[Jayasuriya2017], Eq. 3.3, with the light taken at the middle of every view's cell and its weight integrated over it.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from os import cpu_count
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit
from talbot.models.parameters import SensorParameters
from talbot.models.pixel.weights import FieldWeights, field_weights
from talbot.models.scene import Scene

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]
# From the disparity of what a view shows, and the view's offset in steps (dv, du), to a factor of its light
Wave = Callable[[Floats, float, float], Floats]
CHUNKS = 4  # sums of views, added in their order: the result does not depend on the number of threads


class Region(NamedTuple):
    """Pixels that see the pupil through a number of views.

    views: along the pupil's diameter.
    pixels: (rows, cols), where.
    """

    views: int
    pixels: npt.NDArray[np.bool_]


def cells(views: int) -> npt.NDArray[np.bool_]:
    """Cells of a grid of views that the round pupil reaches.

    views: along the diameter. Returns (views, views), True where the nearest point of the cell is inside.
    """
    edge = np.maximum(np.abs(2 * np.arange(views) - (views - 1)) - 1, 0) / views
    return np.hypot(edge[:, None], edge) < 1


def integrate(scene: Scene, sensor: SensorParameters, region: Region, waves: Sequence[Wave | None] = (None,)) -> Floats:
    """Photocurrents of a region.

    scene: of the sensor's size. sensor: the sensor. region: views and pixels. waves: factors of the light, each a
    separate integral; None is 1. Returns (waves, 2, rows, cols), 1 = a diode's average in a flat white scene; 0 outside
    the region.
    """
    field = field_weights(sensor, scene.views if region.views == 1 else region.views)
    field = field.summed if region.views == 1 else field
    see = scene.view(region.pixels)
    step, middle = scene.views / region.views, (region.views - 1) / 2
    places = np.argwhere(cells(region.views))
    order = sensor.tile.type_map(sensor.tile.rows, sensor.tile.cols)
    rows = np.flatnonzero(region.pixels.any(1))

    def _some(part: Ints) -> Floats:
        out = np.zeros((len(waves), 2, *scene.shape))
        for v, u in part:
            place = (v - middle) * step, (u - middle) * step
            light, surface = see(*place)
            series = np.ascontiguousarray(field.series[:, :, v, u])
            for total, wave in zip(out, waves, strict=True):
                _add(
                    total,
                    np.ascontiguousarray(light if wave is None else light * wave(surface, *place)),
                    series,
                    order,
                    field.y,
                    field.x,
                    rows,
                )
        return out

    with ThreadPoolExecutor(min(CHUNKS, cpu_count() or 1)) as pool:
        parts = pool.map(_some, np.array_split(places, CHUNKS))
        out = next(parts)
        for part in parts:
            out += part
    return np.where(region.pixels, out, 0)


def add_view(pair: Floats, light: Floats, field: FieldWeights, sensor: SensorParameters, v: int, u: int) -> None:
    """Add one view to all pixels, in place.

    pair: (2, rows, cols), photocurrents. light: (rows, cols), radiance of the view. field: of the sensor. sensor: the
    sensor. v, u: view row and column.
    """
    order = sensor.tile.type_map(sensor.tile.rows, sensor.tile.cols)
    light, series = map(np.ascontiguousarray, (light, field.series[:, :, v, u]))
    _add(pair, light, series, order, field.y, field.x, np.arange(len(light)))


# Of contiguous arrays alone: of others Numba would compile it once more
@njit(cache=True, nogil=True)
def _add(
    out: Floats, light: Floats, series: Floats, order: npt.NDArray[np.int64], y: Floats, x: Floats, rows: Ints
) -> None:
    height, width, terms, cols = order.shape[0], order.shape[1], series.shape[2], out.shape[2]
    spread = np.empty((height, 2, cols), out.dtype)  # weights along a row of pixels, for vector instructions
    ready = np.zeros(height, np.bool_)
    for r in rows:
        line = r % height
        if terms > 1 or not ready[line]:
            ready[line] = True
            for k in range(width):
                for d in range(2):
                    spread[line, d, k::width] = 0
                    for j in range(terms):
                        total = 0.0
                        for i in range(terms):
                            total += y[r, i] * series[order[line, k], d, i, j]
                        for c in range(k, cols, width):
                            spread[line, d, c] += total * x[c, j]
        for c in range(cols):
            out[0, r, c] += spread[line, 0, c] * light[r, c]
            out[1, r, c] += spread[line, 1, c] * light[r, c]
