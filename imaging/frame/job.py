"""The main job: scene -> samples -> chip's Verilog -> stream -> decoded -> compared -> pictures and report."""

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.files import check_folder, staged
from talbot.base.kept import kept
from talbot.base.progress import say
from talbot.base.tools import meanwhile
from talbot.imaging.frame import hardware
from talbot.imaging.frame.figures import summarize
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.frame.result import Exposed, FrameResult, GoldenResult
from talbot.imaging.simulate.frame import Waves
from talbot.models.afe import FrontEnd, trim_codes, trim_gain
from talbot.models.capture import (
    Exposure,
    Region,
    Views,
    captured,
    exposed,
    full_pixels,
    instants,
    integrate,
    moving_currents,
)
from talbot.models.capture import expose as expose_pair
from talbot.models.chip import GoldenFrame, front_end_of, golden_frame
from talbot.models.digital.stream import decode_stream
from talbot.models.digital.stream.frame import DecodedFrame
from talbot.models.parameters import ELEMENTARY_CHARGE, AmpTiming, FrameParameters, SensorParameters, TileParameters
from talbot.models.pixel import measured_gains
from talbot.models.pixel.trim import optical_gains
from talbot.models.plan import Plan, plan
from talbot.models.scene import Sampling, Scene, load

Values = npt.NDArray[np.float64]
BENCH = 4  # the noise of a frame after those of the four taps
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
    """Return the scene that ``request`` names and the plan of its frame. Raises ParameterError."""
    scene = _loaded(request)
    for note in scene.notes:
        say(note)
    todo = plan(scene, request.sensor, request.frame)
    instants(scene, request.sensor, todo, request.frame.exposing)  # too fast, or moving in time of flight: refused here
    return scene, todo


def _loaded(request: FrameRequest) -> Scene:
    """Return the scene; that of a request which names none is kept, with the functions that render it."""
    sampling = replace(Sampling.of(request.sensor), light=request.wavelengths)
    if request.scene == FrameRequest.scene and request.depth is None:
        return Scene(**kept("scenes", _parts, request.scene, sampling))
    return load(request.scene, sampling, request.depth)


def _parts(name: str, sampling: Sampling) -> dict[str, Any]:
    """Return the fields of a scene: a copy of the scene itself would hold all of its light field."""
    scene = load(name, sampling)
    return {item.name: getattr(scene, item.name) for item in fields(scene)}


def expose(
    request: FrameRequest,
    scene: Scene,
    todo: Plan,
    front_end: FrontEnd | None = None,
    views: Views | None = None,
    number: int = 0,
) -> Exposed:
    """Expose ``scene``.

    front_end: of an earlier frame of the same chip; None: trimmed to a frame of a flat field. views: None: as many as
    the request says. number: of the frame in a sequence; each has independent temporal noise.
    """
    if views or front_end:  # of a sequence: no frame comes again
        return Exposed(scene, todo, *_samples(request, scene, todo, front_end, views, number))
    return Exposed(scene, todo, *kept("exposed", _samples, request.of_frame, scene, todo, None, None, number))


def _samples(
    request: FrameRequest, scene: Scene, todo: Plan, front_end: FrontEnd | None, views: Views | None, number: int
) -> tuple[Views, FrontEnd, Values, Values, Values, npt.NDArray[np.bool_]]:
    """All of an exposure but its scene and plan; the arguments as of `expose`."""
    sensor, frame = request.lit, request.frame
    front_end = numbered(front_end or trimmed(request), sensor, number)
    timing = frame.exposing
    if views:
        pairs = moving_currents(scene, sensor, todo, timing, regions=views.regions)
    else:
        views, pairs = kept("captured", captured, scene, sensor, todo, timing, request.views)

    noisy = diodes_of(request, pairs, front_end, number)
    clean = diodes_of(replace(request, noise=0.0), pairs, front_end, number) if request.noise else noisy
    ideal = np.moveaxis(front_end.values(clean, frame.mode), 0, 2)
    exposure, balance = _exposure(request, request.noise, number), trim_gain(front_end.trim)
    return views, front_end, noisy, clean, ideal, full_pixels(pairs, sensor, exposure, balance)


def trimmed(request: FrameRequest) -> FrontEnd:
    """Return the sensor's front end; its trims come from a frame of a flat field, or from a calibration.

    Where the dark current alone fills the wells there is no flat field: the trims are those of the optics.
    """
    known = request.calibration
    if known:
        gains = known.gains
    elif dark_filled(request):
        gains = optical_gains(request.lit.tile, request.lit.optics)
    else:
        gains = measured_gains(flat_field(request), request.lit.tile)
    return front_end_of(request.lit, trim_codes(gains))


def diodes_of(request: FrameRequest, pairs: npt.NDArray[np.floating], front_end: FrontEnd, number: int) -> Values:
    """Expose photocurrents ``pairs`` (taps, 2, rows, cols): what the front end samples, (taps, rows, cols, 2) in LSB.

    number: of the frame in a sequence.
    """
    exposure = _exposure(request, request.noise, number)
    diodes = np.asarray(exposed(pairs, request.lit, exposure, trim_gain(front_end.trim)), np.float64)
    return _of_columns(request, diodes, request.frame.mode)


def numbered(front_end: FrontEnd, sensor: SensorParameters, number: int) -> FrontEnd:
    """Return the front end at a frame of a sequence: its noise has the next seed in each (pixels/afe.sv)."""
    if front_end.converter is None:
        return front_end
    seed = (sensor.converter.seed + number) % (1 << 32)
    return replace(front_end, converter=replace(front_end.converter, seed=seed))


def dark_filled(request: FrameRequest) -> bool:
    """Return whether the dark current of a row's integration leaves less than a tenth of a full well to the light."""
    return _dark_electrons(request) > 0.9 * request.sensor.electrical.full_well


def _dark_electrons(request: FrameRequest) -> float:
    return request.sensor.electrical.dark_current * _flat_seconds(request) / ELEMENTARY_CHARGE


def _flat_seconds(request: FrameRequest) -> float:
    return replace(_exposure(request, 0.0), timing=_flat_timing(request)).intervals[0]


def _flat_timing(request: FrameRequest) -> AmpTiming:
    return replace(request.frame.exposing, n_cm=0)


def flat_field(request: FrameRequest) -> Values:
    """Return the sensor's diodes, (rows, cols, 2) in LSB, before a flat field at half of white, dark current taken off.

    One frame of the same chip and timing with independent noise, from which the trims are measured as on a bench: in
    the light of a lamp whose white gives the signal of RoomParameters, whatever the light of the frame is.
    """
    sensor = request.lit
    flat, everywhere = load("flat:50", Sampling.of(sensor)), Region(1, np.ones(sensor.shape, bool))
    pair = kept("flat", integrate, flat, sensor, everywhere)[0]
    room = sensor.electrical.full_well - _dark_electrons(request)
    lamp = request.room.signal * room * ELEMENTARY_CHARGE / _flat_seconds(request) / sensor.electrical.white_current
    exposure = replace(_exposure(request, request.noise), timing=_flat_timing(request))
    light, dark = expose_pair(lamp * pair, exposure, tap=BENCH), expose_pair(0 * pair, replace(exposure, noise=0.0))
    light, dark = (_of_columns(request, diodes[None], "edge")[0] for diodes in (light, dark))
    return light - dark


def _of_columns(request: FrameRequest, diodes: Values, mode: str) -> Values:
    """Return the column amplifiers' outputs for ``diodes`` (taps, rows, cols, 2)."""
    return diodes if request.columns is None else request.columns.samples(diodes, mode)


def _exposure(request: FrameRequest, noise: float, number: int = 0) -> Exposure:
    sensor = request.lit
    return Exposure(sensor.electrical, request.frame.exposing, sensor.chip.f_clk, noise, request.seed, number)


def read_out(
    request: FrameRequest, exposed: Exposed, program: Path, clock: Clock | None = None, waves: Waves | None = None
) -> FrameResult:
    """Read one exposure out through the chip's Verilog and the golden chip. Raises ToolError."""
    clock = clock or Clock()
    sensor, frame = request.sensor, request.frame
    with clock.step("rtl"):
        chip = hardware.simulate(program, sensor, frame, exposed.samples, exposed.front_end, waves=waves)
    with clock.step("decode"):
        golden = kept("golden", _golden, exposed.samples, sensor, frame, exposed.front_end)
        decoded = kept("decoded", _decoded, chip.stream, sensor.tile)
    return FrameResult(request, exposed, golden, decoded, chip, program)


def _golden(samples: Values, sensor: SensorParameters, frame: FrameParameters, front_end: FrontEnd) -> GoldenFrame:
    golden = golden_frame(samples, sensor, frame, front_end)
    _ = golden.stream  # encoded here, and kept with it
    return golden


def _decoded(stream: bytes, tile: TileParameters) -> DecodedFrame:
    """Return the first frame of a stream. Raises StreamError where there is none."""
    return decode_stream(stream, tile)[0]


def simulate_frame(request: FrameRequest, note: Callable[[str], None] = lambda text: None) -> FrameResult:
    """One frame from the scene to the decoded stream, without files.

    note: as in `run`. Raises ParameterError, ToolError.
    """
    clock = Clock(note=note)
    exposed, program = _prepared(request, clock)
    return read_out(request, exposed, program, clock)


def golden_result(request: FrameRequest, note: Callable[[str], None] = lambda text: None) -> GoldenResult:
    """Return the same frame by the golden chip alone. Raises ParameterError."""
    clock = Clock(note=note)
    exposed = _exposed(request, clock)
    with clock.step("decode"):
        return read_golden(request, exposed)


def read_golden(request: FrameRequest, exposed: Exposed) -> GoldenResult:
    """Read one exposure out through the golden chip alone."""
    golden = golden_frame(exposed.samples, request.sensor, request.frame, exposed.front_end)
    return GoldenResult(request, exposed, golden, decode_stream(golden.stream, request.sensor.tile)[0])


def _exposed(request: FrameRequest, clock: Clock) -> Exposed:
    with clock.step("setup"):
        scene, todo = see(request)
    with clock.step("capture"):
        return expose(request, scene, todo)


def _prepared(request: FrameRequest, clock: Clock, waves: str = "") -> tuple[Exposed, Path]:
    """Return the exposure and the simulator, which is built while the scene is captured. waves: as of Build.

    Where the scene cannot be captured the compiler ends, too.
    """
    with clock.step("setup"):
        scene, todo = see(request)
    with meanwhile(hardware.program, request.sensor, waves, clock.note) as program:
        with clock.step("capture"):
            exposed = expose(request, scene, todo)
        with clock.step("build"):
            return exposed, program.result()


def run(
    request: FrameRequest,
    note: Callable[[str], None] = lambda text: None,
    arguments: Mapping[str, object] | None = None,
) -> dict[str, Any]:
    """Run the main job and write its files into ``request.folder``; returns summary.json.

    note: called with the name of each of `STEPS` as it starts, and with a line before each long part of one.
    arguments: of the command line, kept in the summary. Raises ParameterError, ToolError, OSError.
    """
    from talbot.imaging.frame import outputs  # Matplotlib: not before it is needed

    check_folder("out", request.folder, outputs.NAMES)
    clock = Clock(note=note)
    exposed, program = _prepared(request, clock, request.waves_format if request.waves else "")
    with staged(request.folder, outputs.NAMES) as folder:
        waves = Waves(folder / f"waves.{request.waves_format}", *request.waves) if request.waves else None
        result = read_out(request, exposed, program, clock, waves)
        with clock.step("report"):
            summary = summarize(result)
            summary |= {"wall_s": clock.seconds, "arguments": dict(arguments or {})}
            outputs.write(folder, result, summary)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return summary
