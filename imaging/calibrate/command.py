"""A calibration on the bench: pixel types, trims, chief ray and optical centre from noisy frames of the chip."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.arguments import Number
from talbot.base.files import check_folder, staged
from talbot.base.paths import results_of
from talbot.base.progress import Steps
from talbot.imaging.frame.command import OF_SENSOR, add_frame_arguments, name_of, request_of, typed_of
from talbot.imaging.frame.reading import WHOLE

SCENE = "motorcycle"
SIDES = {"rows": "96", "cols": "96"}  # pixels without a sensor file: 16 x 24 of each type
STEPS = ("bench", "fit", "picture", "report")
HOLES = Number("holes", "positions of the hole along the pupil's diameter", 5, 31, "13")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot calibrate`: texts, checked by `run`."""
    parser.add_argument("--scene", default=SCENE, help="of the picture that it is tried on")
    parser.add_argument("--depth", help="depth file for --scene (models/scene/README.md)")
    add_frame_arguments(parser, WHOLE | {"mode": "raw", "calibration": None})
    parser.add_argument("--out", help="folder for the results (default: build/calibrate)")
    HOLES.add(parser)


def run(options: Namespace) -> int:
    """Calibrate, write calibration.json and its page, and print the figures."""
    from talbot.imaging.calibrate import page  # Matplotlib: not before it is needed
    from talbot.imaging.calibrate.measure import calibrate

    holes = HOLES.value(options)
    typed = typed_of(options, add_arguments, OF_SENSOR | SIDES)
    standard = list(typed.items()) == [("scene", SCENE)]
    options.out = options.out or results_of("calibrate") / ("" if standard else name_of(typed))
    if not options.sensor:
        for name, side in SIDES.items():
            setattr(options, name, getattr(options, name) or side)
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
