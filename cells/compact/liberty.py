"""A Liberty file of areas and functions: enough for synthesis by area, until the characterizer has run."""

from collections.abc import Iterable, Mapping

from talbot.base.liberty import functional
from talbot.base.liberty.write import text
from talbot.cells.compact.transistors import Schematic


def liberty(cells: Iterable[Schematic], areas: Mapping[str, float]) -> str:
    """Text for ``cells`` of ``areas`` (um2). No delays: pins have directions, functions and areas only."""
    library = functional.library("compact", **functional.UNITS)
    for s in cells:
        ff = None
        functions = {pin: s.functions.get(pin, "") for pin in s.outputs}
        if s.storage == "ff":
            ff = {name: s.functions[name] for name in ("next_state", "clear") if name in s.functions}
            ff, functions = {"clocked_on": "clk", **ff}, {"q": "IQ"}
        if s.storage == "gate":
            functions = {"q": ""}
        if s.outputs:
            cell = functional.add_cell(library, s.name, areas[s.name], (*s.inputs, *s.outputs), functions, ff, "clk")
            if s.storage == "gate":
                cell.attributes["clock_gating_integrated_cell"] = "latch_posedge"
    return text(library)
