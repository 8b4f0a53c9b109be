"""Finished layouts side by side, in build/layout/hierarchy/."""

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from talbot.base.files import staged
from talbot.base.page import TABLES, Section, render
from talbot.base.paths import RESULTS
from talbot.flow.layout.design import DESIGNS, design, macro_designs
from talbot.models.parameters import ParameterError

from .metrics import broken
from .page import picture
from .text import NOT_RUN, as_text

PAIR = "asp_chip", "asp_chip_macros"  # of the thesis (B.3.2): flat, and around its two macros
ABOUT = (
    "by corner: tt, ss, ff as they were run; cells, wire length and run time of a design with macros include those of "
    "its macros"
)
ROWS = (
    ("area_um2", "area, um2"),
    ("cells", "cells, clock buffers included"),
    ("flip_flops", "flip-flops"),
    ("clock_gates", "clock gates"),
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
    ("evictions", "nets evicted for others"),
    ("diodes", "diodes against antennas"),
    ("drc_violations", "DRC violations"),
    ("antenna_violations", "antennas"),
    ("lvs_match", "LVS match"),
    ("equivalence", "equivalence"),
    ("gate_tests", "netlist tests passed, failed"),
)


def add_arguments(parser: ArgumentParser) -> None:
    """Arguments of `talbot layout-compare`."""
    parser.add_argument("designs", nargs="*", default=PAIR, metavar="DESIGN", help="designs that are laid out")
    parser.add_argument("--out", type=Path, default=RESULTS / "layout", help="folder of the layouts")


def read(folder: Path, name: str) -> dict[str, Any]:
    """Read the summary of a finished layout. Raises ParameterError."""
    path = folder / design(name).name / "summary.json"
    if not path.is_file():
        raise ParameterError(f"design = {name}: must have been laid out: no {path}; make layout DESIGN={name}")
    found = json.loads(path.read_text(encoding="utf-8"))
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


def _cells(row: tuple[str, list[str]]) -> list[str | None]:
    return [row[0], *(None if value == NOT_RUN else value for value in row[1])]


def run(options: Namespace) -> int:
    """Write table.json and report.html, print the table; 1 where a limit is broken."""
    macros = [block.name for name in options.designs for block in macro_designs(design(name))]
    summaries = {name: read(options.out, name) for name in (*options.designs, *macros)}
    made = columns(options.designs, summaries)
    names, rows, folder = [column.name for column in made], table(made, summaries), options.out / "hierarchy"
    pictures = [
        picture(path, name)
        for name in options.designs
        for path in (options.out / name / f"{name}.blocks.png", options.out / name / f"{name}.png")
        if path.is_file()
    ]
    found = {label: dict(zip(names, values, strict=True)) for label, values in rows}
    with staged(folder, ["table.json", "report.html"]) as part:
        (part / "table.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        sections = [Section(head=["", *names], rows=list(map(_cells, rows)), kind="pinned")]
        sections += [Section("Pictures", pictures=pictures)] * bool(pictures)
        page = render(TABLES, "Layouts side by side", about=ABOUT, sections=sections)
        (part / "report.html").write_text(page, encoding="utf-8")
    width = max(len(label) for label in found)
    for label, values in [("", names), *rows]:
        print(f"{label:{width}}  " + "  ".join(f"{value:>28.28}" for value in values))
    print(folder / "report.html")
    return 1 if any(broken(summaries[name]) for name in options.designs) else 0
