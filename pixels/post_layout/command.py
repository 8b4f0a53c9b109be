"""The analog circuits in a process's masks: checked, extracted, measured again, compared with their schematics."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.jobs import worker_count
from talbot.base.progress import Steps
from talbot.base.sensor import add_sensor, labelled, sensor_asked
from talbot.pixels.drawn import DRAWN_BLOCKS

VARIED = DRAWN_BLOCKS
SHOWN = 10  # differences of a cell


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot analog-layout`."""
    add = parser.add_argument
    add_sensor(parser)
    add("--pdk", default="sky130", help="process: sky130")
    add("--corners", default="typical", help="as of talbot analog: all (21), quick (3), typical, or names")
    add("--table", type=Path, help="also write the curves as drawn: models/parameters/circuit_drawn.json")
    add("--workers", type=worker_count, default=-1, help="processes; -1: all cores")
    add("--out", type=Path, help="folder for the results (default: build/analog-layout/<pdk>)")


def run(options: Namespace) -> int:
    """Draw, check, measure, write the page and print the figures; 1 where a check fails."""
    from talbot.base.paths import RESULTS
    from talbot.pixels.datasheet.job import corners_of

    sensor = sensor_asked(options, VARIED)
    from talbot.pixels.post_layout.job import STEPS, make

    out = options.out or RESULTS / "analog-layout" / labelled(options.pdk, options)
    with Steps(STEPS, lines=True) as steps:
        summary = make(
            options.pdk, corners_of(options.corners), out, options.table, options.workers, steps.note, sensor
        )
    _print(summary, out)
    return 0 if summary["passed"] else 1


def _print(s: dict[str, Any], folder: Path) -> None:
    for name, cell in s["cells"].items():
        rules = sum(cell["drc"].values())
        print(
            f"  {name:12} {cell['width_um']:g} x {cell['height_um']:g} um, {cell['transistors']} transistors, "
            f"{rules} violations, LVS {'matches' if cell['lvs_match'] else 'DIFFERS'}"
        )
        for difference in cell["lvs_differs"][:SHOWN]:
            print(f"    {difference}")
    print(f"  {'':46} {'schematic':>9} {'layout':>9} {'limit':>9}")
    for row in s["rows"]:
        least = row["most"] if row["least"] is None else row["least"]
        limit = "" if least is None else f"{least:9.3g} {'pass' if row['passes'] else 'FAIL'}"
        print(
            f"  {row['name']:38} {row['unit']:7} {row['schematic']:9.3g} {row['layout']:9.3g} {limit} {row['corner']}"
        )
    print(f"  {s['wall_s']:.0f} s; look at {folder / 'analog_layout.html'}")
