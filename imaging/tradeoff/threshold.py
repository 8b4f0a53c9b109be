"""The threshold of edge-only conversion on the default scene, through the chip's Verilog: SNR of the decoded
differences and PSNR of the image rebuilt from them against conversions, bytes, cycles, energy and simulation time; the
share converted, what edge mode saves of image mode's energy (uJ), and the share below which it saves any."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.frame import hardware, job
from talbot.imaging.frame.figures import summarize
from talbot.imaging.frame.request import FrameRequest, request
from talbot.imaging.frame.result import Exposed, FrameResult

THRESHOLDS = (0, 1, 2, 4, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 127)


def points(quick: bool) -> list[tuple[int, int]]:
    """Threshold, and rows of the array."""
    return [(t, 48 if quick else 384) for t in (THRESHOLDS[1:12:5] if quick else THRESHOLDS)]


@cache
def _exposure(size: int) -> tuple[FrameRequest, Exposed, Path]:
    """Request, exposure and simulator of the default scene."""
    frame_request = request(rows=size, cols=size)
    scene, todo = job.see(frame_request)
    return frame_request, job.expose(frame_request, scene, todo), hardware.program(frame_request.sensor)


def measure(point: tuple[int, int]) -> dict[str, Any]:
    """Quality and cost of a frame at this threshold."""
    threshold, size = point
    frame_request, exposed, program = _exposure(size)
    frame_request = replace(frame_request, frame=replace(frame_request.frame, threshold=threshold))
    result = job.read_out(frame_request, exposed, program)
    summary = summarize(result)
    quality = {
        "snr_edges_db": summary["snr_db"],
        "psnr_edges_db": summary["psnr_db"],
        "psnr_image_db": result.rebuilt.psnr_db,
    }
    energy, share = summary["energy_uj"], summary["conversions_made"] / summary["samples"]
    saved = {"converted": share, "saved_uj": energy["saved_by_edge"], "pays_below": energy["edge_pays_below"]}
    return {"threshold": threshold, **quality, **costs(result, summary), **saved}


def costs(result: FrameResult, summary: dict[str, Any]) -> dict[str, Any]:
    """Columns of a frame's cost: conversions, bytes, cycles, energy and simulation time."""
    energy, seconds = summary["energy_uj"]["total"], result.chip.seconds
    return {
        "conversions": summary["conversions_made"],
        "bytes": summary["stream_bytes"],
        "cycles": summary["cycles"],
    } | {"energy_uj": energy, "simulation_s": seconds, "mismatches": summary["stream_mismatches"]}


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """SNR against bytes."""
    series = {
        "decoded differences": [(r["bytes"], r["snr_edges_db"], f"T={r['threshold']}") for r in rows],
        "image rebuilt from them": [(r["bytes"], r["psnr_image_db"], "") for r in rows],
    }
    return curves(series, "bytes a frame", "SNR, of the image PSNR (dB)", "Threshold: error against bytes", log_x=True)
