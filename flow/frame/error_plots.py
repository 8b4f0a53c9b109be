"""Error against run time of this scene, for the report, measured again in every run.

`make tradeoff` has the full ones.
"""

from dataclasses import replace
from typing import Any

from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.models.chip import golden_frame

from . import hardware
from .quality import decoding_error, snr
from .result import FrameResult

LADDER = (0, 1, 2, 4, 8, 16, 32, 64, 127)


def figures(result: FrameResult, summary: dict[str, Any]) -> list[Figure]:
    """Plots of the chip over the threshold, in edge mode, and of the capture model."""
    out = [_threshold(result, summary)] if result.request.frame.mode == "edge" else []
    return [*out, _capture(result)] if result.exposed.views.tried else out


def _threshold(result: FrameResult, summary: dict[str, Any]) -> Figure:
    """SNR of the decoded differences against bytes and frame time, each threshold run through the Verilog."""
    sensor, samples = result.request.sensor, result.exposed.samples
    points, labelled = [], 0
    for threshold in LADDER:
        frame = replace(result.request.frame, threshold=threshold)
        golden = golden_frame(samples, sensor, frame, result.exposed.front_end)
        chip = hardware.simulate(result.program, sensor, frame, samples, result.exposed.front_end)
        error = decoding_error(golden.sent, result.exposed.ideal, golden.read, frame)
        quality = snr(error, result.exposed.ideal[golden.read])
        if quality is None:
            continue
        apart = abs(len(chip.stream) - labelled) > 0.1 * labelled  # else labels overlap
        label = f"T={threshold}: {1e3 * chip.status['cycles'] / sensor.chip.f_clk:.2f} ms" if apart else ""
        labelled = len(chip.stream) if apart else labelled
        points.append((len(chip.stream), quality, label))
    here = summary["stream_bytes"], summary["snr_db"]
    mark, title = None if None in here else here, "Threshold: error against bytes, and the chip's frame time"
    return curves({"differences": points}, "bytes a frame", "SNR (dB; nothing sent: 0)", title, log_x=True, mark=mark)


def _capture(result: FrameResult) -> Figure:
    """Error of the capture against time, over the numbers of views that were tried on this scene."""
    tried = [(1e3 * seconds, error, str(views)) for views, error, seconds in result.exposed.views.tried if error]
    labels = "time (ms); number: views along the pupil", "RMS error (codes)"
    return curves({"differences": tried}, *labels, "Capture: error against 31 x 31 views", log_y=True)
