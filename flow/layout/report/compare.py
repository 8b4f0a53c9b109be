"""`python -m flow.layout.report.compare DESIGN DESIGN`: finished layouts side by side, in build/layout/hierarchy/."""

import argparse
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from base.files import staged
from base.page import render
from base.paths import ROOT
from flow.layout.design import DESIGNS, design, macro_designs
from models.parameters import ParameterError

from .metrics import broken
from .text import as_text

PAIR = "asp_chip", "asp_chip_macros"  # of the thesis (B.3.2): flat, and around its two macros
ROWS = (
    ("area_um2", "area, um2"),
    ("cells", "cells, clock buffers included"),
    ("flip_flops", "flip-flops"),
    ("utilization", "utilization beside macros"),
    ("wire_um", "wire length, um"),
    ("wire_pf", "wire capacitance, pF"),
    ("f_max_mhz", "highest clock, MHz"),
    ("wns_ns", "setup slack, ns"),
    ("whs_ns", "hold slack, ns"),
    ("blocks_wns_ns", "setup slack by the macros' Liberty, ns"),
    ("blocks_whs_ns", "hold slack by the macros' Liberty, ns"),
    ("power_uw", "power, uW"),
    ("ir_drop_percent", "IR drop, %"),
    ("open_nets", "open nets"),
    ("rerouted_nets", "open nets rerouted"),
    ("antenna_jumpers", "nets with antenna jumpers"),
    ("drc_violations", "DRC violations"),
    ("antenna_violations", "antennas"),
    ("lvs_match", "LVS match"),
    ("equivalence", "equivalence"),
    ("gate_tests", "netlist tests passed, failed"),
)


def arguments() -> argparse.ArgumentParser:
    """The command line's parser."""
    parser = argparse.ArgumentParser(prog="python -m flow.layout.report.compare", description=__doc__)
    parser.add_argument("designs", nargs="*", default=PAIR, metavar="DESIGN", help=f"default: {' '.join(PAIR)}")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "layout", help="folder of layouts (%(default)s)")
    return parser


def read(folder: Path, name: str) -> dict[str, Any]:
    """Read the summary of a finished layout. Raises ParameterError."""
    path = folder / design(name).name / "summary.json"
    if not path.is_file():
        raise ParameterError(f"design = {name}: must have been laid out: no {path}; make layout DESIGN={name}")
    found = json.loads(path.read_text())
    if not found.get("macros"):  # of a design with macros, the cells include theirs and all clock buffers
        found["cells"] += found.get("clock_buffers") or 0
    return found


class Column(NamedTuple):
    """A layout in the table. blocks: names of the macros in it."""

    name: str
    summary: dict[str, Any]
    blocks: list[str]


def columns(names: Sequence[str], summaries: dict[str, dict[str, Any]]) -> list[Column]:
    """A column of each design, then of each macro in them that is not among ``names``."""
    found = [Column(name, summaries[name], [block.name for block in macro_designs(DESIGNS[name])]) for name in names]
    blocks = dict.fromkeys(block for column in found for block in column.blocks)
    return found + [Column(f"{name}, a block", summaries[name], []) for name in blocks if name not in names]


def seconds(column: Column, summaries: dict[str, dict[str, Any]]) -> float:
    """Run time of all steps of a design and of its macros, the cells' characterization (once for all) left out."""
    made = column.summary, *(summaries[block] for block in column.blocks)
    return round(sum(s for summary in made for step, s in summary["wall_s"].items() if step != "timing"), 1)


def table(made: Sequence[Column], summaries: dict[str, dict[str, Any]]) -> list[tuple[str, list[str]]]:
    """Rows (label, value a column)."""
    rows = [(words, [_text(name, column.summary.get(name)) for column in made]) for name, words in ROWS]
    rows.append(("limits broken", ["; ".join(broken(column.summary)) or "none" for column in made]))
    rows.append(("run time, s", [f"{seconds(column, summaries):,}" for column in made]))
    rows.append(("memory, MiB", [f"{max(column.summary['peak_mib'].values()):,}" for column in made]))
    return rows


def _text(name: str, value: Any) -> str:
    if name == "gate_tests" and value:
        return f"{value['passed']}, {value['failed']}"
    if isinstance(value, dict):
        return ", ".join(f"{one:g} ({corner.partition('_')[0]})" for corner, one in value.items())
    return as_text(value)


def main(argv: Sequence[str] | None = None) -> int:
    """Write table.json and report.html, print the table; 1 where a limit is broken, 2 on bad input."""
    options = arguments().parse_args(argv)
    try:
        names = list(options.designs)
        wanted = dict.fromkeys([*names, *(block.name for name in names for block in macro_designs(design(name)))])
        summaries = {name: read(options.out, name) for name in wanted}
        made = columns(names, summaries)
        rows, folder = table(made, summaries), options.out / "hierarchy"
        pictures = [
            (name, os.path.relpath(path, folder))
            for name in names
            for path in (options.out / name / f"{name}.blocks.png", options.out / name / f"{name}.png")
            if path.is_file()
        ]
        with staged(folder, ["table.json", "report.html"]) as part:
            (part / "table.json").write_text(
                json.dumps(
                    {words: dict(zip((name for name, _, _ in made), values, strict=True)) for words, values in rows},
                    indent=1,
                )
                + "\n"
            )
            (part / "report.html").write_text(
                render(
                    Path(__file__).with_name("compare.html"),
                    names=[name for name, _, _ in made],
                    rows=rows,
                    pictures=pictures,
                )
            )
    except (ParameterError, OSError) as error:
        print(f"flow.layout.report.compare: {error}", file=sys.stderr)
        return 2
    width = max(len(words) for words, _ in rows)
    for words, values in [("", [name for name, _, _ in made]), *rows]:
        print(f"{words:{width}}  " + "  ".join(f"{value:>28.28}" for value in values))
    print(folder / "report.html")
    return 1 if any(broken(summaries[name]) for name in names) else 0


if __name__ == "__main__":
    sys.exit(main())
