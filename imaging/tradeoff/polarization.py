"""Angle of polarization from a raw frame of the golden chip, of glossy balls, of a stressed sheet and of even light:
mean error of psi against seconds a frame, by windows of several sizes in one pass and in two, and by demosaicing alone.
The thesis's 1.12 degrees are of even light behind a polarizer, on its chip; its run time is not published."""

from collections.abc import Sequence
from functools import lru_cache
from time import perf_counter
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.request import request
from talbot.imaging.frame.result import GoldenResult
from talbot.imaging.polar.measure import POLARIZED, angle_error, prepared
from talbot.models.pixel.polarization import angle
from talbot.models.reconstruct import demosaiced, polarization

THESIS = 1.12  # degrees [Jayasuriya2017, Sec. 4.1]
SCENES = "specular", "stress", "polarized"
SPREADS = 1.2, 1.6, 2.0, 2.4


def points(quick: bool) -> list[tuple[str, float, int, int]]:
    """Scene, spread of the window in px (0: demosaicing alone), passes, and rows of the array."""
    if quick:
        return [("stress", spread, 2, 48) for spread in (0.0, 2.0)]
    some = [(0.0, 1), (2.0, 1), *((spread, 2) for spread in SPREADS)]
    return [(scene, spread, passes, 192) for scene in SCENES for spread, passes in some]


@lru_cache(maxsize=1)
def _frame(scene: str, size: int) -> GoldenResult:
    return golden_result(request(scene=scene, rows=size, cols=size, mode="raw"))


def measure(point: tuple[str, float, int, int]) -> dict[str, Any]:
    """Error of psi where there is polarization and it is sure, and seconds a frame."""
    scene, spread, passes, size = point
    result = _frame(scene, size)
    sums, noise, used, _ = prepared(result, result.decoded.samples.astype(float))
    tile, d = result.sensor.tile, result.sensor.optics.diattenuation
    s1, s2 = result.exposed.scene.seen_polarization
    shown = polarization(sums, tile, d, noise, used).confidence > 0  # the same pixels for all methods
    shown &= np.hypot(s1, s2) > POLARIZED
    start = perf_counter()
    if spread:
        psi = polarization(sums, tile, d, noise, used, spread, passes).psi
    else:
        psi = angle(*demosaiced(sums, tile, d))
    seconds = perf_counter() - start
    error = angle_error(psi, angle(s1, s2), shown)
    return {"scene": scene, "spread_px": spread, "passes": passes, "psi_error_deg": error, "seconds": seconds}


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """Error against time for each scene, with the thesis's across."""
    series: dict[str, list[tuple[float, float, str]]] = {}
    for r in rows:
        if r["psi_error_deg"] is not None:
            label = f"{r['spread_px']:g} px, {r['passes']}" if r["spread_px"] else "demosaiced"
            series.setdefault(r["scene"], []).append((r["seconds"], r["psi_error_deg"], label))
    times = [r["seconds"] for r in rows]
    series["thesis"] = [(min(times), THESIS, ""), (max(times), THESIS, "1.12 degrees")]
    labels = "seconds a frame; number: spread, passes", "mean error of psi (degrees)"
    return curves(series, *labels, "Polarization: error and run time", log_x=True, log_y=True)
