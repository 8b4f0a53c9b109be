"""The main job: scene -> samples -> chip's Verilog -> stream -> decoded -> compared -> pictures and report."""

import json
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from time import perf_counter

import numpy as np

from base.files import check_folder, staged
from models.afe import trim_codes, trim_gain
from models.capture import Exposure, capture
from models.chip import front_end_of, golden_frame
from models.digital.stream import decode_stream
from models.pixel.trim import optical_gains
from models.plan import plan
from models.reconstruct import rebuild
from models.scene import Sampling, load

from . import hardware
from .summary import summarize

STEPS = ("setup", "capture", "build", "rtl", "decode", "report")


@dataclass
class Clock:
    """Wall clock of the named steps, in s; ``note`` is told the name of each as it starts."""

    seconds: dict = field(default_factory=dict)
    note: object = lambda name: None

    @contextmanager
    def step(self, name):
        self.note(name)
        start = perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + perf_counter() - start


@dataclass(frozen=True, eq=False)
class Exposed:
    """One exposure of a scene.

    samples: float64 (taps, rows, cols, 2), what the front end samples. ideal: float64 (rows, cols, subs), the values
    ahead of the converters, in LSB, of the same exposure without noise.
    """

    scene: object
    plan: object
    front_end: object
    samples: np.ndarray
    ideal: np.ndarray


@dataclass(frozen=True, eq=False)
class FrameResult:
    """Everything one run knows, for the summary, the pictures and the report."""

    request: object
    exposed: Exposed
    program: Path
    golden: object
    chip: object
    decoded: object

    @cached_property
    def rebuilt(self):
        """The 2-D image rebuilt from the decoded edges alone (models.reconstruct.rebuild)."""
        return rebuild(
            self.decoded.samples[..., 0],
            self.decoded.read,
            self.exposed.scene,
            self.request.sensor,
            self.exposed.front_end.trim,
            self.request.frame.timing,
        )


def see(request):
    """The scene that ``request`` names and the plan of its frame."""
    array, optics = request.sensor.array, request.sensor.optics
    scene = load(request.scene, Sampling(array.rows, array.cols, optics.views, request.focus), request.depth)
    return scene, plan(scene, request.sensor, request.frame)


def expose(request, scene, todo):
    """Expose ``scene``; returns Exposed. The trims come from the optics."""
    sensor, frame = request.sensor, request.frame
    trims = trim_codes(optical_gains(sensor.tile, sensor.optics))
    front_end = front_end_of(sensor, trims)

    def samples(noise):
        exposure = Exposure(sensor.electrical, frame.timing, sensor.chip.f_clk, noise, request.seed)
        return capture(scene, sensor, todo, exposure, trim_gain(trims))

    noisy = samples(request.noise)
    clean = samples(0.0) if request.noise else noisy
    ideal = np.moveaxis(front_end.values(clean, frame.mode), 0, 2)
    return Exposed(scene, todo, front_end, noisy, ideal)


def read_out(request, exposed, program, clock=None, waves=None):
    """Read one exposure out through the chip's Verilog and the golden chip; returns FrameResult."""
    clock = clock or Clock()
    sensor, frame = request.sensor, request.frame
    with clock.step("rtl"):
        chip = hardware.simulate(program, sensor, frame, exposed.samples, exposed.front_end, waves=waves)
    with clock.step("decode"):
        golden = golden_frame(exposed.samples, sensor, frame, exposed.front_end)
        decoded = decode_stream(chip.stream, sensor.tile)[0]  # of a stream without a frame: StreamError
    return FrameResult(request, exposed, program, golden, chip, decoded)


def run(request, note=lambda text: None):
    """Run the main job and write its files into ``request.folder``; returns the summary (a dict).

    note: called with the name of each of `STEPS` as it starts, and with a line before each long part of one.
    Raises ParameterError, ToolError, OSError.
    """
    from . import outputs  # Matplotlib: not before it is needed

    check_folder("out", request.folder)
    clock = Clock(note=note)
    with clock.step("setup"):
        scene, todo = see(request)
    with clock.step("capture"):
        exposed = expose(request, scene, todo)
    with clock.step("build"):
        program = hardware.program(request.sensor, todo.taps, bool(request.waves), note)
    with staged(request.folder, outputs.NAMES) as folder:
        waves = (folder / "waves.vcd", *request.waves) if request.waves else None
        result = read_out(request, exposed, program, clock, waves)
        with clock.step("report"):
            summary = summarize(result)
            summary["wall_s"] = clock.seconds
            outputs.write(folder, result, summary)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n")
    return summary
