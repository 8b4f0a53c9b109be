"""Methods that give a light field back from a raw frame of the golden chip, at physical noise and at 0.1 and 0.2 of
white: PSNR against seconds a frame; at physical noise with their strides, atoms, disparities and iterations, too, and
with nothing left out of the mixture. The sum image in every view costs nothing. The thesis's points are of another
scene (dragons), at 0, 0.1 and 0.2."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from time import perf_counter
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.flow.frame.job import golden_result
from talbot.flow.frame.request import request
from talbot.flow.frame.result import GoldenResult
from talbot.flow.lightfield import methods
from talbot.flow.lightfield.fields import estimator_of, pair_of, prior_of, reached
from talbot.models.capture import CaptureOperator
from talbot.models.reconstruct import psnr_db
from talbot.models.reconstruct.sparse import Coding, SparseEstimator

NOISES = {1.0: "physical", 16.7: "0.1", 33.3: "0.2"}  # times the physical noise, 0.006 of white
# [Jayasuriya2017, Sec. 3.7], at noise 0, 0.1, 0.2
THESIS: dict[str, list[tuple[float, float, str]]] = {
    "thesis, dictionary": [(3786, 25.80, "0"), (9540, 21.98, "0.1"), (20549, 17.40, "0.2")],
    "thesis, network": [(242, 26.77, ""), (242, 26.74, ""), (242, 26.66, "")],
}
# Method, what is changed: of the prior, or of the coding
SETTINGS: Sequence[tuple[str, Mapping[str, Any]]] = (
    ("direct", {}),
    ("linear", {}),
    ("mixture", {}),
    ("mixture", {"disparities": 11}),
    ("mixture", {"plain": 0.0}),
    ("network", {}),
    ("autoencoder", {}),
    ("convolutions", {}),
    ("two_branch", {}),
    ("sparse", {}),
    ("sparse", {"stride": 9}),
    ("sparse", {"stride": 3}),
    ("sparse", {"stride": 2}),
    ("sparse", {"atoms": 64}),
    ("sparse", {"atoms": 192}),
    ("sparse", {"iterations": 60}),
)


def points(quick: bool) -> list[tuple[float, str, Mapping[str, Any], int]]:
    """Noise, method, what is changed of its settings, and rows of the array."""
    if quick:
        return [(1.0, name, change, 48) for name, change in SETTINGS if name in ("direct", "linear", "sparse")]
    return [(n, name, change, 192) for n in NOISES for name, change in SETTINGS if n == 1 or not change]


@lru_cache(maxsize=1)
def _frame(noise: float, size: int) -> GoldenResult:
    return golden_result(request(rows=size, cols=size, mode="raw", noise=noise))


def measure(point: tuple[float, str, Mapping[str, Any], int]) -> dict[str, Any]:
    """Quality and seconds of a method with these settings; what is done once a sensor is not in the seconds."""
    noise, name, change, size = point
    result = _frame(noise, size)
    corners = reached(result)
    truth, pair = result.exposed.scene.full_light_field * corners, pair_of(result, result.decoded.samples)
    free = np.broadcast_to(result.image, truth.shape) * corners
    prior, plain = prior_of(noise, **(change if name != "sparse" else {})), 0.0
    if name == "sparse":
        coder = SparseEstimator(result.sensor, Coding(noise=prior.noise, **change))
        coder.prepare()
        start = perf_counter()
        field = coder.estimate(pair)
        seconds = perf_counter() - start
    else:
        found, times = methods.measure(name, estimator_of(result, prior), CaptureOperator(result.sensor), pair)
        field, seconds, plain = found.light_field, times["seconds"], found.plain
    got = methods.figures(field * corners, truth, psnr_db(free, truth))
    setting = " ".join(f"{key} {value:g}" for key, value in change.items())
    return {"noise": NOISES[noise], "method": name, "setting": setting} | got | {"left_out": plain, "seconds": seconds}


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """PSNR against time: for each noise a line through what nothing beats in both, and points for the rest."""
    series: dict[str, list[tuple[float, float, str]]] = {}
    for noise in dict.fromkeys(r["noise"] for r in rows):
        best = -np.inf
        for r in sorted((r for r in rows if r["noise"] == noise), key=lambda r: r["seconds"]):
            if r["psnr_db"] > best:
                best = r["psnr_db"]
                label = f"{r['method']} {r['setting']}".strip()
                series.setdefault(f"noise {noise}", []).append((r["seconds"], best, label))
    first = min(r["seconds"] for r in rows) / 2  # it costs nothing
    free = {r["noise"]: r["psnr_db"] - r["gain_db"] for r in rows}
    nothing = {"sum image in every view": [(first, psnr, noise) for noise, psnr in free.items()]}
    figure = curves(
        series | nothing | THESIS, "seconds a frame", "PSNR (dB)", "Light fields: error and run time", log_x=True
    )
    for name, line in zip(series, figure.axes[0].lines, strict=False):
        rest = [(r["seconds"], r["psnr_db"]) for r in rows if f"noise {r['noise']}" == name]
        figure.axes[0].plot(*zip(*rest, strict=True), ".", color=line.get_color(), markersize=3)
    return figure
