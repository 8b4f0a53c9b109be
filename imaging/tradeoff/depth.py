"""Depth by time of flight from the golden chip, of a box: RMS error where it is sure, in percent of the range, against
seconds a frame. By the sums and by the depth field, of four taps and of three, with more and fewer disparities tried,
and with the samples' last bits taken off. Disparity alone and one depth for all cost less or nothing."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.depth.capture import DepthFrames, capture
from talbot.imaging.depth.measure import COARSE, FAINT, by_disparity, figures
from talbot.imaging.frame.light_field import estimator_of, prior_of
from talbot.imaging.frame.request import request
from talbot.models.parameters import LIFE_SIZE, STANDARD
from talbot.models.pixel.time_of_flight import SPEED_OF_LIGHT, demodulate
from talbot.models.reconstruct import white_sum
from talbot.models.reconstruct.depth_field import depth_field, unwrap

F_MOD, CONTRAST, AMBIENT = 100e6, 0.7, 0.2  # as of make depth
# Method, taps, disparities that are tried, bits of a sample
SETTINGS: Sequence[tuple[str, int, int, int]] = (
    ("one depth", 4, 11, 8),
    ("disparity", 4, 11, 8),
    *(("sums", 4, n, 8) for n in (5, 11, 21)),
    *(("depth field", 4, n, 8) for n in (5, 11, 21)),
    *(("depth field", 3, n, 8) for n in (5, 11, 21)),
    *(("depth field", 4, 11, bits) for bits in (7, 6, 5)),
)


def points(quick: bool) -> list[tuple[tuple[str, int, int, int], int]]:
    """Settings, and rows of the array."""
    return [(setting, 24 if quick else 96) for setting in SETTINGS if not quick or setting[2:] == (5, 8)]


@lru_cache(maxsize=1)
def _frames(size: int) -> DepthFrames:
    standard = STANDARD.electrical
    ours = replace(standard, f_mod=F_MOD, contrast=CONTRAST, ambient_current=AMBIENT * standard.white_current)
    sensor = replace(STANDARD, optics=replace(STANDARD.optics, camera=LIFE_SIZE), electrical=ours)
    return capture(request(sensor=sensor, scene="cornell", mode="tof", rows=size, cols=size), golden=True)


def measure(point: tuple[tuple[str, int, int, int], int]) -> dict[str, Any]:
    """Return a method's error and its seconds a frame, without the preparation for a sensor."""
    (method, taps, disparities, bits), size = point
    frames = _frames(size)
    result, step = frames.sums, 1 << (8 - bits)
    scene, ambiguity = result.exposed.scene, SPEED_OF_LIGHT / (2 * F_MOD)
    truth, white = np.asarray(scene.depth), white_sum(result.request.lit, result.request.frame.exposing)
    prior = prior_of(result, disparities=disparities, **COARSE)
    estimator = estimator_of(result, prior)
    diodes = _coarser(frames.diodes(), step)
    estimator.prepare(mixture=True)  # what is done once a sensor
    start = perf_counter()
    if method in ("sums", "disparity"):
        estimate = estimator.mixture(diodes[0] / white, diodes.sum(0) / white / 2)
        field = None
    else:
        field = estimate = depth_field(estimator, diodes[:taps] / white)
    coarse, doubt = by_disparity(result, estimate, prior)
    depth, sure = coarse, np.isfinite(doubt)
    if method in ("sums", "depth field"):
        sums = np.moveaxis(result.decoded.samples.astype(float), 2, 0)
        phase, strength = demodulate(_coarser(sums, step) if field is None else field.centre * white)
        turned = unwrap(np.where(strength < FAINT, np.nan, phase), coarse / ambiguity, doubt / ambiguity)
        depth, sure = turned.turns * ambiguity, turned.sure
    seconds = perf_counter() - start
    if method == "one depth":
        depth, sure, seconds = np.full_like(truth, truth.mean()), np.ones(truth.shape, bool), 0.0
    got = figures(depth, truth, sure, ambiguity)
    share = None if got["rms_m"] is None else 100 * got["rms_m"] / float(np.ptp(truth))
    setting = {"method": method, "taps": taps, "disparities": disparities, "bits": bits}
    return setting | {"error_percent": share, "sure": got["sure"], "rms_m": got["rms_m"], "seconds": seconds}


def _coarser(samples: npt.NDArray[np.floating], step: int) -> npt.NDArray[np.floating]:
    """Return the samples as codes of fewer bits."""
    return np.floor(samples / step) * step + (step - 1) / 2


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """Error against time: a line for each method, taps and bits."""
    series: dict[str, list[tuple[float, float, str]]] = {}
    for r in rows:
        if r["error_percent"] is not None and r["method"] != "one depth":
            name = r["method"] if r["method"] != "depth field" else f"depth field, {r['taps']} taps, {r['bits']} bits"
            series.setdefault(name, []).append((r["seconds"], r["error_percent"], f"{r['disparities']} disparities"))
    labels = "seconds a frame", "RMS error where sure (% of the range)"
    return curves(series, *labels, "Depth: error and run time", log_x=True, log_y=True)
