"""False edges of the fixed pattern: the share of a flat scene's pixels that edge mode sends over the threshold, and the
RMS of their differences in codes, at several lights (% of white). Fitted to a frame of half of white are a trim for
each pixel type of the tile (the chip), for each type in each column, or an offset for each column."""

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.frame import job
from talbot.imaging.frame.request import request
from talbot.models.afe import FrontEnd, trim_codes, trim_gain

THRESHOLDS = 8, 10, 12, 20
LIGHTS = 2, 50, 100  # % of white
FITTED = "tile", "column", "offset"
Values = npt.NDArray[np.float64]


def points(quick: bool) -> list[tuple[int, str, int]]:
    """Light in % of white, what is fitted, and rows of the array."""
    return [(light, fit, 48 if quick else 384) for light in LIGHTS for fit in FITTED]


def measure(point: tuple[int, str, int]) -> dict[str, Any]:
    """RMS of the silent differences, and the share that is sent at each threshold."""
    light, fit, size = point
    front_end, flat = _flat(light, size)
    sent = {str(t): float((front_end.convert(flat[fit], "edge", t).codes != 0).mean()) for t in THRESHOLDS}
    return {"fitted": fit, "light": light, "rms": float(front_end.values(flat[fit], "edge").std()), **sent}


@cache
def _flat(light: int, size: int) -> tuple[FrontEnd, Mapping[str, Values]]:
    """Front end, and the samples of a flat scene of ``light`` % of white by what is fitted, (1, rows, cols, 2)."""
    frame_request = request(scene=f"flat:{light}", rows=size, cols=size)
    scene, todo = job.see(frame_request)
    exposed = job.expose(frame_request, scene, todo)
    return exposed.front_end, fitted(exposed.samples, job.flat_field(frame_request), exposed.front_end)


def fitted(samples: Values, flat: Values, front_end: FrontEnd) -> dict[str, Values]:
    """Return ``samples`` (1, rows, cols, 2) as the amplifiers of other trims would see them through ``front_end``.

    flat: (rows, cols, 2), to which they are fitted. tile: as they are. column: a ratio of 10 bits for each pixel type
    in each column. offset: each column's own is subtracted from its first diode.
    """
    kinds, cols = front_end.tile.type_map(*flat.shape[:2]), np.arange(flat.shape[1])
    place = kinds * len(cols) + cols
    a, b = (np.bincount(place.ravel(), flat[..., d].ravel(), kinds.max() * len(cols) + len(cols)) for d in (0, 1))
    ratio = trim_gain(trim_codes(a / np.where(b > 0, b, 1)))[place]
    shared = trim_gain(front_end.trim)[kinds]
    off = (flat[..., 0] - shared * flat[..., 1]).mean(0)
    return {
        "tile": samples,
        "column": samples * np.stack([np.ones_like(ratio), ratio / shared], -1),
        "offset": samples - np.stack([off, np.zeros_like(off)], -1),
    }


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """False edges over the threshold, those of no pixel left out."""
    series = {
        f"{r['fitted']}, {r['light']} % of white": [(t, float(r[str(t)]), "") for t in THRESHOLDS if float(r[str(t)])]
        for r in rows
    }
    return curves(series, "threshold", "silent pixels sent", "False edges over the threshold", log_y=True)
