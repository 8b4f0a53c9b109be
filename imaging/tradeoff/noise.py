"""Noise on the default scene, through the chip's Verilog: SNR of the decoded differences against the analog values
of a noiseless exposure, and what the noise costs in conversions, bytes and cycles."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.frame import job
from talbot.imaging.frame.figures import summarize
from talbot.imaging.frame.request import request
from talbot.imaging.tradeoff.threshold import costs

LEVELS = (0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)


def points(quick: bool) -> list[tuple[float, int]]:
    """Noise, in units of the physical one, and rows of the array."""
    return [(level, 48 if quick else 384) for level in (LEVELS[::4] if quick else LEVELS)]


def measure(point: tuple[float, int]) -> dict[str, Any]:
    """Quality and cost of a frame with this noise."""
    level, size = point
    frame_request = request(rows=size, cols=size, noise=level)
    result = job.simulate_frame(frame_request)
    summary = summarize(result)
    return {
        "noise": level,
        "snr_edges_db": summary["snr_db"],
        "psnr_edges_db": summary["psnr_db"],
        **costs(result, summary),
    }


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """SNR against noise."""
    series = {"decoded differences": [(r["noise"], r["snr_edges_db"], f"{r['bytes']:,} B") for r in rows]}
    return curves(series, "noise (times physical)", "SNR (dB)", "Noise: error and what it costs")
