"""A cell library characterized at one corner or several, to build/cells/<library>/."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.jobs import worker_count
from talbot.base.paths import RESULTS
from talbot.cells import sources
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.corner import Corner
from talbot.cells.library import characterize_library


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cells`."""
    add = parser.add_argument
    add("--lib", default="sky130_hd", help=f"{', '.join(sources.LIBRARIES)}, or a SPICE file of cells")
    corners = "process, temperature, supply, with commas between: tt_025C_1v80,ff_n40C_1v95"
    add("--corners", default="tt_025C_1v80", help=corners)
    add("--cells", help="names with commas between, inv_1,nand2_1 (default: all for synthesis)")
    add("--models", default="fitted", choices=sources.process("sky130_hd").SETS, help="set of device models")
    netlists = "what is simulated: with parasitics, with capacitances, transistors as laid out, or the schematic"
    add("--netlist", default="extracted", choices=sources.NETLISTS, help=netlists)
    add("--reference", type=Path, help="folder of <cell>.lib.json to compare with")
    add("--workers", type=worker_count, default=-1, help="processes; -1: all cores")
    add("--out", type=Path, default=RESULTS / "cells", help="folder of the libraries")


def run(options: Namespace) -> int:
    """Characterize the library and print a summary of each corner; 1 where a cell fails or has problems."""
    o, wrong = options, False
    names, long = o.cells and o.cells.split(","), ("cell_s", "cell_cpu_s", "names", "left_out")
    for conditions in [Conditions(Corner.parse(name), o.models) for name in o.corners.split(",")]:
        summary = characterize_library(o.lib, conditions, names, o.netlist, o.out, o.reference, o.workers)
        print(json.dumps({name: value for name, value in summary.items() if name not in long}, indent=1))
        wrong |= bool(summary["failed"] or summary["problems"])
    folder = o.out / sources.title(o.lib)
    every = sorted(path.name for path in folder.glob("*.*") if path.suffix in (".lib", ".lef", ".v", ".json"))
    print(f"{folder}: {', '.join(every)}")
    return int(wrong)
