"""Views of the capture, 1 to 31 along the pupil's diameter, on the default scene: RMS error of the differences against
31 views in codes, and the time to render and to add the views, that also as copies of a view."""

from collections.abc import Sequence
from functools import cache
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.models.capture import Region, integrate
from talbot.models.capture.pupil import add_view, cells
from talbot.models.parameters import AmpTiming, ArrayParameters, SensorParameters
from talbot.models.pixel import optical_gains
from talbot.models.pixel.weights import field_weights
from talbot.models.plan import codes_per_unit
from talbot.models.scene import Sampling, Scene, load

VIEWS = (1, 3, 5, 7, 9, 11, 13, 15, 17, 21, 25, 31)
REPEATS = 30


def points(quick: bool) -> list[tuple[int, int]]:
    """Views along the diameter, and rows of the array."""
    return [(views, 48 if quick else 384) for views in (VIEWS[::5] if quick else VIEWS)]


@cache
def _scene(size: int) -> tuple[SensorParameters, Scene, npt.NDArray[np.float64]]:
    """Sensor, default scene, and its differences through the most views."""
    sensor = SensorParameters(array=ArrayParameters(size, size))
    scene = load("motorcycle", Sampling.of(sensor))
    return sensor, scene, _differences(sensor, scene, VIEWS[-1])


def _differences(sensor: SensorParameters, scene: Scene, views: int) -> npt.NDArray[np.float64]:
    a, b = integrate(scene, sensor, Region(views, np.ones(scene.shape, bool)))[0]
    gains = optical_gains(sensor.tile, sensor.optics)[sensor.tile.type_map(*scene.shape)]
    return codes_per_unit(sensor, AmpTiming()) * (a - gains * b)


def measure(point: tuple[int, int]) -> dict[str, Any]:
    """Return error and time of a capture through the views of ``point``."""
    views, size = point
    sensor, scene, best = _scene(size)
    start = perf_counter()
    differences = _differences(sensor, scene, views)
    seconds, rendered = perf_counter() - start, int(cells(views).sum())
    error = {"rms_codes": float(np.sqrt(np.mean((differences - best) ** 2))), "signal_codes": float(best.std())}
    return {
        "views": views,
        "rendered": rendered,
        **error,
        "seconds": seconds,
        "add_over_copy": _ratio(sensor, scene, views),
    }


def _ratio(sensor: SensorParameters, scene: Scene, views: int) -> float:
    """Time to add a rendered view to the diodes over that to copy it, both the best of some."""
    field, light, pair = field_weights(sensor, views), scene.image.copy(), np.zeros((2, *scene.shape))
    times: dict[str, list[float]] = {"add": [], "copy": []}
    for _ in range(REPEATS):
        start = perf_counter()
        add_view(pair, light, field, sensor, views // 2, views // 2)
        middle = perf_counter()
        light.copy()
        times["copy"].append(perf_counter() - middle)
        times["add"].append(middle - start)
    return min(times["add"]) / min(times["copy"])


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """Error against time."""
    series = {"differences": [(r["seconds"], r["rms_codes"], str(r["views"])) for r in rows if r["rms_codes"]]}
    labels = "capture (s); number: views along the pupil", "RMS error (codes)", "Views: error against 31 x 31 of them"
    return curves(series, *labels, log_x=True, log_y=True)
