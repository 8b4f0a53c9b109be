"""Other cameras on the same scenes, pixels, lens, light and noise: views, disparity, SNR, bytes and energy."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.arguments import Number, real
from talbot.base.files import check_folder, insert, marked, staged
from talbot.base.jobs import worker_count
from talbot.base.paths import results_of
from talbot.base.sensor import add_sensor, sensor_asked, standard_alone
from talbot.base.table import markdown_table
from talbot.imaging.frame.command import typed_of
from talbot.models.parameters import ParameterError

STEP = 60  # px: whole lenslets of 5 x 5 views, and whole tiles
SIZE = Number("size", f"pixels of each side, a multiple of {STEP}", STEP, 360, "120")
SEEDS = Number("seeds", "fixed patterns and noises, from seed 1 on", 1, 100, "3")
LUX_ENDS = 1e-3, 1e6
VARIED = standard_alone("cameras are compared with the standard sensor")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cameras`: texts, checked by `run`."""
    add = parser.add_argument
    add("--scenes", default="tilted,leaves:7,coins,motorcycle,room", help="names or files, with commas")
    add("--lux", default="500,100,20", help="illuminance of white, with commas; the brightest sets the exposure of all")
    for number in (SIZE, SEEDS):
        number.add(parser)
    add("--measurements", action="store_true", help="also the views over the number of measurements a pixel")
    add_sensor(parser)
    add("--workers", type=worker_count, default=1, help="processes, -1: all cores")
    add("--document", type=Path, help="also put the tables between the marks of this file")
    add("--out", type=Path, help="folder for the results (default: build/cameras)")


def run(options: Namespace) -> int:
    """Measure every camera, write page and summary.json, and print the table."""
    from talbot.imaging.cameras import page  # Matplotlib: not before it is needed
    from talbot.imaging.cameras.job import STORE, Comparison, compare

    sensor_asked(options, VARIED)
    size, seeds = SIZE.value(options), SEEDS.value(options)
    if size % STEP:
        raise ParameterError(f"size = {size}: must be a multiple of {STEP}")
    lux = tuple(sorted({real("lux", word, *LUX_ENDS) for word in options.lux.split(",")}, reverse=True))
    scenes = tuple(dict.fromkeys(options.scenes.split(",")))
    task = Comparison(scenes, size, lux, seeds, options.measurements, options.workers)
    folder = options.out or results_of("cameras")
    check_folder("out", folder, page.NAMES)
    if options.document:
        for name in page.tables(options.measurements):
            marked(options.document, name)
    typed = {name: str(value) for name, value in typed_of(options, add_arguments).items()}
    summary = compare(task, folder / STORE) | {"arguments": typed}
    with staged(folder, page.NAMES) as part:
        page.write(part, summary)
        (part / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if options.document:
        for name, table in page.tables(options.measurements).items():
            head, rows = table(summary)
            insert(options.document, name, markdown_table(head, rows, 1))
    _print(summary, folder)
    return 0


def _print(s: dict[str, Any], folder: Path) -> None:
    from talbot.imaging.cameras.page import line, overview

    print(line(s))
    head, rows = overview(s)
    widths = [max(len(cell) for cell in column) for column in zip(head, *rows, strict=True)]
    for row in (head, *rows):
        print("  " + "  ".join(cell.rjust(w) if i else cell.ljust(w) for i, (cell, w) in enumerate(zip(row, widths))))
    print(f"  look at {folder / 'cameras.html'}")
