"""The lens before the default scene, through the chip's Verilog, exposed for 500 lux: f-numbers, and distances of the
focal plane. SNR of the decoded differences and PSNR of the image rebuilt from them against the time of a frame; views
and time of the capture. A slower lens blurs less and needs longer rows."""

from collections.abc import Sequence
from time import perf_counter
from typing import Any

from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.base.kept import afresh
from talbot.imaging.frame import hardware, job
from talbot.imaging.frame.figures import summarize
from talbot.imaging.frame.request import request
from talbot.imaging.tradeoff.threshold import costs
from talbot.models.parameters import CameraParameters

F_NUMBERS = (1.2, 1.7, 2.4, 3.4, 4.8)
FOCUS = (0.15, 0.17, 0.19, 0.23, 0.27, 0.33)  # m: over the scene's depth, the default left out


def points(quick: bool) -> list[tuple[float, float, int]]:
    """F-number, distance of the focal plane in m, and rows of the array."""
    default, size = CameraParameters(), 48 if quick else 384
    by_lens = [(f_number, default.focus, size) for f_number in (F_NUMBERS[::4] if quick else F_NUMBERS)]
    return by_lens + [(default.f_number, focus, size) for focus in (FOCUS[3:4] if quick else FOCUS)]


def measure(point: tuple[float, float, int]) -> dict[str, Any]:
    """Quality and cost of a frame through this lens."""
    f_number, focus, size = point
    frame_request = request(rows=size, cols=size, camera=CameraParameters(f_number=f_number, focus=focus))
    start = perf_counter()
    with afresh():
        scene, todo = job.see(frame_request)
        exposed = job.expose(frame_request, scene, todo)
    seconds = perf_counter() - start
    result = job.read_out(frame_request, exposed, hardware.program(frame_request.sensor))
    summary = summarize(result)
    return {
        "f_number": f_number,
        "focus_m": focus,
        "views": summary["camera"]["views"],
        "quadrature_error_codes": summary["quadrature_error_codes"],
        "capture_s": seconds,
        "frame_ms": 1e3 * summary["frame_s_at_clock"],
        "integration_ms": 1e3 * summary["exposure"]["integration_s"],
        "snr_edges_db": summary["snr_db"],
        "psnr_image_db": result.rebuilt.psnr_db,
        **costs(result, summary),
    }


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """SNR against the time of a frame, of the f-numbers."""
    focus = CameraParameters().focus
    lenses = [r for r in rows if r["focus_m"] == focus]
    series = {
        "decoded differences": [(r["frame_ms"], r["snr_edges_db"], f"f/{r['f_number']:g}") for r in lenses],
        "image rebuilt from them": [(r["frame_ms"], r["psnr_image_db"], "") for r in lenses],
    }
    return curves(
        series, "a frame (ms)", "SNR, of the image PSNR (dB)", "Lens: error against time, 500 lux", log_x=True
    )
