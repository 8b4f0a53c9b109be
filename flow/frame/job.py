"""The main job: scene -> samples -> chip's Verilog -> stream -> decoded -> compared -> pictures and report."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt

from base.files import check_folder, staged
from flow.simulate.frame import Waves
from models.afe import trim_codes, trim_gain
from models.capture import Exposure, capture
from models.chip import front_end_of, golden_frame
from models.digital.stream import decode_stream
from models.pixel.trim import optical_gains
from models.plan import Plan, plan
from models.scene import Sampling, Scene, load

from . import hardware
from .figures import summarize
from .request import FrameRequest
from .result import Exposed, FrameResult

STEPS = ("setup", "capture", "build", "rtl", "decode", "report")


@dataclass
class Clock:
    """Wall clock of the named steps, in s; ``note`` is called with the name of each as it starts."""

    seconds: dict[str, float] = field(default_factory=dict)
    note: Callable[[str], None] = lambda name: None

    @contextmanager
    def step(self, name: str) -> Iterator[None]:
        """Add the time of the body to the step ``name``."""
        self.note(name)
        start = perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + perf_counter() - start


def see(request: FrameRequest) -> tuple[Scene, Plan]:
    """The scene that ``request`` names and the plan of its frame. Raises ParameterError."""
    scene = load(request.scene, Sampling.of(request.sensor), request.depth)
    return scene, plan(scene, request.sensor, request.frame)


def expose(request: FrameRequest, scene: Scene, todo: Plan) -> Exposed:
    """Expose ``scene``. The trims come from the optics."""
    sensor, frame = request.sensor, request.frame
    trims = trim_codes(optical_gains(sensor.tile, sensor.optics))
    front_end = front_end_of(sensor, trims)

    def samples(noise: float) -> npt.NDArray[np.float64]:
        exposure = Exposure(sensor.electrical, frame.timing, sensor.chip.f_clk, noise, request.seed)
        return np.asarray(capture(scene, sensor, todo, exposure, trim_gain(trims)), np.float64)

    noisy = samples(request.noise)
    clean = samples(0.0) if request.noise else noisy
    ideal = np.moveaxis(front_end.values(clean, frame.mode), 0, 2)
    return Exposed(scene, todo, front_end, noisy, ideal)


def read_out(
    request: FrameRequest, exposed: Exposed, program: Path, clock: Clock | None = None, waves: Waves | None = None
) -> FrameResult:
    """Read one exposure out through the chip's Verilog and the golden chip. Raises ToolError."""
    clock = clock or Clock()
    sensor, frame = request.sensor, request.frame
    with clock.step("rtl"):
        chip = hardware.simulate(program, sensor, frame, exposed.samples, exposed.front_end, waves=waves)
    with clock.step("decode"):
        golden = golden_frame(exposed.samples, sensor, frame, exposed.front_end)
        decoded = decode_stream(chip.stream, sensor.tile)[0]  # StreamError for a stream without a frame
    return FrameResult(request, exposed, program, golden, chip, decoded)


def simulate_frame(request: FrameRequest) -> FrameResult:
    """One frame from the scene to the decoded stream, without files. Raises ParameterError, ToolError."""
    scene, todo = see(request)
    return read_out(request, expose(request, scene, todo), hardware.program(request.sensor, todo.taps))


def run(request: FrameRequest, note: Callable[[str], None] = lambda text: None) -> dict[str, Any]:
    """Run the main job and write its files into ``request.folder``; returns summary.json.

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
        waves = Waves(folder / "waves.vcd", *request.waves) if request.waves else None
        result = read_out(request, exposed, program, clock, waves)
        with clock.step("report"):
            summary = summarize(result)
            summary["wall_s"] = clock.seconds
            outputs.write(folder, result, summary)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n")
    return summary
