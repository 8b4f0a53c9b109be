"""Depth by time of flight, four taps through the chip, unwrapped by the light field that the same taps show."""

from argparse import ArgumentParser, Namespace
from dataclasses import replace
from pathlib import Path
from typing import Any

from talbot.base.arguments import Number
from talbot.imaging.frame import reading
from talbot.imaging.frame.command import camera_of
from talbot.imaging.frame.sensor import asked_sensor
from talbot.imaging.lightfield.command import add_prior_arguments, prior_asked
from talbot.models.parameters import LIFE_SIZE, STANDARD, ElectricalParameters
from talbot.models.pixel.time_of_flight import SPEED_OF_LIGHT

FIXED = {"mode": "tof", "views": "auto"}  # of the capture: as many as `capture` takes
FIXED |= {"light": None, "reflectance": "gray", "irradiance": None}  # the source's
STEPS = ("setup", "capture", "build", "frames", "field", "unwrap", "report")
F_MOD, CONTRAST, AMBIENT = 100e6, 0.7, 0.2
FILE = "or of the sensor file"
F_MOD_HZ = Number("f_mod", "modulation frequency in Hz", 1e5, 1e9, note=f"{F_MOD:g}, {FILE}", kind=float)
CONTRASTS = Number("contrast", "demodulation contrast", 0.01, 1, note=f"{CONTRAST:g}, {FILE}", kind=float)
AMBIENTS = Number("ambient", "ambient light, of white", 0, 10, note=f"{AMBIENT:g}, {FILE}", kind=float)
CODE = Number("code", "chips of a second exposure's code, 2**n - 1 (0: none)", 0, 4095, note=f"0, {FILE}")
CHIP_RATE = Number("chip_rate", "of the code, chips a second", 1e6, 1e9, note=f"250e6, {FILE}", kind=float)
GATE_M = 2.0
GATE = Number(
    "gate",
    "depth of the code's first tap in m; nearer than a chip before it nothing is seen",
    0,
    100,
    note=f"{GATE_M:g}, {FILE}",
    kind=float,
)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot depth`: texts, checked by `run`."""
    reading.add_arguments(parser, "depth", "cornell", FIXED, LIFE_SIZE)
    for number in (F_MOD_HZ, CONTRASTS, AMBIENTS, CODE, CHIP_RATE, GATE):
        number.add(parser)
    parser.add_argument(
        "--direct", action="store_true", help="light straight from the surfaces alone, of a scene that has other"
    )
    add_prior_arguments(parser)


def run(options: Namespace) -> int:
    """Measure one depth field and print the figures; 1 where the chip and the golden model differ."""
    from talbot.imaging.depth import page  # Matplotlib: not before it is needed
    from talbot.imaging.depth.capture import capture
    from talbot.imaging.depth.measure import Depth, read_depth

    standard = STANDARD.electrical
    ours = replace(standard, f_mod=F_MOD, contrast=CONTRAST, ambient_current=AMBIENT * standard.white_current)
    default = replace(STANDARD, optics=replace(STANDARD.optics, camera=LIFE_SIZE), electrical=ours)
    sensor = asked_sensor(options, default)
    e = sensor.electrical
    coded, changes = _code(options, e), {"code": 0}  # a sine modulates the first exposures
    if options.f_mod is not None:
        changes["f_mod"] = F_MOD_HZ.value(options)
    if options.contrast is not None:
        changes["contrast"] = CONTRASTS.value(options)
    if options.ambient is not None:
        changes["ambient_current"] = AMBIENTS.value(options) * e.white_current
    camera = camera_of(options, sensor.optics.camera)
    sensor = replace(sensor, optics=replace(sensor.optics, camera=camera), electrical=replace(e, **changes))
    frame_request, typed = reading.asked(options, "depth", add_arguments, sensor)
    prior = prior_asked(options, frame_request)
    code = replace(frame_request.sensor.electrical, **coded) if coded["code"] else None

    def found(note: reading.Note) -> Depth:
        frames = capture(frame_request, note, options.golden, code, options.direct)
        return read_depth(frames, prior(frames.sums), note)

    return reading.run(frame_request, typed, STEPS, found, page, _print)


def _code(options: Namespace, file: ElectricalParameters) -> dict[str, Any]:
    """Fields of the code of the second exposure: of the options, else of the sensor ``file``. Raises ParameterError."""
    chips, rate, gate = (number.value(options) for number in (CODE, CHIP_RATE, GATE))
    usual = file if file.code else replace(STANDARD.electrical, code_delay=2 * GATE_M / SPEED_OF_LIGHT)
    return {
        "code": usual.code if chips is None else chips,
        "chip_rate": usual.chip_rate if rate is None else rate,
        "code_delay": usual.code_delay if gate is None else 2 * gate / SPEED_OF_LIGHT,
    }


def _print(s: dict[str, Any], folder: Path) -> None:
    from talbot.imaging.depth.page import lead_line, rows

    size, span = f"{s['rows']} x {s['cols']} pixels", f"{s['range_m']:.3f} m, {s['ambiguity_m']:.3f} m a turn"
    print(f"{s['scene']}: depth of {size} over {span}")
    print(f"  {lead_line(s)}")
    for name, error, share, known, whole in rows(s):
        print(f"  {name:<50}{error:>9} {share:>8}  in {known:>7} of the pixels; in all {whole:>9}")
    less = s["left_out"]
    if less:
        print(f"  nothing moves: three taps take {less['seconds']:.2f} s instead of {s['seconds']:.2f} s")
    wrong = s["multipath"]
    if wrong:
        error, middle = (f"{1e3 * wrong[key]:.1f} mm" for key in ("rms_m", "median_m"))
        print(f"  light that comes by other ways moves the phase's depth by {middle} (median), {error} RMS")
    behind = s["behind"]
    if behind:
        error, mixed = (f"{behind[key]:.4f} m" for key in ("rms_m", "rms_all_rays_m"))
        where = f"{behind['range_m']:.3f} m, in {100 * behind['seen']:.1f} % of the pixels"
        print(f"  behind the occluder {error} RMS of {where}; by all rays {mixed}")
    print(f"  look at {folder / 'depth.html'}")
