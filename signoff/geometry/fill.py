"""Fill: shapes of no net where a layer has room, so that every layer is polished alike."""

from collections.abc import Iterable

import numpy as np

from talbot.base.gds import db
from talbot.platforms.layers import GdsLayer, Layer
from talbot.platforms.layout import Dummies, Fill


def fill(layout: "db.Layout", top: "db.Cell", metal: Layer, rules: Fill) -> int:
    """Draw the fill of one layer into the cell ``top``, that with the largest clearance first; how many shapes."""
    layer, die = layout.layer(*metal.gds), top.bbox()
    width, side = (round(value / layout.dbu) for value in (rules.width_um, rules.side_um))
    drawn, filled = db.Region(top.begin_shapes_rec(layer)).merged(), db.Region()
    for clearance in (round(value / layout.dbu) for value in rules.clearances_um[metal.name]):
        missing = rules.density * die.area() - drawn.area() - filled.area()
        if missing <= 0:
            break
        room = db.Region(die).sized(-clearance) - drawn.sized(clearance) - filled.sized(clearance)
        shapes = _shapes(room, width, side, clearance)
        filled += _evenly(shapes.with_area(round(rules.area_um2 / layout.dbu**2), None, False), missing)
    top.shapes(layer).insert(filled)
    return filled.count()


def _shapes(room: "db.Region", width: int, side: int, space: int) -> "db.Region":
    """``room`` where it is at least ``width`` wide, cut into squares of ``side``, ``space`` apart."""
    box, pitch = room.bbox(), side + space
    counts = [-(-length // pitch) for length in (box.width(), box.height())]
    scratch = db.Layout()
    grid, square = scratch.create_cell("grid"), scratch.create_cell("square")
    square.shapes(scratch.layer(1, 0)).insert(db.Box(0, 0, side, side))
    steps = db.Vector(pitch, 0), db.Vector(0, pitch)
    grid.insert(db.CellInstArray(square.cell_index(), db.Trans(box.p1 - db.Point()), *steps, *counts))
    wide = (room & db.Region(grid.begin_shapes_rec(scratch.layer(1, 0)))).sized(-width // 2).sized(width // 2)
    checks = wide.width_check(width), wide.space_check(space), wide.notch_check(space)
    faults = sum((check.polygons(1) for check in checks), db.Region())  # 1: those of corners that touch have no area
    return wide.not_interacting(faults)


def _evenly(shapes: "db.Region", area: float) -> "db.Region":
    """Those of ``shapes`` that cover ``area``, spread over all of them."""
    polygons = sorted(shapes.each(), key=lambda polygon: (polygon.bbox().bottom, polygon.bbox().left))
    steps = np.floor(np.arange(len(polygons) + 1) * min(1.0, area / max(1, shapes.area())))
    return db.Region([polygons[k] for k in np.flatnonzero(np.diff(steps))])


def fill_cells(layout: "db.Layout", names: Iterable[str], dummies: Dummies) -> None:
    """Draw ``dummies`` into the cells ``names``, those of no function, along each implant that holds no tap."""
    for cell in (layout.cell(name) for name in names if layout.has_cell(name)):
        taps = db.Region(cell.shapes(layout.layer(*dummies.taps)))
        drawn = [db.Region(cell.shapes(layout.layer(*implant))).merged() for implant in dummies.implants]
        for layer, inset in dummies.insets_um.items():
            x, y = (round(side / layout.dbu) for side in inset)
            for implant in drawn:
                cell.shapes(layout.layer(*layer)).insert(implant.not_interacting(taps).sized(-x, -y, 2))


def densities(layout: "db.Layout", top: "db.Cell", masks: Iterable[GdsLayer], window_um: float) -> tuple[float, float]:
    """Covered share of ``masks`` together in the emptiest and in the densest window; windows overlap by half."""
    box, size = top.bbox(), round(window_um / layout.dbu)
    shapes = [db.Region(top.begin_shapes_rec(layout.layer(*mask))) for mask in masks]
    drawn, shares = sum(shapes, db.Region()).merged(), []
    for left in range(box.left, max(box.left + 1, box.right - size // 2), size // 2):
        for bottom in range(box.bottom, max(box.bottom + 1, box.top - size // 2), size // 2):
            window = db.Box(left, bottom, left + size, bottom + size) & box
            shares.append((drawn & db.Region(window)).area() / window.area())
    return round(min(shares), 4), round(max(shares), 4)
