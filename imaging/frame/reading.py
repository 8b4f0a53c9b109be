"""One frame of the chip for a reconstruction: `talbot lightfield`, `polar` and `depth` from their options to files."""

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from talbot.base.files import check_folder, staged
from talbot.base.page import Tile
from talbot.base.paths import results_of
from talbot.base.progress import Steps
from talbot.imaging.frame import report
from talbot.imaging.frame.command import add_frame_arguments, arguments_of, name_of, request_of, tell_replaced, typed_of
from talbot.imaging.frame.figures import mismatches
from talbot.imaging.frame.job import golden_result, simulate_frame
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.frame.result import FrameResult, GoldenResult
from talbot.imaging.frame.sensor import asked_sensor
from talbot.imaging.simulate.frame import WAVES
from talbot.models.parameters import CameraParameters, SensorParameters
from talbot.models.scene.rendered import RENDERED

# All of a frame is read
WHOLE = {"threshold": "0", "phase": False, "types": "all", "window": "full", "decimation": "0"}
WHOLE |= {"waves": None, "waves_format": WAVES[0]}
Note = Callable[[str], None]


class Found(Protocol):
    """Result of a reconstruction: its figures are ``summary``."""

    @property
    def summary(self) -> dict[str, Any]:
        """Figures of summary.json."""
        ...


def add_arguments(
    parser: ArgumentParser,
    command: str,
    scene: str,
    fixed: Mapping[str, Any],
    camera: CameraParameters = CameraParameters(),
) -> None:
    """Options of the scene, the sensor and the frame: texts, checked by `asked`.

    fixed, with `WHOLE`, and camera: see `add_frame_arguments`.
    """
    add = parser.add_argument
    add("--scene", default=scene, help="name of a scene, an image, or a light field, as for talbot sim")
    add("--depth", help="depth file for --scene (models/scene/README.md)")
    add_frame_arguments(parser, WHOLE | dict(fixed), camera)
    add("--golden", action="store_true", help="by the golden chip alone, without its Verilog")
    add("--out", help=f"folder for the results (default: build/{command}/<scene>, named as by sim)")


def asked(
    options: Namespace,
    command: str,
    add_arguments: Callable[[ArgumentParser], None],
    sensor: SensorParameters | None = None,
) -> tuple[FrameRequest, dict[str, Any]]:
    """Return the request, and the arguments that its folder tells. sensor: see `request_of`. Raises ParameterError.

    A rendered scene has its own size where no other is given.
    """
    typed = typed_of(options, add_arguments)
    options.out = options.out or results_of(command) / name_of(typed)
    no_size = options.rows is None and options.cols is None and options.sensor is None
    if options.scene in RENDERED and no_size:
        size = RENDERED[options.scene].size
        sensor = sensor or asked_sensor(options)
        sensor = replace(sensor, array=replace(sensor.array, rows=size, cols=size))
    return request_of(options, sensor), typed


def frame_of(request: FrameRequest, note: Note, golden: bool) -> GoldenResult:
    """Return the frame by the chip's Verilog, or by the golden chip alone. Raises ParameterError, ToolError."""
    return (golden_result if golden else simulate_frame)(request, note)


def run(
    request: FrameRequest,
    arguments: Mapping[str, Any],
    steps: Sequence[str],
    found: Callable[[Note], Found],
    page: ModuleType,
    show: Callable[[dict[str, Any], Path], None],
) -> int:
    """Compute ``found`` with progress, write its page and summary.json, all or nothing, and show its figures.

    Returns 1 where the chip and the golden model differ. arguments: of the command line, kept in the summary.
    Raises ParameterError, ToolError, OSError.
    """
    check_folder("out", request.folder, page.NAMES)
    before = arguments_of(request.folder)
    with Steps(steps, lines=True) as progress:

        def note(text: str) -> None:
            """No line about the first step: bad input ends it, and it is short."""
            if text != steps[0]:
                progress.note(text)

        done = found(note)
        progress.note("report")
        summary = done.summary | {"arguments": dict(arguments)}
        with staged(request.folder, page.NAMES) as part:
            page.write(part, done)
            (part / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    show(summary, request.folder)
    tell_replaced(before, dict(arguments))
    return int(differs(summary))


def about(result: GoldenResult) -> dict[str, Any]:
    """Return the figures of every summary: the frame, and whether chip and golden model agree."""
    scene = result.exposed.scene
    return {
        "scene": result.request.name,
        "rows": scene.shape[0],
        "cols": scene.shape[1],
        "views": scene.views,
        "noise": result.request.noise,
        "seed": result.request.seed,
        "chip": isinstance(result, FrameResult),
        "stream_mismatches": mismatches(result.stream, result.golden.stream),
        "decoded_mismatches": int((result.decoded.samples != result.golden.sent).sum()),
    }


def rms(error: npt.NDArray[np.floating]) -> float | None:
    """Root of the mean square; None of nothing."""
    return float(np.sqrt(np.mean(error**2))) if error.size else None


def line(s: dict[str, Any]) -> str:
    """Return the text below a page's title, from the summary ``s``."""
    by = "the chip's Verilog" if s["chip"] else "the golden model"
    return f"{s['rows']} x {s['cols']} pixels, {s['views']} x {s['views']} views, noise {s['noise']:g}, by {by}"


def differs(s: dict[str, Any]) -> bool:
    """Return whether chip and golden model differ in the summary ``s``."""
    return bool(s["stream_mismatches"] or s["decoded_mismatches"])


def agreement(s: dict[str, Any]) -> Tile:
    """Return whether chip and golden model agree, where the chip ran."""
    if not s["chip"]:
        return Tile("not run", "the chip's Verilog", "none")
    return report.agreement(s["stream_mismatches"] or s["decoded_mismatches"])


def number(value: float | None, digits: int = 2, unit: str = "") -> str:
    """Return a figure, '-' where there is none."""
    return "-" if value is None else f"{value:.{digits}f}{unit}"
