"""Cells without routes: taps that fill a row, and the diode against antenna charge."""

from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.draw import CUT, WIRE, Drawn, Pen, frame
from talbot.cells.compact.transistors import Schematic

WIDTHS = (1, 2, 4, 8)  # sites


def ties(canvas: Canvas) -> dict[str, tuple[Schematic, Drawn]]:
    """Draw cells of rails, well and taps alone: tie, tie_w2, ..."""
    names = {"tie" if sites == 1 else f"tie_w{sites}": sites for sites in WIDTHS}
    return {name: (Schematic(name, (), ()), _entry(Pen(canvas, sites))) for name, sites in names.items()}


def diode(canvas: Canvas) -> dict[str, tuple[Schematic, Drawn]]:
    """Draw diode_w1: an n diffusion in the substrate, on the pin i."""
    pen, x = Pen(canvas, 1), canvas.site / 2
    low, high = canvas.n
    pen.at("difftap", "i", x, (low + high) / 2, 0.25, high - low)
    pen.at("areaid_diode", "", x, (low + high) / 2, 0.26, high - low + 0.01)
    pen.at("licon", "i", x, canvas.rows[0], CUT, CUT)
    for layer in ("li", "li.pin"):
        pen.box(layer, "i", x - WIRE / 2, canvas.rows[0] - 0.165, x + WIRE / 2, canvas.rows[canvas.high] + WIRE / 2)
    drawn: Drawn = {**_entry(pen), "diode": (0.25, round(high - low, 3))}
    return {"diode_w1": (Schematic("diode_w1", ("i",), ()), drawn)}


def _entry(pen: Pen) -> Drawn:
    frame(pen)
    return {"width": pen.width, "shapes": [*pen.shapes]}
