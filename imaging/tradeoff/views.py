"""Views and angular nodes of the capture model: photocurrents of the 48 diodes against an adaptive quadrature of
Eq. 3.3, for uniform light and for light that ripples with angle, against the time to compute the weights."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import Any

from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.models.parameters import SensorParameters
from talbot.models.pixel import Ripple, exact, sampling_error

VIEWS = (1, 3, 5, 7, 9, 15)
NODES = (1, 2, 3, 4, 6, 8, 12)
LIGHTS = {"uniform": Ripple(0.0), "one ripple": Ripple()}
_references: dict[str, Any] = {}


def points(quick: bool) -> list[tuple[str, int, int]]:
    """Light, views along an axis, and angular nodes a view."""
    return list(product(LIGHTS, (3, 5) if quick else VIEWS, (1, 4) if quick else NODES))


def measure(point: tuple[str, int, int]) -> dict[str, Any]:
    """Error of the photocurrents and time of the weights."""
    light, views, nodes = point
    sensor = SensorParameters()
    if light not in _references:
        _references[light] = exact(sensor.tile.types, sensor.optics, LIGHTS[light])
    optics = replace(sensor.optics, views=views, subsamples=nodes)
    error = sampling_error(sensor.tile.types, optics, LIGHTS[light], _references[light])
    errors = {name: getattr(error, name) for name in ("worst", "rms", "seconds")}
    return {"light": light, "views": views, "nodes": nodes, **errors}


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """Worst error against time."""
    series: dict[str, list[tuple[float, float, str]]] = {}
    for r in rows:
        name = f"{r['light']}, {r['views']} x {r['views']} views"
        series.setdefault(name, []).append((1e3 * r["seconds"], r["worst"], str(r["nodes"])))
    labels = "time of the weights (ms); number: nodes a view cell", "worst error of a photocurrent / their mean"
    return curves(series, *labels, "Views and angular nodes", log_x=True, log_y=True)
