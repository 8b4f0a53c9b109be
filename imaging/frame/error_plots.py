"""Error against run time of this scene, for the report: measured once for the same exposure, scene and sensor.

`make tradeoff` has the full ones.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from markupsafe import Markup

from talbot.base.drawn import drawn
from talbot.base.kept import kept
from talbot.imaging.frame import hardware
from talbot.imaging.frame.quality import decoding_error, snr
from talbot.imaging.frame.result import FrameResult
from talbot.models.afe import FrontEnd
from talbot.models.chip import golden_frame
from talbot.models.parameters import FrameParameters, SensorParameters

LADDER = (0, 1, 2, 4, 8, 16, 32, 64, 127)
SIMULATORS = 2  # that run side by side
Values = npt.NDArray[np.float64]


def figures(result: FrameResult, summary: dict[str, Any]) -> list[Markup]:
    """Plots of the chip over the threshold, in edge mode, and of the capture model, as SVG."""
    out = [_threshold(result, summary)] if result.request.frame.mode == "edge" else []
    return [*out, _capture(result)] if result.exposed.views.tried else out


def _threshold(result: FrameResult, summary: dict[str, Any]) -> Markup:
    """SNR of the decoded differences against bytes and frame time, each threshold run through the Verilog."""
    sensor, exposed = result.request.sensor, result.exposed
    frame = replace(result.request.frame, threshold=0, frame_number=0)
    program = str(result.program)  # the name of its folder is its content
    measured = kept(
        "thresholds", swept, program, sensor, frame, exposed.samples, exposed.ideal, exposed.front_end, result.counted
    )
    points, labelled = [], 0
    for threshold, size, cycles, quality in measured:
        if quality is None:
            continue
        apart = abs(size - labelled) > 0.1 * labelled  # else labels overlap
        label = f"T={threshold}: {1e3 * cycles / sensor.chip.f_clk:.2f} ms" if apart else ""
        labelled = size if apart else labelled
        points.append((size, quality, label))
    here = summary["stream_bytes"], summary["snr_db"]
    mark, title = None if None in here else here, "Threshold: error against bytes, and the chip's frame time"
    labels = "bytes a frame", "SNR (dB; nothing sent: 0)"
    return drawn("curves", {"differences": points}, *labels, title, log_x=True, mark=mark)


def swept(
    program: str,
    sensor: SensorParameters,
    frame: FrameParameters,
    samples: Values,
    ideal: Values,
    front_end: FrontEnd,
    counted: npt.NDArray[np.bool_],
) -> list[tuple[int, int, int, float | None]]:
    """Run ``frame`` through the Verilog at each threshold of LADDER: (threshold, bytes, cycles, SNR in dB).

    samples, ideal: of one exposure, as in `Exposed`. counted: pixels that the SNR is of. Raises ToolError.
    """

    def at(threshold: int) -> tuple[int, int, int, float | None]:
        changed = replace(frame, threshold=threshold)
        chip = hardware.simulate(Path(program), sensor, changed, samples, front_end)
        golden = golden_frame(samples, sensor, changed, front_end)
        error = decoding_error(golden.sent, ideal, counted, changed)
        return threshold, len(chip.stream), chip.status["cycles"], snr(error, ideal[counted])

    with ThreadPoolExecutor(SIMULATORS) as pool:
        return list(pool.map(at, LADDER))


def _capture(result: FrameResult) -> Markup:
    """Error of the capture against time, over the numbers of views that were tried on this scene."""
    tried = [(1e3 * seconds, error, str(views)) for views, error, seconds in result.exposed.views.tried if error]
    labels = "time (ms); number: views along the pupil", "RMS error (codes)"
    return drawn("curves", {"differences": tried}, *labels, "Capture: error against 31 x 31 views", log_y=True)
