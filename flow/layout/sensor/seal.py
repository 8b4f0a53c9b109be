"""The seal ring at the edge of the die."""

from math import ceil, sqrt

from talbot.base.gds import db
from talbot.platforms.die import Ring, SealRing

CELL, CONTACT = "seal_ring", "seal_ring_contact"


def draw(layout: "db.Layout", width_um: float, height_um: float, seal: SealRing, grid_um: float) -> "db.Cell":
    """Draw the ring of a die of this size into a cell, whose origin is the die's corner; returns the cell."""
    cell = layout.create_cell(CELL)
    for ring in seal.rings:
        outer, inner = _corners(seal, ring, grid_um)
        outside = _outline(width_um, height_um, ring.inset_um, outer)
        inside = _outline(width_um, height_um, ring.inset_um + ring.width_um, inner)
        polygon = db.DPolygon(outside)
        polygon.insert_hole(inside)
        cell.shapes(layout.layer(*ring.gds)).insert(polygon)
    for ring in seal.contacts:
        _squares(layout, cell, width_um, height_um, ring, _corners(seal, ring, grid_um)[1])
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


def _corners(seal: SealRing, ring: Ring, grid_um: float) -> tuple[float, float]:
    """X + y of a ring's outer and inner chamfer: all chamfers are as far apart as the sides."""

    def diagonal(um: float) -> float:
        """What a distance of ``um`` across a chamfer adds to x + y, on the grid and no less."""
        return ceil(round(um * sqrt(2) / grid_um, 6)) * grid_um

    apart = ring.inset_um - seal.inset_um
    outer = seal.corner_um + (diagonal(apart) if apart > 0 else -diagonal(-apart))
    return outer, outer + diagonal(ring.width_um)


def _outline(width: float, height: float, inset: float, corner: float) -> "list[db.DPoint]":
    """The corners of a rectangle with chamfers, ``inset`` from the die's edge."""
    leg = corner - inset
    xs, ys = (inset, leg, width - leg, width - inset), (inset, leg, height - leg, height - inset)
    ways = (0, 1), (1, 0), (2, 0), (3, 1), (3, 2), (2, 3), (1, 3), (0, 2)
    return [db.DPoint(xs[i], ys[j]) for i, j in ways]
