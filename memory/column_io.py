"""Precharge and multiplexers of a column, on the cells' pitch, south of the array.

    y, um
      0.0   edge of the array
     -0.7   equalizer          p, between both bit lines
     -2.6   ================   pre_n: poly, and met1 above
     -2.9   precharge          p, from vdd to each bit line
     -5.1   read mux           p, from the bit lines to the group's s and sn
     -7.9   ================   read_n[0] .. read_n[7]
    -10.9   write mux          n, from the bit lines to the group's w and wn
    -14.7   ================   write[0] .. write[7]

Gates are upright; bit lines are on met2, all else across columns on met1.
"""

from collections.abc import Sequence
from dataclasses import replace

from talbot.base.gds import db
from talbot.memory.array import GROUP, GROUP_PITCH, array, column_x, draw_array
from talbot.memory.bitcell import BIT_WIDTH, BIT_X, PITCH, RAIL_X, STRAP
from talbot.memory.column import LENGTH, PRECHARGE, READ_MUX, WRITE_MUX
from talbot.pixels.circuits.netlist import Circuit, Instance, Transistor
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
EQUALIZER, BAR, CHARGER, READ, WRITE = -0.67, -2.625, -2.90, -5.06, -10.90  # upper edges, the bar's middle
SELECT = {"read_n": -7.95, "write": -14.80}  # middle of the first line of each
SELECT_PITCH, SELECT_WIDTH = 0.38, 0.23
SUPPLY = -4.50, -3.70  # vdd
LINE = 0.30  # width of s, sn, w, wn
STEP = 0.215  # from a gate to a contact
INNER, GATE, OUTER = 0.26, 0.475, 0.69  # from the middle: contact of the group's line, gate, contact of the bit line
WELL = READ - READ_MUX - 0.18, -0.485
BOTTOM = -17.70
SHARED = "s", "sn", "w", "wn"


def column_io() -> Circuit:
    """Return the circuit of one column."""

    def p(name: str, drain: str, gate: str, source: str, w: float) -> Transistor:
        return Transistor(name, drain, gate, source, "vdd", "p", w, LENGTH)

    lines = ("bl", "s", "w"), ("br", "sn", "wn")
    transistors = [p("equal", "bl", "pre_n", "br", PRECHARGE)]
    for k, (line, sense, write) in enumerate(lines):
        transistors.append(p(f"pre{k}", line, "pre_n", "vdd", PRECHARGE))
        transistors.append(p(f"read{k}", line, "read_n", sense, READ_MUX))
        transistors.append(Transistor(f"write{k}", line, "write", write, "vss", "n", WRITE_MUX, LENGTH))
    return Circuit("column_io", ("bl", "br", "pre_n", "read_n", "write", *SHARED, "vdd", "vss"), tuple(transistors))


def columns_io(groups: int) -> Circuit:
    """Return the circuit of all columns."""
    inner, instances = column_io(), list[Instance]()
    for k in range(GROUP * groups):
        shared = (f"{net}[{k // GROUP}]" for net in SHARED)
        nets = f"bl[{k}]", f"br[{k}]", "pre_n", f"read_n[{k % GROUP}]", f"write[{k % GROUP}]", *shared, "vdd", "vss"
        instances.append(Instance(f"{k}", inner, nets))
    ports = dict.fromkeys(net for instance in instances for net in instance.nodes)
    return Circuit("columns_io", tuple(ports), instances=tuple(instances))


def tile(rows: int, groups: int) -> Circuit:
    """Return the circuit of `draw_tile`'s cell."""
    cells, below = replace(array(rows, groups), name="cells"), columns_io(groups)
    ports = dict.fromkeys((*cells.ports, *below.ports))
    inside = Instance("cells", cells, cells.ports), Instance("columns", below, below.ports)
    return Circuit("array", tuple(ports), instances=inside)


def draw_tile(layout: "db.Layout", masks: AnalogMasks, rows: int, groups: int) -> Canvas:
    """Draw the cell ``array``, with the columns' precharge and multiplexers below it."""
    canvas = draw_array(layout, masks, rows, groups)
    draw_columns(canvas, masks, groups)
    return canvas


def draw_column(layout: "db.Layout", masks: AnalogMasks) -> Canvas:
    """Draw the cell ``column_io``, without the contacts to its select lines."""
    canvas, m, half = Canvas(layout, "column_io", masks.base), masks.base, PITCH / 2
    canvas.box(m.well, -half, WELL[0], half, WELL[1])
    canvas.box(m.pplus, -half, READ - READ_MUX - 0.125, half, EQUALIZER + 0.125)
    canvas.box(m.nplus, -half, WRITE - WRITE_MUX - 0.125, half, WRITE + 0.125)
    canvas.box(m.poly, -half, BAR - 0.075, half, BAR + 0.075)
    canvas.wire(1, -half, BAR - 0.14, half, BAR + 0.14)
    canvas.wire(1, -half, SUPPLY[0], half, SUPPLY[1])
    _row(canvas, masks, (-STEP, STEP), (0.0,), EQUALIZER, PRECHARGE, (BAR, EQUALIZER + 0.13))
    _row(canvas, masks, (-2 * STEP, 0.0, 2 * STEP), (-STEP, STEP), CHARGER, PRECHARGE, (-4.71, BAR))
    canvas.square(m.vias[0].gds, 0, sum(SUPPLY) / 2, 0.17)
    for side in (-1, 1):
        x = side * BIT_X
        canvas.wire(2, x - BIT_WIDTH / 2, WRITE - 0.46, x + BIT_WIDTH / 2, 0.16)
        for y, contact in ((EQUALIZER - 0.35, STEP), (CHARGER - 0.25, 2 * STEP)):
            ends = sorted((side * contact, x + side * 0.085))
            canvas.wire(0, ends[0], y - 0.085, ends[1], y + 0.085)
            _up(canvas, x, y)
        for top, width in ((READ, READ_MUX), (WRITE, WRITE_MUX)):
            contacts = tuple(sorted((side * INNER, side * OUTER)))
            _row(canvas, masks, contacts, (side * GATE,), top, width, (top - width - 0.29, top + 0.13))
            _up(canvas, side * OUTER, top - 0.30)
            reach = sorted((side * (BIT_X - BIT_WIDTH / 2), side * (OUTER + 0.14)))
            canvas.wire(2, reach[0], top - 0.46, reach[1], top - 0.14)
            y = top - 0.90 - (0.60 if side > 0 else 0.0)
            canvas.square(m.vias[0].gds, side * INNER, y, 0.17)
            canvas.wire(1, -half, y - LINE / 2, half, y + LINE / 2)
    for first, bottom in zip(SELECT.values(), (READ - READ_MUX, WRITE - WRITE_MUX), strict=True):
        bar, contact = bottom - 0.215, first + 0.50
        canvas.box(m.poly, -GATE - 0.075, bar - 0.075, GATE + 0.075, bar + 0.075)
        canvas.box(m.poly, -0.135, contact - 0.165, 0.135, bar)
        canvas.poly_contact(0, contact)
        last = first - SELECT_PITCH * (GROUP - 1)
        canvas.wire(0, -0.085, last - 0.085, 0.085, contact)
        for k in range(GROUP):
            y = first - SELECT_PITCH * k
            canvas.wire(1, -half, y - SELECT_WIDTH / 2, half, y + SELECT_WIDTH / 2)
    return canvas


def _row(
    canvas: Canvas,
    masks: AnalogMasks,
    contacts: Sequence[float],
    gates: Sequence[float],
    top: float,
    width: float,
    poly: tuple[float, float],
) -> None:
    """Draw diffusion of ``width`` below ``top``, upright gates between both ends of ``poly``, columns of contacts."""
    m, low = masks.base, top - width
    canvas.box(m.active, contacts[0] - 0.125, low, contacts[-1] + 0.125, top)
    for x in gates:
        canvas.box(m.poly, x - LENGTH / 2, min(poly), x + LENGTH / 2, max(poly))
    count = int((width - 0.24 - 0.17) / 0.34 + 1e-9) + 1
    first = (low + top) / 2 - (count - 1) * 0.17
    for x in contacts:
        for k in range(count):
            canvas.square(m.contact, x, first + 0.34 * k, 0.17)
        canvas.wire(0, x - 0.085, low, x + 0.085, top)


def _up(canvas: Canvas, x: float, y: float) -> None:
    """Join local interconnect and a bit line at a point."""
    canvas.square(canvas.process.vias[0].gds, x, y, 0.17)
    canvas.wire(1, x - 0.13, y - 0.16, x + 0.13, y + 0.16)
    canvas.square(canvas.process.vias[1].gds, x, y, 0.15)


def draw_strap(layout: "db.Layout", masks: AnalogMasks) -> Canvas:
    """Draw the cell ``strap_io``: taps, the contact of pre_n, rails on met2."""
    canvas, m, half = Canvas(layout, "strap_io", masks.base), masks.base, STRAP / 2
    canvas.box(m.well, -half, WELL[0], half, WELL[1])
    canvas.box(m.poly, -half, BAR - 0.075, half, BAR + 0.075)
    canvas.box(m.poly, -0.165, BAR - 0.135, 0.165, BAR + 0.135)
    canvas.poly_contact(0, BAR, upright=False)
    canvas.square(m.vias[0].gds, 0, BAR, 0.17)
    canvas.wire(1, -half, BAR - 0.14, half, BAR + 0.14)
    canvas.wire(1, -half, SUPPLY[0], half, SUPPLY[1])
    for y, implant, x in ((sum(SUPPLY) / 2, m.nplus, RAIL_X), (WRITE - 2.0, m.pplus, -RAIL_X)):
        canvas.square(m.tap, 0, y, 0.41)
        canvas.square(implant, 0, y, 0.66)
        canvas.contact(0, y)
        canvas.square(m.vias[0].gds, 0, y, 0.17)
        canvas.wire(1, min(x, 0) - 0.16, y - 0.16, max(x, 0) + 0.16, y + 0.16)
        canvas.square(m.vias[1].gds, x, y, 0.15)
        canvas.wire(2, x - 0.16, BOTTOM, x + 0.16, 0)
    for first in SELECT.values():
        for k in range(GROUP):
            y = first - SELECT_PITCH * k
            canvas.wire(1, -half, y - SELECT_WIDTH / 2, half, y + SELECT_WIDTH / 2)
    return canvas


def draw_columns(canvas: Canvas, masks: AnalogMasks, groups: int) -> None:
    """Draw the columns of ``groups`` below y = 0 of ``canvas``, with the names of their nets except bit lines."""
    layout = canvas.layout
    cell, strap = draw_column(layout, masks).cell, draw_strap(layout, masks).cell
    for group in range(groups + 1):
        canvas.cell.insert(db.DCellInstArray(strap.cell_index(), db.DTrans(group * GROUP_PITCH, 0.0)))
    for column in range(GROUP * groups):
        x = column_x(column)
        canvas.cell.insert(db.DCellInstArray(cell.cell_index(), db.DTrans(x, 0.0)))
        for name, first in SELECT.items():
            y = first - SELECT_PITCH * (column % GROUP)
            canvas.square(masks.base.vias[0].gds, x, y, 0.17)
            if column < GROUP:
                canvas.label(1, f"{name}[{column}]", x, y)
    for group in range(groups):
        for names, top in ((SHARED[:2], READ), (SHARED[2:], WRITE)):
            for k, name in enumerate(names):
                canvas.label(1, f"{name}[{group}]", column_x(GROUP * group), top - 0.90 - 0.60 * k)
    canvas.label(1, "pre_n", column_x(0), BAR)
    canvas.label(2, "vdd", RAIL_X, -1.0)
    canvas.label(2, "vss", -RAIL_X, -1.0)
