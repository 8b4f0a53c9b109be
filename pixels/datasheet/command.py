"""The analog circuits in ngspice: corners, mismatch, noise, linearity, and their datasheet."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.jobs import worker_count
from talbot.base.progress import Steps
from talbot.base.sensor import Varied, add_sensor, labelled, sensor_asked
from talbot.models.parameters import check_int
from talbot.pixels.drawn import PIXEL_PITCH, PIXEL_STEP

VARIED = Varied(
    used=(
        "array.rows",
        "array.cols",
        "array.pitch",
        "chip.lanes",
        "chip.f_clk",
        "electrical.full_well",
        "electrical.swing",
        "electrical.difference_gain",
    ),
    limits=PIXEL_PITCH,
    steps=PIXEL_STEP,
)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot analog`."""
    add = parser.add_argument
    add_sensor(parser)
    add("--pdk", default="sky130", help="process: sky130")
    add("--corners", default="quick", help="all (21), quick (3), typical, or names like ss_n40C_1v62,ff_125C_1v98")
    add("--draws", default="200", help="comparators of the Monte Carlo run, 20..100000")
    add("--table", type=Path, help="also write what `make sim AFE=circuit` takes: models/parameters/circuit.json")
    add(
        "--gm-id",
        type=Path,
        help="write the tables that sizes come from, and nothing else: talbot/platforms/sky130/gm_id.json",
    )
    add("--workers", type=worker_count, default=-1, help="processes; -1: all cores")
    add("--out", type=Path, help="folder of the datasheet (default: build/analog/<pdk>)")


def run(options: Namespace) -> int:
    """Measure, write the datasheet and print it; 1 where a characteristic is outside its limits (`Row.verdict`)."""
    from talbot.base.paths import RESULTS
    from talbot.pixels.datasheet.job import STEPS, corners_of, make

    sensor = sensor_asked(options, VARIED)
    if options.gm_id:
        return _tables(options.pdk, options.gm_id)
    corners = corners_of(options.corners)
    draws = int(options.draws) if options.draws.isdecimal() else options.draws
    check_int("draws", draws, 20, 100_000)
    out = options.out or RESULTS / "analog" / labelled(options.pdk, options)
    with Steps(STEPS, lines=True) as steps:
        summary = make(options.pdk, corners, int(draws), out, options.table, options.workers, steps.note, sensor)
    _print(summary, out)
    return 1 if summary["failed"] else 0


def _tables(pdk: str, file: Path) -> int:
    """Measure transistors and write their tables."""
    from talbot.base.files import check_file, write
    from talbot.pixels.datasheet.deck import process_of
    from talbot.pixels.datasheet.tables import tables, text

    check_file("gm-id", file)
    write(file, text(tables(process_of(pdk))))
    print(f"look at {file}")
    return 0


def _print(s: dict[str, Any], folder: Path) -> None:
    from talbot.pixels.datasheet.datasheet import shown

    print(f"{s['pdk']}: {len(s['corners'])} corners, {s['draws']} draws, {s['transients']} transients")
    for row in s["rows"]:
        values = " ".join("     -" if row[k] is None else f"{shown(row[k]):>6}" for k in ("low", "typical", "high"))
        bound = "" if row["most"] is None else f"<= {row['most']:.3g}"
        bound += "" if row["least"] is None else f">= {row['least']:.3g}"
        name = f"{row['circuit']}: {row['name']}"
        print(f"  {name:40} {values} {row['unit']:6} {bound:10} {row['verdict']:5} {row['worst']}")
    for row in (row for row in s["rows"] if row["verdict"] == "open"):
        needed = f"; about {row['draws_needed']} would, if the RMS stayed" if row["draws_needed"] else ""
        print(
            f"  {row['circuit']}: {row['name']}: {row['draws']} draws bound it to {row['low']:.3g}..{row['high']:.3g} "
            f"{row['unit']}, which has the limit of {row['most']:.3g} inside{needed}"
        )
    print(f"  {s['retried']} transients with a retry; {s['wall_s']:.0f} s; look at {folder / 'datasheet.html'}")
