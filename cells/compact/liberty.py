"""A Liberty file of areas and functions: enough for synthesis by area, until the characterizer has run."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from base.liberty import functional
from base.liberty.write import text
from cells.compact.canvas import Canvas

if TYPE_CHECKING:
    from cells.compact.pdk import DrawnCell


def liberty(cells: "Iterable[DrawnCell]", canvas: Canvas) -> str:
    """Text for ``cells``. No delays: pins have directions, functions and areas only."""
    made = functional.library("compact", **functional.UNITS)
    for cell in cells:
        s, ff, more = cell.schematic, None, {}
        functions = {pin: s.functions.get(pin, "") for pin in s.outputs}
        if s.storage == "ff":
            ff = {name: s.functions[name] for name in ("next_state", "clear") if name in s.functions}
            ff, functions = {"clocked_on": "clk", **ff}, {"q": "IQ"}
        if s.storage == "gate":
            functions, more = {"q": ""}, {"clock_gating_integrated_cell": "latch_posedge"}
        if s.outputs:
            area = cell.drawing["width"] * canvas.height
            functional.add_cell(made, s.name, area, (*s.inputs, *s.outputs), functions, ff, "clk", **more)
    return text(made)
