"""`python -m cells`: a cell library characterized at one corner, to build/cells/<library>/."""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from base.tools import ToolError
from cells import sources
from cells.characterize.conditions import Conditions
from cells.corner import Corner
from cells.library import characterize_library
from cells.spice.engine import SimulationError
from models.parameters import ParameterError

ROOT = Path(__file__).resolve().parent.parent


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m cells", description="Characterize a cell library at one corner, to build/cells/<library>/."
    )
    parser.add_argument("--lib", default="sky130_hd", help=f"{', '.join(sources.LIBRARIES)}, or a SPICE file of cells")
    parser.add_argument("--corner", default="tt_025C_1v80", help="process, temperature, supply: ff_n40C_1v95")
    parser.add_argument("--cells", help="names with commas between (inv_1,nand2_1); default: all for synthesis")
    parser.add_argument(
        "--models", default="fitted", choices=sources.process("sky130_hd").SETS, help="set of device models"
    )
    parser.add_argument(
        "--netlist",
        default="extracted",
        choices=sources.NETLISTS,
        help="what is simulated: with parasitics, with capacitances, transistors as laid out, or the schematic",
    )
    parser.add_argument("--reference", type=Path, help="folder of <cell>.lib.json to compare with")
    parser.add_argument("--workers", type=int, default=-1, help="processes; -1: all cores")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "cells", help="folder of the libraries")
    options = parser.parse_args(argv)
    try:
        summary = characterize_library(
            options.lib,
            Conditions(Corner.parse(options.corner), options.models),
            options.cells and options.cells.split(","),
            options.netlist,
            options.out,
            options.reference,
            options.workers,
        )
    except (ParameterError, ToolError, SimulationError, OSError) as error:
        print(f"cells: {error}", file=sys.stderr)
        return 2
    long = ("cell_s", "cell_cpu_s", "names", "left_out")
    print(json.dumps({k: v for k, v in summary.items() if k not in long}, indent=1))
    return 1 if summary["failed"] or summary["problems"] else 0


if __name__ == "__main__":
    sys.exit(main())
