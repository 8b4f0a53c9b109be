"""Capacitors between the analog supplies where the die is free: east of the converters, below the column amplifiers.

Columns from south to north: a bottom plate on the ground, top plates above it whose metal is on the supply. Each column
crosses the converters' supply lines on the top metal, which it meets with vias.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from talbot.base.gds import db
from talbot.flow.layout.sensor import shapes
from talbot.flow.layout.sensor.plan import CIRCUITS, SUPPLIES, Block, Box, DieParameters, nm
from talbot.flow.layout.sensor.rules import RoutingRules
from talbot.flow.layout.sensor.shapes import Shape
from talbot.flow.layout.sensor.supplies import vias
from talbot.platforms.die import TopMetal
from talbot.platforms.pads import Capacitor

SUPPLY, GROUND = CIRCUITS
# um: side of a top plate, from one to the next in a column; of a column and from one to the next; less than 60 % of
# both metals, the process's limit
PLATE, STEP, COLUMN, PITCH = 30.0, 34.0, 38.0, 72.0
EDGE = 1.5  # of the bottom plate around the top plates
OVER = 0.5  # of a top plate around its metal
RETURN = 34.0, 37.0  # of a column: the ground's metal
VIA_PITCH = 3.0
FREE = 20.0  # from other blocks and bars
CELL = "decoupling"


class Field(NamedTuple):
    """Columns of capacitors: x of each, nm; bottom; number of top plates in a column."""

    columns: list[int]
    bottom: int
    plates: int

    @property
    def top(self) -> int:
        """Of all columns."""
        return self.bottom + self.plates * nm(STEP)


def field(blocks: Mapping[str, Block], taken: Sequence[int], die: DieParameters) -> Field:
    """The columns for which there is room. taken: x of the routes' branches."""
    lanes, above = blocks["adc_lanes"], blocks["column_amplifiers"]
    end = nm(die.width_um - die.ring_um - die.edge_um - len(SUPPLIES) * (die.bar_um + die.gap_um) - FREE)
    bottom, top = lanes.y + nm(FREE), above.y - nm(FREE)
    xs = range(lanes.box[2] + nm(FREE), end - nm(COLUMN), nm(PITCH))
    free = [x for x in xs if not any(x - nm(FREE) < other < x + nm(COLUMN + FREE) for other in taken)]
    return Field(free, bottom, max(0, (top - bottom) // nm(STEP)))


def picofarad(found: Field, capacitor: Capacitor) -> float:
    """Capacitance of all of them, typical."""
    one = capacitor.area_ff_um2 * PLATE**2 + capacitor.edge_ff_um * 4 * PLATE
    return len(found.columns) * found.plates * one / 1000


def metal(found: Field, lines: Sequence[tuple[str, Box]], rules: RoutingRules, top: TopMetal) -> Iterator[Shape]:
    """Plates and metal of the columns but for the top plates and their vias, and vias to ``lines``, (net, box).

    A supply without a line across the columns leaves them out: nothing would connect them.
    """
    if not found.plates or {net for net, _ in lines} < {SUPPLY, GROUND}:
        return
    for x in found.columns:
        yield shapes.drawn(rules.layers[-2], GROUND, (x, found.bottom, x + nm(COLUMN), found.top))
        for net, (left, right) in ((SUPPLY, (EDGE + OVER, EDGE + PLATE - OVER)), (GROUND, RETURN)):
            strip = x + nm(left), found.bottom, x + nm(right), found.top
            yield shapes.drawn(rules.layers[-1], net, strip)
            for of, box in lines:
                if of == net:
                    yield from vias(net, (strip[0], box[1], strip[2], box[3]), top)


def draw(layout: "db.Layout", plan: Mapping[str, Any], rules: RoutingRules, capacitor: Capacitor) -> None:
    """Put the top plates and the vias of the plan's columns into the top cell."""
    own = plan["decoupling"]
    if not own["columns"]:
        return
    top, cell = layout.top_cell(), layout.create_cell(CELL)
    via = rules.vias[-1]
    cut = layout.layer(via.layer, via.datatype)
    low, high = nm(EDGE), nm(EDGE + PLATE)
    cell.shapes(layout.layer(*capacitor.plate)).insert(db.Box(low, low, high, high))
    half, inset = via.size // 2, nm(OVER + 1)
    inside = range(low + inset, high - inset + 1, nm(VIA_PITCH))
    beside = nm(sum(RETURN) / 2)
    at = [(x, y) for x in inside for y in inside] + [(beside, y) for y in range(nm(1), nm(STEP), nm(VIA_PITCH))]
    for x, y in at:
        cell.shapes(cut).insert(db.Box(x - half, y - half, x + half, y + half))
    for x in own["columns"]:
        vector, step = db.Trans(x, own["bottom"]), db.Vector(0, nm(STEP))
        top.insert(db.CellInstArray(cell.cell_index(), vector, db.Vector(1, 0), step, 1, own["plates"]))
