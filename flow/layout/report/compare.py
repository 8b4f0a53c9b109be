"""`python -m flow.layout.report.compare DESIGN DESIGN`: finished layouts beside one another, in build/layout/hierarchy/."""

import argparse
import json
import os
import sys
from pathlib import Path

from jinja2 import Environment, FileSystemLoader

from base.files import staged
from base.paths import ROOT
from flow.layout.design import DESIGNS, design, macro_designs
from models.parameters import ParameterError

from .metrics import broken

PAIR = "asp_chip", "asp_chip_macros"  # of the thesis (B.3.2): flat, and around its two blocks
ROWS = (
    ("area_um2", "area, um2"),
    ("cells", "cells, clock's buffers too"),
    ("flip_flops", "flip-flops"),
    ("utilization", "utilization beside blocks"),
    ("wire_um", "wire, um"),
    ("wire_pf", "wire, pF"),
    ("f_max_mhz", "MHz at most"),
    ("wns_ns", "setup slack, ns"),
    ("whs_ns", "hold slack, ns"),
    ("blocks_wns_ns", "setup slack by the blocks' Liberty, ns"),
    ("blocks_whs_ns", "hold slack by the blocks' Liberty, ns"),
    ("power_uw", "power, uW"),
    ("ir_drop_percent", "voltage drop, %"),
    ("open_nets", "open nets"),
    ("rerouted_nets", "open nets rerouted"),
    ("antenna_jumpers", "nets with antenna jumpers"),
    ("drc_violations", "rules broken"),
    ("antenna_violations", "antennas"),
    ("lvs_match", "layout = netlist"),
    ("equivalence", "netlist = Verilog"),
    ("gate_tests", "tests of the netlist passed, failed"),
)


def arguments():
    parser = argparse.ArgumentParser(prog="python -m flow.layout.report.compare", description=__doc__.splitlines()[0])
    parser.add_argument("designs", nargs="*", default=PAIR, metavar="DESIGN", help=f"default: {' '.join(PAIR)}")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "layout", help="folder of layouts (%(default)s)")
    return parser


def read(folder, name):
    """The summary of a finished layout. Raises ParameterError."""
    path = folder / design(name).name / "summary.json"
    if not path.is_file():
        raise ParameterError(f"design = {name}: must have been laid out: no {path}; make layout DESIGN={name}")
    found = json.loads(path.read_text())
    if not found.get("macros"):  # where there are blocks, their and all clocks' buffers are among the cells
        found["cells"] += found.get("clock_buffers") or 0
    return found


def columns(names, summaries):
    """(name, summary, the blocks in it) of each, blocks behind the designs around them."""
    found = [(name, summaries[name], [block.name for block in macro_designs(DESIGNS[name])]) for name in names]
    blocks = dict.fromkeys(block for _, _, own in found for block in own)
    return found + [(f"{name}, a block", summaries[name], []) for name in blocks if name not in names]


def seconds(summary, blocks, summaries):
    """Of all steps of a design, its blocks' too (the cells' timing, measured once for all, left out)."""
    return round(
        sum(
            sum(s for step, s in made["wall_s"].items() if step != "timing")
            for made in (summary, *(summaries[block] for block in blocks))
        ),
        1,
    )


def table(made, summaries):
    """Rows (words, value a column) as text."""
    rows = [(words, [_text(name, summary.get(name)) for _, summary, _ in made]) for name, words in ROWS]
    rows.append(("limits broken", ["; ".join(broken(summary)) or "none" for _, summary, _ in made]))
    rows.append(("run time, s", [f"{seconds(summary, blocks, summaries):,}" for _, summary, blocks in made]))
    rows.append(("memory, MiB", [f"{max(summary['peak_mib'].values()):,}" for _, summary, _ in made]))
    return rows


def _text(name, value):
    if value is None:
        return "-"
    if name == "gate_tests":
        return f"{value['passed']}, {value['failed']}"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, dict):
        return ", ".join(f"{one:g} ({corner.partition('_')[0]})" for corner, one in value.items())
    return f"{value:,}" if isinstance(value, (int, float)) else str(value)


def main(argv=None):
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
        environment = Environment(loader=FileSystemLoader(Path(__file__).parent), autoescape=True)
        with staged(folder, ["table.json", "report.html"]) as part:
            (part / "table.json").write_text(
                json.dumps(
                    {words: dict(zip((name for name, *_ in made), values, strict=True)) for words, values in rows},
                    indent=1,
                )
                + "\n"
            )
            (part / "report.html").write_text(
                environment.get_template("compare.html").render(
                    names=[name for name, *_ in made], rows=rows, pictures=pictures
                )
            )
    except (ParameterError, OSError) as error:
        print(f"flow.layout.report.compare: {error}", file=sys.stderr)
        return 2
    width = max(len(words) for words, _ in rows)
    for words, values in [("", [name for name, *_ in made]), *rows]:
        print(f"{words:{width}}  " + "  ".join(f"{value:>28.28}" for value in values))
    print(folder / "report.html")
    return 1 if any(broken(summaries[name]) for name in names) else 0


if __name__ == "__main__":
    sys.exit(main())
