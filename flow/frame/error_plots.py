"""Error against run time of this scene, for the report: two short sweeps, measured again in every run.

`make tradeoff` has the full ones.
"""

from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from base.charts import curves
from models.capture import CaptureOperator
from models.chip import golden_frame
from models.parameters import SensorParameters
from models.pixel.weights import raw_weights

from . import hardware
from .figures import decoding_error, psnr
from .result import FrameResult

Field = npt.NDArray[np.floating]
LADDER = (0, 1, 2, 4, 8, 16, 32, 64, 127)


def figures(result: FrameResult, summary: dict[str, Any]) -> list[Figure]:
    """Plots of the chip over the threshold, in edge mode, and of the capture model."""
    out = [_threshold(result, summary)] if result.request.frame.mode == "edge" else []
    return [*out, _capture(result)]


def _threshold(result: FrameResult, summary: dict[str, Any]) -> Figure:
    """PSNR of the decoded differences against bytes and frame time, each threshold run through the Verilog."""
    sensor, samples = result.request.sensor, result.exposed.samples
    points, labelled = [], 0
    for threshold in LADDER:
        frame = replace(result.request.frame, threshold=threshold)
        golden = golden_frame(samples, sensor, frame, result.exposed.front_end)
        chip = hardware.simulate(result.program, sensor, frame, samples, result.exposed.front_end)
        quality = psnr(decoding_error(golden.sent, result.exposed.ideal, golden.read, frame))
        if quality is None:
            continue
        apart = abs(len(chip.stream) - labelled) > 0.1 * labelled  # else labels overlap
        label = f"T={threshold}: {1e3 * chip.status['cycles'] / sensor.chip.f_clk:.2f} ms" if apart else ""
        labelled = len(chip.stream) if apart else labelled
        points.append((len(chip.stream), quality, label))
    here = summary["stream_bytes"], summary["psnr_db"]
    mark, title = None if None in here else here, "Threshold: error against bytes, and the chip's frame time"
    return curves({"differences": points}, "bytes a frame", "PSNR (dB)", title, log_x=True, mark=mark)


def _capture(result: FrameResult) -> Figure:
    """Relative error of one capture against time: fewer angular nodes, and float32 for float64."""
    sensor, scene = result.request.sensor, result.exposed.scene
    field = scene.light_field.astype(np.float64)
    best = _captured(_with_nodes(sensor, 16), field, "float64")[0]
    series: dict[str, list[tuple[float, float, str]]] = {}
    for dtype in ("float64", "float32"):
        series[dtype] = []
        for nodes in (1, 2, 3, 4, 6, 8):
            pair, seconds = _captured(_with_nodes(sensor, nodes), field.astype(dtype), dtype)
            error = float(np.abs(pair - best).max() / max(float(best.max()), np.finfo(float).tiny))
            series[dtype].append((1e3 * seconds, max(error, 1e-17), str(nodes)))
    labels = "weights and capture (ms); number: nodes a view cell", "largest error / largest value"
    return curves(series, *labels, "Capture model: error against run time", log_y=True)


def _with_nodes(sensor: SensorParameters, nodes: int) -> SensorParameters:
    return replace(sensor, optics=replace(sensor.optics, subsamples=nodes))


def _captured(sensor: SensorParameters, field: Field, dtype: str) -> tuple[Field, float]:
    raw_weights.cache_clear()
    start = perf_counter()
    operator = CaptureOperator(sensor, dtype, angular=field.shape[0] > 1 or sensor.optics.views == 1)
    pair = operator.forward(field)
    return pair, perf_counter() - start
