"""Rows by which the reset pointer leads, in a room of 500 lux, on the default scene and through the chip's Verilog: SNR
of the decoded differences and PSNR of the image rebuilt from them against how long a row integrates and a frame takes.
Past a full well differences are lost, which the image shows and the SNR, against the same wells, does not."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.frame import job
from talbot.imaging.frame.figures import summarize
from talbot.imaging.frame.request import FrameRequest, request
from talbot.imaging.tradeoff.threshold import costs

ROWS = (0, 4, 16, 48, 96, 144, 192, 240, 288, 384)


def points(quick: bool) -> list[tuple[int, int]]:
    """Rows of lead, and rows of the array."""
    return [(rows, 48 if quick else 384) for rows in (ROWS[::4] if quick else ROWS)]


def measure(point: tuple[int, int]) -> dict[str, Any]:
    """Quality and cost of a frame with this lead."""
    lead, size = point
    return exposed(request(rows=size, cols=size, exposure=lead))


def exposed(request: FrameRequest) -> dict[str, Any]:
    """Rows of lead, exposure, quality and cost of a frame."""
    result = job.simulate_frame(request)
    summary = summarize(result)
    x = summary["exposure"]
    return {
        "exposure": x["rows"],
        "integration_ms": 1e3 * x["integration_s"],
        "frame_ms": 1e3 * summary["frame_s_at_clock"],
        "white_of_full_well": x["white_volts"] / request.sensor.electrical.swing,
        "deviating_rows": x["deviating_rows"],
        "snr_edges_db": summary["snr_db"],
        "psnr_image_db": result.rebuilt.psnr_db,
        **costs(result, summary),
    }


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """SNR against the time that a row integrates."""
    series = {
        "decoded differences": [(r["integration_ms"], r["snr_edges_db"], f"{r['frame_ms']:.3g} ms") for r in rows],
        "image rebuilt from them": [(r["integration_ms"], r["psnr_image_db"], "") for r in rows],
    }
    labels = "a row integrates (ms); number: the frame takes", "SNR, of the image PSNR (dB)"
    return curves(series, *labels, "Exposure: error against time, 500 lux", log_x=True)
