"""Fill of the die outside of blocks, pads and capacitors: squares of no net on every metal."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from talbot.base.gds import db
from talbot.flow.layout.sensor.decoupling import COLUMN, Field
from talbot.flow.layout.sensor.plan import nm
from talbot.platforms.layers import Layer

SIDE_UM, STEP_UM = 10.0, 14.0  # of the squares: a share of 51 %
CLEARANCE_UM = 3.0  # from wires, about twice the least space of the top metal: their capacitance to fill is left out
APART_UM = 20.0  # from blocks and pads: light reaches the pixels at the array's edge as inside


def fill(layout: "db.Layout", top: "db.Cell", plan: Mapping[str, Any], metals: Sequence[Layer]) -> dict[str, float]:
    """Draw the squares; of every metal the share of the free area that wires and squares cover."""
    free = _free(plan)
    shares = {}
    for metal in metals:
        boxes = [box for _, layer, datatype, *box in plan["shapes"] if (layer, datatype) == metal.gds]
        wires = _region(db.Box(*box) for box in boxes).merged()
        squares = _grid(free.bbox()).inside(free - wires.sized(nm(CLEARANCE_UM)))
        top.shapes(layout.layer(*metal.gds)).insert(squares)
        covered = squares.area() + (wires & free).area()
        shares[metal.lef] = round(covered / max(1, free.area()), 4)
    return shares


def _free(plan: Mapping[str, Any]) -> "db.Region":
    """Inside of the pads, away from blocks and capacitors."""
    frame, width, height = plan["frame"], *plan["die"]
    inner = frame["seal"] + frame["depth"]
    taken = _region(db.Box(*block["box"]) for block in plan["blocks"].values())
    field = Field(**plan["decoupling"])
    for x in field.columns:
        taken.insert(db.Box(x, field.bottom, x + nm(COLUMN), field.top))
    inside = db.Region(db.Box(inner, inner, width - inner, height - inner))
    return inside.sized(-nm(APART_UM)) - taken.sized(nm(APART_UM))


def _grid(box: "db.Box") -> "db.Region":
    """All squares in ``box``."""
    side, step = nm(SIDE_UM), nm(STEP_UM)
    xs, ys = range(box.left, box.right - side, step), range(box.bottom, box.top - side, step)
    return _region(db.Box(x, y, x + side, y + side) for x in xs for y in ys)


def _region(boxes: "Iterable[db.Box]") -> "db.Region":
    region = db.Region()
    for box in boxes:
        region.insert(box)
    return region
