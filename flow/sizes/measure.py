"""Cells of a Verilog file, by synthesis with Yosys and the abstract library cells/gates.lib."""

import json
import re
import tempfile
from collections import Counter
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from talbot.base.paths import PACKAGE
from talbot.base.tools import ToolError, finish, located, plain

LIBRARY = PACKAGE / "cells" / "gates.lib"
TIES = "hilomap -hicell TIE1 Y -locell TIE0 Y -singleton"
MAP = f"dfflibmap -liberty {{library}}; abc -liberty {{library}}; {TIES}; opt_clean -purge"
FLIP_FLOP = "DFF"
YOSYS_MISSING = "yosys: not found; make setup installs it (the Python package pyosys)"


@dataclass(frozen=True)
class Size:
    """Size of a top, with everything below it.

    cells: all standard cells. flip_flops: those that hold state. gates: NAND2 equivalents, all together.
    flip_flop_gates: those of the flip-flops. by_type: cells of each type.
    """

    top: str
    cells: int
    flip_flops: int
    gates: float
    flip_flop_gates: float
    by_type: dict[str, int]


@cache
def areas() -> dict[str, float]:
    """Area of every cell of the library in NAND2 equivalents by name."""
    pairs = re.findall(r"cell \((\w+)\)\s*{\s*area : ([\d.]+);", LIBRARY.read_text(encoding="utf-8"))
    return {name: float(area) for name, area in pairs}


def yosys_installed() -> bool:
    """Return whether Yosys is installed."""
    return located("yosys") is not None


def synthesize(path: Path, top: str) -> Counter[str]:
    """Cells of each type of module ``top`` in the Verilog file ``path``, flattened. Raises ToolError."""
    if not yosys_installed():
        raise ToolError(YOSYS_MISSING)
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        report = Path(folder) / "stat.json"
        script = (
            f"read_verilog -sv {plain(path)}; synth -flatten -top {top}; delete t:$scopeinfo; "
            f"{MAP.format(library=plain(LIBRARY))}; "
            f"tee -q -o {report} stat -json"
        )
        result = finish(["yosys", "-q", "-p", script])
        if result.returncode:
            tail = "\n".join((result.stdout + result.stderr).strip().splitlines()[-5:])
            raise ToolError(f"yosys refused {path}:\n{tail}")
        return Counter(json.loads(report.read_text(encoding="utf-8"))["design"]["num_cells_by_type"])


def measure(path: Path, top: str) -> Size:
    """Size of module ``top`` in the Verilog file ``path``. Raises ToolError."""
    counts = synthesize(path, top)
    unknown = sorted(set(counts) - set(areas()))
    if unknown:
        raise ToolError(f"{top}: cells that {LIBRARY.name} does not have: {', '.join(unknown)}")
    gates = sum(areas()[cell] * number for cell, number in counts.items())
    flip_flops = counts[FLIP_FLOP]
    by_type = dict(sorted(counts.items()))
    return Size(top, sum(counts.values()), flip_flops, gates, areas()[FLIP_FLOP] * flip_flops, by_type)
