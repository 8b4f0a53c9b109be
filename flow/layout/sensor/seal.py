"""The seal ring at the edge of the die."""

from math import ceil, sqrt

from talbot.base.gds import db
from talbot.platforms.die import Ring, SealRing

CELL, CONTACT = "seal_ring", "seal_ring_contact"
GRID_UM = 0.005


def draw(layout: "db.Layout", width_um: float, height_um: float, seal: SealRing) -> "db.Cell":
    """Draw the ring of a die of this size into a cell, whose origin is the die's corner; returns the cell."""
    cell = layout.create_cell(CELL)
    for ring in seal.rings:
        outside = _outline(width_um, height_um, ring.inset_um, _corner(seal, ring))
        inner = ring.inset_um + ring.width_um
        inside = _outline(width_um, height_um, inner, _corner(seal, ring) + _diagonal(ring.width_um))
        polygon = db.DPolygon(outside)
        polygon.insert_hole(inside)
        cell.shapes(layout.layer(*ring.gds)).insert(polygon)
    for ring in seal.contacts:
        _squares(layout, cell, width_um, height_um, ring, _corner(seal, ring) + _diagonal(ring.width_um))
    return cell


def _squares(layout: "db.Layout", cell: "db.Cell", width: float, height: float, ring: Ring, corner: float) -> None:
    """Rows of squares on the four sides, from one chamfer to the next."""
    side = ring.width_um
    if (square := layout.cell(CONTACT)) is None:
        square = layout.create_cell(CONTACT)
        square.shapes(layout.layer(*ring.gds)).insert(db.DBox(0, 0, side, side))
    for along, across, turn in ((width, height, False), (height, width, True)):
        step, none = db.DVector(2 * side, 0), db.DVector(0, 1)
        count = int((along - 2 * corner) / (2 * side))
        for at in (ring.inset_um, across - ring.inset_um - side):
            way = db.DTrans(db.DTrans.M45 if turn else db.DTrans.R0, db.DVector(0, 0))
            place = way * db.DTrans(db.DVector(corner, at))
            cell.insert(db.DCellInstArray(square.cell_index(), place, way * step, none, count, 1))


def _corner(seal: SealRing, ring: Ring) -> float:
    """X + y of a ring's outer chamfer: all chamfers are as far apart as the sides."""
    apart = ring.inset_um - seal.inset_um
    return seal.corner_um + (_diagonal(apart) if apart > 0 else -_diagonal(-apart))


def _diagonal(um: float) -> float:
    """What a distance of ``um`` across a chamfer adds to x + y, on the grid and no less."""
    return ceil(round(um * sqrt(2) / GRID_UM, 6)) * GRID_UM


def _outline(width: float, height: float, inset: float, corner: float) -> "list[db.DPoint]":
    """The corners of a rectangle with chamfers, ``inset`` from the die's edge."""
    leg = corner - inset
    xs, ys = (inset, leg, width - leg, width - inset), (inset, leg, height - leg, height - inset)
    ways = (0, 1), (1, 0), (2, 0), (3, 1), (3, 2), (2, 3), (1, 3), (0, 2)
    return [db.DPoint(xs[i], ys[j]) for i, j in ways]
