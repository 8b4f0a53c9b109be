"""A calibration on the bench: pixel types, trims, chief ray and optical centre from noisy frames of the chip.

With --bench the pixels' test chip: types, efficiency, dark current and crosstalk from voltmeter readings.
"""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.arguments import Number
from talbot.base.files import check_folder, insert, marked, staged
from talbot.base.paths import results_of
from talbot.base.progress import Steps
from talbot.imaging.frame.command import NUMBERS, OF_SENSOR, add_frame_arguments, name_of, request_of, typed_of
from talbot.imaging.frame.reading import WHOLE
from talbot.imaging.frame.sensor import asked_sensor
from talbot.models.parameters import ParameterError

SCENE = "motorcycle"
SIDES = {"rows": "96", "cols": "96"}  # pixels without a sensor file: 16 x 24 of each type
STEPS = ("bench", "fit", "picture", "report")
BENCH_STEPS = ("read", "fit", "report")
HOLES = Number("holes", "positions of the hole along the pupil's diameter, or of a simulated stage", 5, 31, "13")
OF_BENCH = {"scene", "sensor", "bench"}  # options that a bench of the test chip has; the scene is its default
OF_SIMULATED = OF_BENCH | {"pixel", "lux", "noise", "seed", "holes", "document"}


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot calibrate`: texts, checked by `run`."""
    parser.add_argument("--scene", default=SCENE, help="of the picture that it is tried on")
    parser.add_argument("--depth", help="depth file for --scene (models/scene/README.md)")
    add_frame_arguments(parser, WHOLE | {"mode": "raw", "calibration": None})
    parser.add_argument("--out", help="folder for the results (default: build/calibrate)")
    HOLES.add(parser)
    parser.add_argument(
        "--bench",
        nargs="+",
        help="readings of the pixels' test chip, one or more CSV files (pixels/test_chip/bench.md), or simulated: "
        "writes sensor.toml and response.npz to build/calibrate/<name>, simulated also the readings",
    )
    parser.add_argument(
        "--document", type=Path, help="with --bench simulated: also put expected readings between marks of this file"
    )


def run(options: Namespace) -> int:
    """Calibrate, write calibration.json and its page, and print the figures."""
    from talbot.imaging.calibrate import page  # Matplotlib: not before it is needed
    from talbot.imaging.calibrate.measure import calibrate

    holes = HOLES.value(options)
    typed = typed_of(options, add_arguments, OF_SENSOR | SIDES)
    if options.bench:
        return _bench(options, typed, holes)
    if options.document:
        raise ParameterError(f"document = {str(options.document)!r}: must be left out without bench = simulated")
    standard = list(typed.items()) == [("scene", SCENE)]
    options.out = options.out or results_of("calibrate") / ("" if standard else name_of(typed))
    if not options.sensor:
        for name, side in SIDES.items():
            if getattr(options, name) is None:
                setattr(options, name, side)
    frame_request = request_of(options)
    check_folder("out", frame_request.folder, page.NAMES)
    with Steps(STEPS, lines=True) as progress:
        done = calibrate(frame_request, holes, progress.note)
        progress.note("report")
        with staged(frame_request.folder, page.NAMES) as part:
            page.write(part, done)
            summary = done.summary | {"arguments": typed}
            (part / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    _print(done.summary, frame_request.folder)
    return 0


def _bench(options: Namespace, typed: dict[str, Any], holes: int) -> int:
    """Calibrate from readings of the test chip, print the figures."""
    from talbot.imaging.bench import job

    simulated = options.bench == [job.SIMULATED]
    for name in sorted(typed.keys() - (OF_SIMULATED if simulated else OF_BENCH)):
        which = "simulated" if simulated else "a file"
        raise ParameterError(f"{name} = {typed[name]!r}: must be left out with bench = {which}")
    if options.scene != SCENE:
        raise ParameterError(f"scene = {options.scene!r}: must be left out with bench")
    sensor = asked_sensor(options)
    label = "-".join(Path(file).stem for file in options.bench)
    rest = {name: value for name, value in typed.items() if name not in ("bench", "document")}
    folder = Path(options.out or results_of("calibrate") / name_of(rest | {"scene": label}))
    mark = "expected readings"
    if options.document:
        marked(options.document, mark)
    numbers = {number.field: number.value(options) for number in NUMBERS if number.field in ("noise", "seed", "lux")}
    simulation = job.Simulation(holes, **numbers) if simulated else None
    files = () if simulated else options.bench
    typed = {name: str(value) if isinstance(value, Path) else value for name, value in typed.items()}
    with Steps(BENCH_STEPS, lines=True) as progress:
        summary = job.make(folder, sensor, files, simulation, progress.note, typed)
        if options.document:
            insert(options.document, mark, job.expected(sensor, numbers["lux"], holes))
    _print_bench(summary, folder)
    return 0


def _print_bench(s: dict[str, Any], folder: Path) -> None:
    from talbot.imaging.bench.page import PAGE, RESPONSE, SENSOR, rows, type_rows

    print(f"{s['readings']:,} readings, {s['angles']} angles, {s['wavelength_nm']:g} nm, {s['celsius']:.1f} degrees C")
    for name, beta, gamma, alpha, m, efficiency in ((r[0], *r[2:7]) for r in type_rows(s)):
        print(
            f"  type {name:<15} beta {beta:<14} gamma {gamma:<16} alpha {alpha:<16} m {m:<15} efficiency {efficiency}"
        )
    for name, value, *true in rows(s):
        print(f"  {name:<54}{value}" + (f"  true {true[0]}" if true and true[0] else ""))
    for note in s["notes"]:
        print(f"  check: {note}")
    print(f"  make sim SENSOR={folder / SENSOR} PIXEL={folder / RESPONSE}")
    print(f"  look at {folder / PAGE}")


def _print(s: dict[str, Any], folder: Path) -> None:
    from talbot.imaging.calibrate.page import lens_rows, picture_rows

    print(f"calibration of {s['rows']} x {s['cols']} pixels by {s['holes']} places of the hole, noise {s['noise']:g}")
    errors = {
        name: max(abs(kind[name] - kind[f"{name}_true"]) for kind in s["types"])
        for name in ("beta", "gamma_deg", "alpha", "m")
    }
    print("  largest errors: " + ", ".join(f"{name} {value:.4f}" for name, value in errors.items()))
    print(f"  difference over sum: {s['response_rms']:.4f} RMS (of none: {s['response_rms_constant']:.4f})")
    print(f"  trims' ratios: {s['gains_rms']:.4f} RMS")
    for name, measured, true in lens_rows(s):
        print(f"  {name:<42}{measured:>20}  true {true}")
    for name, calibrated, true in picture_rows(s):
        print(f"  {name:<42}{calibrated:>8} dB" + (f"  true optics {true} dB" if true else ""))
    print(f"  condition of the worst fit {s['condition']:.1f}; make sim CALIBRATION={folder / 'calibration.json'}")
    print(f"  look at {folder / 'calibrate.html'}")
