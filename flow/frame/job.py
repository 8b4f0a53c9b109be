"""The main job: scene -> samples -> chip's Verilog -> stream -> decoded -> compared -> pictures and report."""

import json
import time
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np

from flow.files import staged
from models.afe import trim_codes
from models.capture import CaptureOperator, expose
from models.digital.chip import golden_frame
from models.digital.stream import decode_stream
from models.plan import plan
from models.scene import load_scene

from . import hardware, outputs
from .summary import summarize


@dataclass
class Clock:
    """Wall clock of the named steps, in s."""

    seconds: dict = field(default_factory=dict)

    @contextmanager
    def step(self, name):
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start


@dataclass(frozen=True)
class FrameResult:
    """Everything one run knows, for the summary, the pictures and the report.

    ideal: the analog values (rows, cols, subs) in LSB of the same exposure without noise.
    """

    request: object
    scene: object
    plan: object
    samples: np.ndarray
    trims: np.ndarray
    ideal: np.ndarray
    golden: object
    chip: object
    decoded: object


def run(request, note=lambda text: None):
    """Run the main job and write its files into ``request.folder``; returns the summary (a dict).

    note: called with a line before each long step. Raises ParameterError, ToolError, OSError.
    """
    clock = Clock()
    with clock.step("setup"):
        scene = load_scene(request.scene, request.sensor, depth=request.depth, focus=request.focus)
        todo = plan(scene, request.sensor, request.frame)
    with clock.step("capture"):
        samples, ideal, trims = capture(scene, todo, request)
    with clock.step("build"):
        binary = hardware.program(request.sensor, samples, waves=bool(request.waves), note=note)
    with staged(request.folder) as folder:
        with clock.step("rtl"):
            waves = (folder / "waves.vcd", *request.waves) if request.waves else None
            chip = hardware.simulate(binary, request.sensor, request.frame, samples, trims, waves=waves)
        with clock.step("decode"):
            golden = golden_frame(samples, request.sensor, request.frame, trims)
            golden.stream       # encoded here, so that its time is counted here
            decoded = decode_stream(chip.stream, request.sensor.tile)[0]
        result = FrameResult(request, scene, todo, samples, trims, ideal, golden, chip, decoded)
        with clock.step("report"):
            summary = summarize(result)
            outputs.write(folder, result, summary, clock)
        summary["wall_s"] = clock.seconds
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n")
    return summary


def capture(scene, todo, request):
    """Samples, ideal held values and trims of one exposure.

    Returns samples (taps, rows, cols, 2), the analog values without noise (rows, cols, subs), and register trims.
    """
    operator = CaptureOperator(request.sensor, todo)
    pair = operator.forward(scene)
    trims = trim_codes(operator.trim_gains)
    samples = expose(pair, request.sensor, request.frame, noise=request.noise, seed=request.seed)
    clean = expose(pair, request.sensor, request.frame, noise=0, seed=request.seed) if request.noise else samples
    from models.afe import held_values
    return samples, held_values(clean, request.sensor, request.frame, trims), trims
