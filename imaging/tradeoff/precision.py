"""Single against double precision (float32, float64) in the capture of the default scene: largest relative error,
codes that change and time."""

from collections.abc import Sequence
from functools import cache
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.models.afe import FrontEnd, trim_codes
from talbot.models.capture import CaptureOperator
from talbot.models.parameters import ArrayParameters, CameraParameters, OpticsParameters, SensorParameters
from talbot.models.pixel import optical_gains
from talbot.models.scene import Sampling, Scene, load

REPEATS = 9
FOCAL_LENGTH = CameraParameters.focal_length  # a longer one for larger arrays: the pair must fill them


def points(quick: bool) -> list[tuple[str, int]]:
    """Type of the captured light field, and rows of the array."""
    return [(dtype, size) for size in ((48,) if quick else (96, 192, 384, 768)) for dtype in ("float64", "float32")]


@cache
def _scene(size: int) -> tuple[SensorParameters, Scene]:
    """Sensor and default scene of ``size`` x ``size`` pixels."""
    optics = OpticsParameters(camera=CameraParameters(focal_length=FOCAL_LENGTH * max(1.0, size / 384)))
    sensor = SensorParameters(array=ArrayParameters(rows=size, cols=size), optics=optics)
    return sensor, load("motorcycle", Sampling.of(sensor))


def _codes(pair: npt.NDArray[np.floating], sensor: SensorParameters) -> npt.NDArray[np.integer]:
    """Codes of a noiseless edge frame of photocurrents (2, rows, cols) at half a full well for white."""
    trims = trim_codes(optical_gains(sensor.tile, sensor.optics))
    front_end = FrontEnd(sensor.electrical.difference_gain, tuple(trims.tolist()))
    samples = np.ascontiguousarray(np.moveaxis(pair, 0, -1)[None], np.float64) * (255 / 4)
    return front_end.convert(samples, "edge", 0).codes


def measure(point: tuple[str, int]) -> dict[str, Any]:
    """Error, changed codes and time of a capture in this precision."""
    dtype, size = point
    sensor, scene = _scene(size)
    best = CaptureOperator(sensor, "float64").forward(scene.full_light_field.astype("float64"))
    operator, field = CaptureOperator(sensor, dtype), scene.full_light_field.astype(dtype)
    pair, times = operator.forward(field), []
    for _ in range(REPEATS):
        start = perf_counter()
        operator.forward(field)
        times.append(perf_counter() - start)
    error = float(np.abs(pair - best).max() / best.max())
    changed = int((_codes(pair, sensor) != _codes(best, sensor)).sum())
    row = {"error": error, "codes_changed": changed, "samples": size * size, "capture_ms": 1e3 * min(times)}
    return {"dtype": dtype, "rows": size, **row}


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """Largest error against time of a capture."""
    # The reference itself has no error; it is drawn at float64's own rounding.
    floor = float(np.finfo(np.float64).eps)
    series = {
        d: [(r["capture_ms"], max(r["error"], floor), f"{r['rows']}") for r in rows if r["dtype"] == d]
        for d in ("float64", "float32")
    }
    labels = "capture (ms); number: rows of the array", "largest error / largest value", "float32 against float64"
    return curves(series, *labels, log_x=True, log_y=True)
