"""Area of the chip's blocks on the compact library and on sky130_fd_sc_hd.

The same Yosys script maps both, from Liberty files without delays: the mapper sees areas and logic depth alone.
"""

import json
import tempfile
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import TypedDict

from talbot.base import jobs, tools
from talbot.base.files import insert, marked
from talbot.base.liberty.read import areas
from talbot.models.parameters import ParameterError

BLOCKS = ("QuadDividerRadix2", "EdgeAdc", "AmpCtrl", "RunLength", "RegFile")
LIMIT = 1.6  # of the areas' ratio, ours by theirs
STORE = Path("build/cells/compact/area")


class Mapped(TypedDict):
    """A mapped module: its area, and the number of cells by type."""

    um2: float
    cells: dict[str, int]


def mapped(verilog: str, top: str, liberty: str) -> Mapped:
    """Map module ``top`` of the file ``verilog`` to the cells of ``liberty``. Raises ToolError."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        report = Path(folder) / "stat.json"
        path, cells_path = tools.plain(Path(verilog)), tools.plain(Path(liberty))
        script = (
            f"read_verilog -sv {path}; synth -flatten -top {top}; delete t:$scopeinfo; "
            f"dfflibmap -liberty {cells_path}; "
            f"abc -liberty {cells_path}; opt_clean -purge; tee -q -o {report} stat -json"
        )
        tools.run(["yosys", "-q", "-p", script])
        cells = json.loads(report.read_text(encoding="utf-8"))["design"]["num_cells_by_type"]
    area = areas(Path(liberty))
    if left := sorted(cells.keys() - area.keys()):
        raise tools.ToolError(f"yosys: {top}: cells {', '.join(left)} are missing in {liberty}")
    return {"um2": sum(area[cell] * number for cell, number in cells.items()), "cells": cells}


def compare(
    verilog: str | Path, blocks: Iterable[str], ours: Path, theirs: Path, store: Path = STORE
) -> dict[str, tuple[Mapped, Mapped]]:
    """Map every block to both libraries. verilog: folder of <block>.v. Raises ParameterError, ToolError."""
    files = {block: Path(verilog) / f"{block}.sv" for block in blocks}
    for block, file in files.items():
        if not file.exists():
            raise ParameterError(f"blocks = {block!r}: must be a file {file} (make verilog)")
    pairs = product(files.items(), (("ours", ours), ("theirs", theirs)))
    todo = [jobs.Job(f"{b}.{k}", mapped, (str(file), b, str(lib)), (file, lib)) for (b, file), (k, lib) in pairs]
    modules = jobs.run(todo, store, "blocks mapped")
    return dict(zip(files, zip(modules[::2], modules[1::2], strict=True), strict=True))


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cells-compact-area`."""
    add = parser.add_argument
    add("--verilog", type=Path, default=Path("build/verilog"), help="folder of the blocks' Verilog (make verilog)")
    add("--liberty", type=Path, default=Path("build/cells/compact/compact.lib"), help="of this library")
    add("--blocks", default=",".join(BLOCKS), help="names, with commas between them")
    add("--document", type=Path, help="also write the table of blocks between the marks 'area' of this Markdown file")


def run(options: Namespace) -> int:
    """Print the areas on both libraries; return 1 where the ratio is above LIMIT."""
    from talbot.platforms.sky130.functions import liberty

    if options.document:
        marked(options.document, "area")
    if not (ours := options.liberty).exists():
        raise ParameterError(f"liberty = {ours}: must be a file (talbot cells-compact)")
    STORE.mkdir(parents=True, exist_ok=True)
    theirs = STORE / "sky130_fd_sc_hd.lib"
    theirs.write_text(liberty(), encoding="utf-8")
    areas_of_blocks = compare(options.verilog, options.blocks.split(","), ours, theirs)
    total = [sum(pair[k]["um2"] for pair in areas_of_blocks.values()) for k in (0, 1)]
    table = _blocks(areas_of_blocks, total)
    print(f"{table}\n\n{_cells(areas_of_blocks, 0, ours)}\n\n{_cells(areas_of_blocks, 1, theirs)}")
    if options.document:
        insert(options.document, "area", table)
    print(f"\nratio {total[0] / total[1]:.2f}, limit {LIMIT}")
    return 0 if total[0] / total[1] <= LIMIT else 1


def _blocks(blocks: Mapping[str, tuple[Mapped, Mapped]], total: Sequence[float]) -> str:
    lines = ["| block | Compact um2 | sky130_fd_sc_hd um2 | ratio |", "|---|---:|---:|---:|"]
    rows = [(block, a["um2"], b["um2"]) for block, (a, b) in blocks.items()]
    for block, a, b in (*rows, ("all", total[0], total[1])):
        lines.append(f"| {block} | {a:,.0f} | {b:,.0f} | {a / b:.2f} |")
    return "\n".join(lines)


def _cells(blocks: Mapping[str, tuple[Mapped, Mapped]], k: int, liberty: Path, most: int = 10) -> str:
    """The table of the cells with the largest share of the area, in library ``k`` of 0 and 1."""
    area, count = areas(liberty), Counter()
    for pair in blocks.values():
        count.update(pair[k]["cells"])
    total = sum(count[cell] * area[cell] for cell in count)
    lines = [f"| {liberty.stem}: cell | number | um2 each | share of the area |", "|---|---:|---:|---:|"]
    for cell in sorted(count, key=lambda c: -count[c] * area[c])[:most]:
        name, share = cell.removeprefix("sky130_fd_sc_hd__"), count[cell] * area[cell] / total
        lines.append(f"| {name} | {count[cell]} | {area[cell]:.2f} | {share:.1%} |")
    return "\n".join(lines)
