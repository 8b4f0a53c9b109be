"""Recognition on what the sensor sends: accuracy next to joules, bytes, operations, and baselines."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.arguments import Number
from talbot.base.files import check_file, check_folder, insert, marked, staged
from talbot.base.jobs import worker_count
from talbot.base.paths import results_of
from talbot.base.sensor import HELP
from talbot.imaging.frame.arguments import named
from talbot.imaging.frame.command import typed_of
from talbot.imaging.frame.sensor import add_pixel, asked_sensor

DEFAULT_FRONTS, DEFAULT_CURVES = "asp,ternary,gradient", "threshold,bits,snr,blur,wake"
CURVES_HELP = "of threshold, bits, snr, blur, draws, wake, gestures, intensity, pose; none: FRONT alone"
SCALE = Number("scale", "sensor px along an edge of a picture px", 1, 32, "6")
BLUR = Number("blur", "blur of a point in picture px, positive behind the focal plane", -16, 16, "4", kind=float)
THRESHOLD = Number("threshold", "|code| below it is left out", 0, 127, "10")
NOISE = Number("noise", "times the physical noise", 0, 100, "1", kind=float)
SEED = Number("seed", "of splits and of every random draw", 0, 2**31, "1")
SEEDS = Number("seeds", "splits and draws, from the seed on", 1, 100, "3")
EPOCHS = Number("epochs", "of lenet and binary", 1, 1000, "20")
SHIFT = Number("shift", "px by which lenet's pictures are moved at random, in training", 0, 4, "0")
COUNT = Number("count", "pictures at most", 10, 10**7, word="all", note="all")
SOME = Number("some", "pictures of a curve's point, clips or heads, at most", 10, 10**7, "600")
DRAWS = Number("draws", "of six random pixel types, for the curve draws", 1, 1000, "100")
NUMBERS = (SCALE, BLUR, THRESHOLD, NOISE, SEED, SEEDS, EPOCHS, SHIFT, COUNT, SOME, DRAWS)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot recognize`: texts, checked by `run`."""
    add = parser.add_argument
    add("--data", default="digits", help="digits, an .npz, or a folder (imaging/recognize/README.md)")
    add("--front", default=DEFAULT_FRONTS, help="asp, ternary, gradient, image, with commas; the first leads")
    add(
        "--classifier",
        default="kernel",
        help="kernel, in closed form; lenet, trained by Adam; binary, its weights signs",
    )
    add("--curves", default=DEFAULT_CURVES, help=CURVES_HELP)
    for number in NUMBERS:
        number.add(parser)
    add("--sensor", type=Path, help=HELP)
    add_pixel(parser)
    add("--golden", action="store_true", help="by the golden chip alone, without its Verilog")
    add("--workers", type=worker_count, default=-1, help="processes, -1: all cores")
    add("--weights", type=Path, help="also write the lenet of the first front and seed as .npz, at most 100 kB")
    add("--document", type=Path, help="also put the tables between this file's marks: digits, digits_lenet, ...")
    add("--out", type=Path, help="folder for the results (default: build/recognize/<data>)")


def run(options: Namespace) -> int:
    """Measure, write page and summary.json, print the table; 1 where the Verilog and the golden chip differ."""
    from talbot.imaging.recognize import page  # Matplotlib: not before it is needed
    from talbot.imaging.recognize.data import load
    from talbot.imaging.recognize.job import STORE, Study, measure, write_weights
    from talbot.imaging.recognize.study import Setting

    numbers = {number.field: number.value(options) for number in NUMBERS}
    count, some, draws = (numbers.pop(name) for name in ("count", "some", "draws"))
    sensor = asked_sensor(options)
    data = load(options.data).part(count)
    base = Setting(sensor=sensor, classifier=options.classifier, **numbers)
    curves = () if options.curves == "none" else tuple(options.curves.split(","))
    fronts = tuple(options.front.split(","))
    study = Study(data, fronts, base, curves, some, draws, not options.golden, options.workers)
    folder = options.out or results_of("recognize") / named(options.data)
    check_folder("out", folder, page.NAMES)
    if options.weights:
        check_file("weights", options.weights)
    table = data.name if base.classifier == "kernel" else f"{data.name}_{base.classifier}"
    if options.document:
        marked(options.document, table)
    typed = {name: str(value) for name, value in typed_of(options, add_arguments).items()}
    result = measure(study, folder / STORE)
    summary = result.summary | {"arguments": typed}
    with staged(folder, page.NAMES) as part:
        page.write(part, result)
        (part / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if options.weights:
        write_weights(study, options.weights)
    if options.document:
        insert(options.document, table, page.lines(summary))
        text = options.document.read_text(encoding="utf-8")
        for name, tabled in page.TABLES_OF.items():
            if name in curves and f"<!-- {name} -->" in text:
                insert(options.document, name, tabled(summary))
    _print(summary, folder)
    return int(bool(summary["stream_mismatches"]))


def _print(s: dict[str, Any], folder: Path) -> None:
    from talbot.imaging.recognize.page import about, rows

    print(f"{s['data']}: {about(s)}")
    for name, accuracy, spread, size, energy, *_ in rows(s):
        print(f"  {name:<48}{accuracy:>9} +- {spread:<5}{size:>7} bytes {energy:>16} uJ")
    if s["verilog"]:
        v = s["verilog"]
        print(f"  {v['frames']} frames by the Verilog: {v['bytes']} bytes, {v['mismatches']} of them differ")
    print(f"  look at {folder / 'recognize.html'}")
