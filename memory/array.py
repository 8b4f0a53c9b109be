"""Rows and columns of cells in groups, with a strap on each side of a group."""

from collections.abc import Iterator, Sequence

from talbot.base.gds import db
from talbot.memory import bitcell
from talbot.memory.bitcell import HEIGHT, PITCH, STRAP
from talbot.pixels.analog_layout import flat
from talbot.pixels.circuits.netlist import Circuit, Instance
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks
from talbot.platforms.layers import GdsLayer

GROUP = 8  # columns between two straps: a tap within 15 um of every diffusion (lu.2, lu.3)
GROUP_PITCH = GROUP * PITCH + STRAP


def column_x(column: int) -> float:
    """X of a column's middle, um; the first strap's middle is at 0."""
    return column // GROUP * GROUP_PITCH + STRAP / 2 + (column % GROUP + 0.5) * PITCH


def row_turn(row: int, x: float) -> "db.DTrans":
    """Place of a cell of ``row`` whose middle is at ``x``: odd rows are mirror images."""
    odd = row % 2
    return db.DTrans(db.DTrans.M0 if odd else db.DTrans.R0, x, (row + odd) * HEIGHT)


def draw_array(layout: "db.Layout", masks: AnalogMasks, rows: int, groups: int) -> Canvas:
    """Draw the cell ``array``; nets are named bl[k], br[k], wl[k], vdd and vss."""
    canvas = Canvas(layout, "array", masks.base)
    cell, strap = bitcell.draw_cell(layout, masks).cell, bitcell.draw_strap(layout, masks).cell
    for row in range(rows):
        for group in range(groups + 1):
            canvas.cell.insert(db.DCellInstArray(strap.cell_index(), row_turn(row, group * GROUP_PITCH)))
        for column in range(GROUP * groups):
            canvas.cell.insert(db.DCellInstArray(cell.cell_index(), row_turn(row, column_x(column))))
        word, odd = sum(bitcell.WORD_METAL) / 2, row % 2
        canvas.label(1, f"wl[{row}]", column_x(0), (row + odd) * HEIGHT + (-word if odd else word))
    for column in range(GROUP * groups):
        for side, net in ((-1, "bl"), (1, "br")):
            canvas.label(2, f"{net}[{column}]", column_x(column) + side * bitcell.BIT_X, HEIGHT / 2)
    for side, net in ((-1, "vss"), (1, "vdd")):
        canvas.label(2, net, side * bitcell.RAIL_X, HEIGHT / 2)
    ends = -STRAP / 2, groups * GROUP_PITCH + STRAP / 2
    canvas.box(masks.base.outline, ends[0], 0, ends[1], rows * HEIGHT)
    return canvas


def array(rows: int, groups: int) -> Circuit:
    """Return the circuit of `draw_array`'s cell."""
    cell, columns = bitcell.bit_cell(), GROUP * groups
    lines = [f"{net}[{column}]" for column in range(columns) for net in ("bl", "br")]
    cells = [
        Instance(f"{row}_{k}", cell, (f"bl[{k}]", f"br[{k}]", f"wl[{row}]", "vdd", "vss"))
        for row in range(rows)
        for k in range(columns)
    ]
    ports = (*lines, *(f"wl[{row}]" for row in range(rows)), "vdd", "vss")
    return Circuit("array", ports, instances=tuple(cells))


def lvs_text(circuit: Circuit, masks: AnalogMasks) -> str:
    """Return the netlist of a circuit without hierarchy, for LVS."""
    return flat.spice(circuit.name, circuit.ports, flat.transistors(circuit), masks)


def labelled(layout: "db.Layout", masks: AnalogMasks, wells: Sequence[GdsLayer]) -> Canvas:
    """Draw ``bit``: a cell with the names of its nets, for extraction. wells: layers of names of n well, substrate."""
    canvas = Canvas(layout, "bit", masks.base)
    inner = layout.cell("bit_cell") or bitcell.draw_cell(layout, masks).cell
    canvas.cell.insert(db.DCellInstArray(inner.cell_index(), db.DTrans()))
    for level, net, x, y in _names():
        canvas.label(level, net, x, y)
    poly = masks.base.poly[0], wells[0][1]  # the word line's poly and met1 meet in a strap
    named = (wells[0], "vdd", sum(bitcell.P) / 2), (wells[1], "vss", 0.4), (poly, "wl", sum(bitcell.WORD) / 2)
    for layer, net, y in named:
        canvas.cell.shapes(layout.layer(*layer)).insert(db.DText(net, db.DTrans(0.0, y)))
    return canvas


def _names() -> Iterator[tuple[int, str, float, float]]:
    """Metal, net, x and y of the names of a cell's nets."""
    middle = (bitcell.LOW + bitcell.HIGH) / 2
    for side, line, node in ((-1, "bl", "q"), (1, "br", "qn")):
        yield 2, line, side * bitcell.BIT_X, middle
        yield 0, node, side * bitcell.BIT_X, middle
    for net, (low, high) in (("wl", bitcell.WORD_METAL), ("vss", bitcell.GROUND), ("vdd", bitcell.SUPPLY)):
        yield 1, net, 0.0, (low + high) / 2
