"""A scene through the golden models and the Verilog of the whole chip."""

import json
import re
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from talbot.base.arguments import Number, number_of, span
from talbot.base.cache import digest
from talbot.base.paths import results_of
from talbot.base.progress import Steps
from talbot.base.sensor import Varied
from talbot.base.tools import meanwhile
from talbot.imaging.frame import arguments as text
from talbot.imaging.frame.arguments import named
from talbot.imaging.frame.sensor import add_pixel, asked_sensor
from talbot.imaging.simulate.frame import WAVES
from talbot.models.parameters import (
    COLS_MAX,
    EXPOSURE_MAX,
    LANES,
    LIGHTS,
    MODES,
    ROWS_MAX,
    STANDARD,
    SURFACES,
    CameraParameters,
    ParameterError,
    SensorParameters,
    check_choice,
    circuit_columns,
    drawn_electrical,
)

if TYPE_CHECKING:
    from talbot.imaging.frame.request import FrameRequest


NAME_MAX = 120  # characters of a folder's name
# Options that a sensor file has, too, and their texts without one
OF_SENSOR = {"rows": "384", "cols": "384", "lanes": "8", "converter": "circuit"}
VIEWS = "384, or of a light field's views"
MEASURED = "afe = circuit has what ngspice measured of the drawn circuit"
OF_CIRCUIT = Varied(
    ("array.rows", "array.cols", "tile", "optics"),
    {"converter": MEASURED}
    | {f"electrical.{name}": MEASURED for name in ("full_well", "swing", "read_noise", "dark_current")}
    | {f"electrical.{name}": MEASURED for name in ("gain_fpn", "offset_fpn", "column_fpn", "difference_gain")}
    | {"chip.f_clk": MEASURED, "array.pitch": MEASURED},
)
NUMBERS = (
    Number("views", "of the capture along the pupil's diameter", 1, 31, "auto", "auto", "as many as it needs"),
    Number("threshold", "edge mode: |code| below this is left out", 0, 127, "10"),
    Number("rows", "pixels", 1, ROWS_MAX, note=VIEWS),
    Number("cols", "pixels", 1, COLS_MAX, note=VIEWS),
    Number("decimation", "log2 of the tile step", 0, 3, "0"),
    Number("lux", "illuminance of white, except in time of flight", 1e-3, 1e6, "500", kind=float),
    Number("irradiance", "of white in W/m2, instead of lux, with light", 1e-6, 1e4, note="by lux", kind=float),
    Number("exposure", "rows by which the reset pointer leads", 0, EXPOSURE_MAX, "auto", "auto", "as the light asks"),
    Number("lanes", "converters, a power of two", min(LANES), max(LANES), note=OF_SENSOR["lanes"]),
    Number("noise", "times the physical noise", 0, 100, "1.0", kind=float),
    Number("seed", "of every random draw", 0, 2**32 - 1, "1"),
)

CAMERA = {
    "f-number": "focal length over the lens's diameter, 0.5..32 (default: {default.f_number:g})",
    "focal": "focal length in m, 0.0001..1 (default: {default.focal_length:g})",
    "focus": "distance of the focal plane in m (default: {default.focus:g})",
    "scale": "the scene is a model, 1:scale of its own metres (default: {default.scale:g})",
    "pupil": "distance of the exit pupil from the sensor in m (default: infinity, telecentric)",
}


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot sim`: texts, checked by `run`."""
    add = parser.add_argument
    add(
        "--scene",
        default="motorcycle",
        help="name of a scene (--scene list shows them), an image, or a light field: "
        "a folder, .npy, .npz, x_eslf.png, or tiles.png:9 of 9 x 9 views (models/scene/README.md)",
    )
    add("--depth", help="depth file for --scene: .npy/.npz in m, or an image (see models/scene/README.md)")
    add_frame_arguments(parser)
    add("--out", help="folder for the results (default: build/sim/<scene>, with the settings typed: coins-raw)")
    add("--waves", help="also write waves.vcd of these rows, first:last (1 = the first four rows)")
    add("--waves-format", default=WAVES[0], help="vcd, or fst: smaller, needs the headers of zlib and lz4 to compile")


def add_frame_arguments(
    parser: ArgumentParser, fixed: Mapping[str, Any] | None = None, camera: CameraParameters = CameraParameters()
) -> None:
    """Options of the sensor, its camera and a frame.

    fixed: value by name, of options of `talbot sim` that the command does not have. camera: of the sensor without a
    file.
    """
    fixed = fixed or {}
    parser.set_defaults(**fixed)

    def add(option: str, **rest: Any) -> None:
        if option[2:].replace("-", "_") not in fixed:
            parser.add_argument(option, **rest)

    def add_numbers(*fields: str) -> None:
        for number in NUMBERS:
            if number.field in fields and number.field not in fixed:
                number.add(parser)

    add("--sensor", help="sensor file; talbot sensor prints one to start from. What is given here replaces what it has")
    add_pixel(parser)
    add("--calibration", help="calibration.json of talbot calibrate, used instead of the sensor's true optics")
    add_camera_arguments(parser, camera)
    add_numbers("views")
    add("--mode", default="edge", help="one of " + ", ".join(MODES))
    add_numbers("threshold", "rows", "cols")
    add("--types", default="all", help="pixel types: 0x<mask>, numbers 0..23, or groups " + ", ".join(text.TYPE_GROUPS))
    add("--window", default="full", help="tiles to read, inclusive: row0:row1,col0:col1")
    add_numbers("decimation", "lux", "irradiance")
    lights, surfaces = ", ".join((*LIGHTS, "laser:NM")), ", ".join(SURFACES)
    add("--light", help=f"spectrum of the light, one of {lights} (default: one wavelength, that of the pixels)")
    add("--reflectance", default="gray", help=f"of all surfaces of the scene, with light: one of {surfaces}")
    add_numbers("exposure", "lanes")
    add("--phase", action="store_true", help="tof mode: phase and amplitude from the chip's divider")
    add("--converter", help="circuit (INL, offset, noise as ngspice has them), or ideal (default: circuit)")
    add(
        "--afe",
        default="ideal",
        help="ideal: straight columns; circuit: columns' curves and full well as ngspice has them",
    )
    add_numbers("noise", "seed")


def add_camera_arguments(parser: ArgumentParser, default: CameraParameters) -> None:
    """Options of the lens; defaults are the sensor's."""
    for name, words in CAMERA.items():
        parser.add_argument(f"--{name}", help=words.format(default=default))


def run(options: Namespace) -> int:
    """Simulate one frame and print its figures; 1 where the chip and the golden model differ."""
    if options.scene == "list":
        from talbot.models.scene import scenes

        print("\n".join(sorted(scenes)))
        return 0
    typed = typed_of(options, add_arguments)
    options.out = options.out or results_of("sim") / name_of(typed)
    frame_request = request_of(options)
    from talbot.imaging.frame import ahead  # Matplotlib and more: not before the arguments are right
    from talbot.imaging.frame.job import STEPS, run

    before = arguments_of(frame_request.folder)
    with meanwhile(ahead.compiled), Steps(STEPS) as steps:
        summary = run(frame_request, steps.note, typed)
    _print_figures(summary, frame_request.folder)
    tell_replaced(before, typed)
    return 1 if summary["stream_mismatches"] or summary["decoded_mismatches"] else 0


def typed_of(
    options: Namespace, add_arguments: Callable[[ArgumentParser], None], without_file: Mapping[str, str] = OF_SENSOR
) -> dict[str, Any]:
    """Return the scene, then every argument that is not its default; not the folder.

    without_file: values of options that a sensor file has, too, where there is none.
    """
    parser = ArgumentParser()
    add_arguments(parser)
    defaults, chosen = vars(parser.parse_args([])), vars(options)
    usual = {} if chosen["sensor"] else without_file

    def is_told(name: str) -> bool:
        default = usual.get(name) if defaults[name] is None else defaults[name]
        return name == "scene" or name != "out" and chosen[name] not in (None, default)

    return {name: chosen[name] for name in defaults if is_told(name)}


def name_of(typed: dict[str, Any]) -> str:
    """Return a folder's name: coins-raw, motorcycle-types=low,high-window=10_40,8_50; a long one ends in a digest."""
    parts = [named(typed["scene"])]
    for name, value in list(typed.items())[1:]:
        value = Path(value).stem if name in ("depth", "sensor", "calibration") else value
        parts.append(value if name == "mode" else name if value is True else f"{name}={value}")
    text = re.sub(r"[^\w.,=+-]", "_", "-".join(parts))
    return text if len(text) <= NAME_MAX else f"{text[: NAME_MAX - 17]}-{digest(text)}"


def tell_replaced(before: dict[str, Any] | None, typed: dict[str, Any]) -> None:
    """Print which run was in the folder before, where it had other arguments. before: of `arguments_of`."""
    if before is not None and before != typed:
        print(f"  replaced there: {name_of(before)}")


def arguments_of(folder: Path) -> dict[str, Any] | None:
    """Return the arguments of the run whose results are in ``folder``, None where there is none."""
    try:
        arguments = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["arguments"]
        return arguments if arguments["scene"] else None
    except (OSError, ValueError, LookupError, TypeError):
        return None


def request_of(a: Namespace, sensor: SensorParameters | None = None, sequence: bool = False) -> "FrameRequest":
    """Return the FrameRequest of `add_frame_arguments`, scene, depth, waves and out. Raises ParameterError.

    The sensor has the size of a light field's views where neither rows, cols nor a sensor file are typed.
    sensor: instead of that of the options, their camera included. sequence: the scene is one, no light field.
    """
    from talbot.imaging.frame.request import light_field_of, request
    from talbot.models.calibrate import read_calibration

    no_file, sensor = a.sensor is None, sensor or asked_sensor(a)
    typed = {name: value for name, value in vars(a).items() if value is not None}
    numbers: dict[str, Any] = {number.field: number.value(a) for number in NUMBERS if number.field in typed}
    field = None if sequence else light_field_of(a.scene)
    if field is not None and no_file and not {"rows", "cols"} & typed.keys():
        numbers["rows"], numbers["cols"] = field.own_size()
    rows = numbers.get("rows", sensor.array.rows)
    known = read_calibration(typed["calibration"]) if typed.get("calibration") else None
    waves = (
        None if a.waves is None else (0, min(3, rows - 1)) if a.waves == "1" else span("waves", a.waves, 0, rows - 1)
    )
    names = ("scene", "depth", "mode", "phase", "out", "waves_format", "converter", "light", "reflectance")
    plain = {name: typed[name] for name in names if name in typed}
    if field is not None:
        plain["scene"] = field
    check_choice("afe", a.afe, ("ideal", "circuit"))
    if a.afe == "circuit":
        if "converter" in typed:
            raise ParameterError(f"converter = {a.converter!r}: must be left out with afe = circuit, which has its own")
        plain |= {"converter": "circuit", "columns": circuit_columns()}
        OF_CIRCUIT.check(sensor, replace(STANDARD, electrical=drawn_electrical(STANDARD.electrical)))
        sensor = replace(sensor, electrical=drawn_electrical(sensor.electrical))
    mask = text.pixel_types(a.types)
    window = partial(text.window, a.window)
    return request(
        **plain,
        **numbers,
        sensor=sensor,
        window=window,
        mask=mask,
        camera=camera_of(a, sensor.optics.camera),
        waves=waves,
        calibration=known,
    )


def camera_of(a: Namespace, camera: CameraParameters) -> CameraParameters:
    """Return the ``camera`` with the changes of the options ``a``."""
    field = {"focal": "focal_length", "pupil": "exit_pupil"}
    texts = {name: getattr(a, name) for name in (option.replace("-", "_") for option in CAMERA)}
    chosen: dict[str, Any] = {field.get(n, n): number_of(v) for n, v in texts.items() if v is not None}
    return replace(camera, **chosen)


def _print_figures(s: dict[str, Any], folder: Path) -> None:
    from talbot.imaging.frame.figures import (
        camera_line,
        depth_line,
        energy_line,
        exposure_line,
        full_line,
        light_line,
        trims_line,
    )
    from talbot.imaging.frame.merit import against, decibels, light_field, sent

    print(
        f"{s['scene']}, {s['mode']} mode, {s['rows']} x {s['cols']}: "
        f"{s['stream_mismatches']} stream bytes and {s['decoded_mismatches']} decoded samples differ from the model"
    )
    print(f"  {camera_line(s)}")
    print(f"  {exposure_line(s)}")
    if full_line(s):
        print(f"  {full_line(s)}")
    print(f"  {s['stream_bytes']:,} bytes for {s['raw_bytes']:,} values ({s['compression_ratio']:.2f}:1); {sent(s)}")
    print(f"  2-D image: {against(s)}")
    if s["light_field_psnr_db"] is not None:
        print(f"  light field, {s['light_field_method']}: {light_field(s)}")
    if "light_field_psnr_true_optics_db" in s:
        calibrated, true = (decibels(s[f"light_field_psnr{end}_db"]) for end in ("", "_true_optics"))
        print(f"  light field {calibrated}; with the true optics instead of the calibration {true}")
    if depth_line(s):
        print(f"  {depth_line(s)}")
    if s["quadrature_error_codes"] is not None:
        print(
            f"  captured through {s['camera']['views']} views along the pupil, "
            f"quadrature {s['quadrature_error_codes']:.2f} codes RMS from 31"
            + ", the most: these err themselves"
            * (s["camera"]["views"] == 31)
        )
    if s["hidden_light_codes"] is not None:
        print(f"  light that the middle view does not see: {s['hidden_light_codes']:.2f} codes RMS of the differences")
    if trims_line(s):
        print(f"  {trims_line(s)}")
    print(
        f"  {s['conversions_made']:,} conversions made, {s['conversions_left_out']:,} left out; "
        f"{s['cycles']:,} cycles = {1e3 * s['frame_s_at_clock']:.2f} ms; {energy_line(s)}"
    )
    if light_line(s):
        print(f"  {light_line(s)}")
    print(f"  simulated at {s['rtl_cycles_per_s'] / 1e6:.1f} M cycles/s; wall clock {sum(s['wall_s'].values()):.1f} s")
    print(f"  look at {folder / 'report.html'}")
