"""The light of the room on the default scene, through the chip's Verilog, the reset pointer's lead chosen for it: SNR
of the decoded differences and PSNR of the image rebuilt from them against the time that a frame takes."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.frame.request import request
from talbot.imaging.tradeoff.exposure import exposed

LUX = (20.0, 50.0, 100.0, 200.0, 500.0, 2000.0, 10000.0, 50000.0)


def points(quick: bool) -> list[tuple[float, int]]:
    """Illuminance of white, and rows of the array."""
    return [(lux, 48 if quick else 384) for lux in (LUX[::4] if quick else LUX)]


def measure(point: tuple[float, int]) -> dict[str, Any]:
    """Quality and cost of a frame in this light."""
    lux, size = point
    return {"lux": lux} | exposed(request(rows=size, cols=size, lux=lux))


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """SNR against the time of a frame."""
    series = {
        "decoded differences": [(r["frame_ms"], r["snr_edges_db"], f"{r['lux']:g} lx") for r in rows],
        "image rebuilt from them": [(r["frame_ms"], r["psnr_image_db"], "") for r in rows],
    }
    return curves(series, "a frame (ms)", "SNR, of the image PSNR (dB)", "Light: error against time", log_x=True)
