"""Rows of a small array with the analog circuits in the loop: the chip's Verilog and ngspice in lock-step."""

import json
import sys
from argparse import ArgumentParser, Namespace
from dataclasses import replace
from pathlib import Path
from typing import Any

from talbot.base.arguments import Number
from talbot.base.progress import Steps
from talbot.base.sensor import Varied, add_sensor, labelled, sensor_asked
from talbot.models.parameters import ParameterError, SensorParameters, check_choice
from talbot.pixels.drawn import DRAWN_LINES

AMPLIFIERS = "all", "lanes", "none"

COLS, LANES = (6, 48), (1, 2, 4)
FILE = "or of a sensor file with as few"
CUT = {
    "cols": Number("cols", "columns of the array", *COLS, note=f"12, {FILE}"),
    "lanes": Number("lanes", "converters, 1, 2 or 4", min(LANES), max(LANES), note=f"2, {FILE}"),
}
MODELLED = "the circuit's row and the curves of its model are those of the standard sensor"
VARIED = Varied(
    used=("tile", "array.cols", "chip.lanes", "chip.divider", "chip.n_frac", "chip.cordic_iterations"),
    fixed=DRAWN_LINES
    | dict.fromkeys(
        ("array.rows", "chip.f_clk", *(f"electrical.{name}" for name in ("full_well", "swing", "difference_gain"))),
        MODELLED,
    ),
)
TYPES = Number("types", "pixel types of the row that are read, at most 2 in time of flight", 1, 6, "6")
RELTOL = Number("reltol", "ngspice's relative tolerance", 1e-8, 0.1, "1e-4", kind=float)
SHARED = (
    Number("threshold", "of edge mode", 0, 127, "10"),
    Number("seed", "of the pixels' values", 0, 2**32 - 1, "1"),
    Number("t_int", "cycles of integration; 20000 are 2 ms", 1, 65535, "20000"),
)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cosim`: texts, checked by `run`."""
    add = parser.add_argument
    add("--modes", help="modes whose row is read (default: edge,image,raw,tof; raw with all amplifiers alone)")
    add_sensor(parser)
    for number in (TYPES, RELTOL, *CUT.values(), *SHARED):
        number.add(parser)
    add("--method", default="trap", help="ngspice's integration, trap or gear")
    add(
        "--amplifiers",
        default="all",
        help="that are transistors: all, of the columns and lanes; lanes (in edge mode); none",
    )
    add("--extracted", action="store_true", help="each row again, with the drawn circuits and their parasitics")
    add("--faults", action="store_true", help="faults planted in the circuit, and what the codes say of each, too")
    add("--out", type=Path, help="folder for the results (default: build/cosim)")


def run(options: Namespace) -> int:
    """Read the rows, write the page and print the figures; 1 where a code is beyond its limit, a fault not found."""
    from talbot.base.files import check_folder, staged
    from talbot.base.paths import RESULTS
    from talbot.verif.cosim import page, planted
    from talbot.verif.cosim.accuracy import Accuracy
    from talbot.verif.cosim.job import STEPS, model_alone, rows, summary
    from talbot.verif.cosim.row import MODES, RowRequest

    sensor = sensor_asked(options, VARIED)
    if options.sensor and options.faults:
        raise ParameterError(f"sensor = {str(options.sensor)!r}: must be left out with faults")
    check_choice("amplifiers", options.amplifiers, AMPLIFIERS)
    columns = options.amplifiers == "all"
    modes = options.modes.split(",") if options.modes else [mode for mode in MODES if columns or mode != "raw"]
    if not set(modes) <= set(MODES):
        raise ParameterError(f"modes = {options.modes!r}: must be some of {','.join(MODES)}")
    types, accuracy = (
        min(TYPES.value(options), sensor.tile.cols),
        Accuracy(reltol=RELTOL.value(options), method=options.method),
    )
    shared: dict[str, Any] = {number.field: number.value(options) for number in SHARED}
    shared |= _cut(options, sensor) | {"accuracy": accuracy, "sensor": sensor}
    asked = [
        RowRequest(
            mode=mode,
            types=min(types, 2) if mode == "tof" else types,
            amplifier=columns or (mode == "edge" and options.amplifiers == "lanes"),
            columns=columns,
            **shared,
        )
        for mode in modes
    ]
    asked += [replace(one, extracted=True) for one in asked if options.extracted]
    out = options.out or RESULTS / labelled("cosim", options)
    check_folder("out", out, page.names(MODES))
    with Steps(STEPS, lines=True) as steps:
        done = rows(asked, steps.note)
        found: dict[str, Any] = {"rows": [summary(row) for row in done], "model": model_alone(asked[0])}
        steps.note("faults")
        found["faults"] = planted.faults(steps.note) if options.faults else []
        steps.note("report")
        with staged(out, page.names(MODES)) as part:
            page.write(part, done, found)
            (part / "summary.json").write_text(json.dumps(found, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    _print(found, out)
    missed = [line for line in found["faults"] if line["planted"] != line["name"]]
    return int(bool(missed) or any(row["beyond"] for row in found["rows"]))


def _cut(options: Namespace, sensor: SensorParameters) -> dict[str, int]:
    """Columns and converters of the row: of the options, else of a sensor file where it has as few."""
    cols, lanes = (number.value(options) for number in CUT.values())
    array, chip = sensor.array.cols, sensor.chip.lanes
    found = {
        "cols": cols or (array if options.sensor and COLS[0] <= array <= COLS[1] else 12),
        "lanes": lanes or (chip if options.sensor and chip in LANES else 2),
    }
    if options.sensor and found != {"cols": array, "lanes": chip}:
        print(f"talbot: {found['cols']} of {array} columns are read, by {found['lanes']} lanes", file=sys.stderr)
    return found


def _print(s: dict[str, Any], folder: Path) -> None:
    for row in s["rows"]:
        print(
            f"{row['name']}: {row['differing']} of {row['samples']} codes differ, by "
            f"{row['largest_difference_lsb']} LSB at most, {row['beyond']} beyond half an LSB and the noise; "
            f"{row['largest_error_at_lane_lsb']:.3f} LSB off at the lane at most, "
            f"its level {row['largest_error_of_level_lsb']:.3f}; "
            f"{row['differing_decisions']} of {row['decisions']} decisions; "
            f"slowest {1e9 * row['slowest_decision_s']:.2f} ns; {row['circuit_cycles']} cycles of "
            f"{row['transistors']} transistors in {row['seconds']:.1f} s, {row['processor_seconds']:.1f} of a processor"
        )
    for line in s["faults"]:
        print(f"  planted: {line['planted']}; found: {line['name']} (codes {line['error']} LSB from it in all)")
    print(f"  real-number front end: {s['model']['cycles_per_s']:,.0f} cycles a second")
    print(f"  look at {folder / 'cosim.html'}")
