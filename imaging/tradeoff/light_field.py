"""Methods that give a light field back: PSNR against seconds a frame, from a raw frame of the golden chip at physical
noise, and from its diodes ahead of the converter with Gaussian noise of 0.1 and 0.2, as [Jayasuriya2017, Tab. 3.2] has
it: of Phi l (Eq. 3.5), where white has 25 by the 25 views of a diode 1 + m cos (Eq. 3.2), and of white; at physical
noise with their strides, atoms, disparities and iterations, too, and with nothing left out of the mixture. The sum
image in every view costs nothing. The thesis's points are of another scene (dragons), at 0, 0.1 and 0.2."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.light_field import estimator_of, pair_of, prior_of, reached
from talbot.imaging.frame.request import request
from talbot.imaging.frame.result import GoldenResult
from talbot.imaging.lightfield.figures import figures
from talbot.models.capture import CaptureOperator
from talbot.models.reconstruct import methods, psnr_db, sum_image, white_sum
from talbot.models.reconstruct.bayes import FieldPrior
from talbot.models.reconstruct.sparse import Coding, SparseEstimator

WHITE = 25  # of Phi l
# Standard deviation of a diode, of white; None is the chip's own frame
NOISES = {
    "physical": None,
    "0.1 of white": 0.1,
    "0.2 of white": 0.2,
    "0.1 of Phi l": 0.1 / WHITE,
    "0.2 of Phi l": 0.2 / WHITE,
}
SEED = 1  # of the noise
# [Jayasuriya2017, Sec. 3.7], at noise 0, 0.1, 0.2
THESIS: dict[str, list[tuple[float, float, str]]] = {
    "thesis, dictionary": [(3786, 25.80, "0"), (9540, 21.98, "0.1"), (20549, 17.40, "0.2")],
    "thesis, network": [(242, 26.77, ""), (242, 26.74, ""), (242, 26.66, "")],
}
Point = tuple[str, str, Mapping[str, Any], int]
# Method, what is changed: of the prior, or of the coding
SETTINGS: Sequence[tuple[str, Mapping[str, Any]]] = (
    ("direct", {}),
    ("linear", {}),
    ("mixture", {}),
    ("mixture", {"disparities": 11}),
    ("mixture", {"plain": 0.0}),
    ("autoencoder", {}),
    ("convolutions", {}),
    ("two_branch", {}),
    ("sparse", {}),
    ("sparse", {"stride": 9}),
    ("sparse", {"stride": 5}),
    ("sparse", {"stride": 2}),
    ("sparse", {"atoms": 64}),
    ("sparse", {"atoms": 192}),
    ("sparse", {"iterations": 20}),
)


def points(quick: bool) -> list[Point]:
    """Return noise of `NOISES`, method, changed settings, and rows of the array."""
    noises, size = (list(NOISES)[:2], 48) if quick else (list(NOISES), 192)
    every = [(n, name, change, size) for n in noises for name, change in SETTINGS if NOISES[n] is None or not change]
    short = [point for point in every if point[1] in ("direct", "linear", "sparse") and point[2] != {"stride": 2}]
    return short if quick else every


@lru_cache(maxsize=1)
def _frame(size: int) -> GoldenResult:
    return golden_result(request(rows=size, cols=size, mode="raw"))


def noisy(result: GoldenResult, noise: float) -> npt.NDArray[np.floating]:
    """Both diodes of a frame ahead of the converter, 1 = white, with Gaussian noise of this standard deviation."""
    ideal = pair_of(result, result.exposed.ideal)
    return ideal + noise * np.random.default_rng(SEED).standard_normal(ideal.shape)


def measure(point: Point) -> dict[str, Any]:
    """Return quality and seconds of a method with these settings, without the preparation for a sensor."""
    label, name, change, size = point
    noise = NOISES[label]
    result = _frame(size)
    corners = reached(result)
    truth, rest, plain = result.exposed.scene.full_light_field * corners, change if name != "sparse" else {}, 0.0
    if noise is None:
        pair, image, prior = pair_of(result, result.decoded.samples), result.image, prior_of(result, **rest)
    else:
        lit, timing = result.request.lit, result.request.frame.exposing
        pair, prior = noisy(result, noise), FieldPrior(noise=max(noise, FieldPrior.noise), **rest)
        image = np.asarray(sum_image(pair.sum(0) * white_sum(lit, timing) / 2, lit, timing=timing), float)
    free = np.broadcast_to(image, truth.shape) * corners
    if name == "sparse":
        coder = SparseEstimator(result.sensor, Coding(noise=prior.noise, **change))
        coder.prepare()
        start = perf_counter()
        field = coder.estimate(pair)
        seconds = perf_counter() - start
    else:
        estimate, times = methods.measure(name, estimator_of(result, prior), CaptureOperator(result.sensor), pair)
        field, seconds, plain = estimate.light_field, times["seconds"], estimate.plain
    got = figures(field * corners, truth, psnr_db(free, truth))
    setting = " ".join(f"{key} {value:g}" for key, value in change.items())
    return {"noise": label, "method": name, "setting": setting} | got | {"left_out": plain, "seconds": seconds}


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """Draw PSNR against time: for each noise a line through the Pareto front, and points for the others."""
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
