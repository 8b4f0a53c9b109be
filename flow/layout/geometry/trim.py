"""Ends of segments that are too near to those of other segments are trimmed.

The router's gauge sets pads side by side a few nm nearer than the process allows (0.11 to 0.13 um where 0.14 um is
required, a handful in a million um of wire length). A pad encloses its via by more than it must, so that half the lack
is taken from either side; DRC and LVS check the result.
"""

from collections.abc import Iterable, Mapping

from talbot.base.gds import db
from talbot.platforms.layers import Layer

GRID_NM = 5
MOST_NM = 25  # that an end may lose: what pads have over the least enclosure of a via
END_NM = 500  # a longer edge is a side, which stays as it is


def trim(layout: "db.Layout", top: "db.Cell", metals: Iterable[Layer], spaces: Mapping[str, float]) -> int:
    """Trim in the top cell ``top``; spaces: least, by layer (um). Returns how many ends."""
    trimmed = 0
    for metal in metals:
        layer = layout.layer(*metal.gds)
        space = round(spaces[metal.name] / layout.dbu)
        boxes = []
        for pair in db.Region(top.begin_shapes_rec(layer)).space_check(space, True, db.Region.Projection).each():
            edges = (pair.first, pair.second), (pair.second, pair.first)
            ends = [(edge, other) for edge, other in edges if edge.length() <= END_NM]
            lack = space - pair.distance()
            depth = -(-lack // (len(ends) * GRID_NM)) * GRID_NM if ends else 0
            if 0 < depth <= MOST_NM:
                boxes += [_strip(edge, other, depth) for edge, other in ends]
        _subtract(top.shapes(layer), boxes)
        trimmed += len(boxes)
    return trimmed


def _strip(edge: "db.Edge", other: "db.Edge", depth: int) -> "db.Box":
    """The box ``depth`` deep inside ``edge``, away from ``other``."""
    a, b = edge.bbox(), other.bbox()
    if edge.p1.x == edge.p2.x:
        left = a.left < b.left
        return db.Box(a.left - depth if left else a.left, a.bottom, a.left if left else a.left + depth, a.top)
    below = a.bottom < b.bottom
    return db.Box(a.left, a.bottom - depth if below else a.bottom, a.right, a.bottom if below else a.bottom + depth)


def _subtract(shapes: "db.Shapes", boxes: "Iterable[db.Box]") -> None:
    """Take ``boxes`` out of ``shapes`` where they meet."""
    for box in boxes:
        touched = [shape for shape in shapes.each_overlapping(box) if not shape.is_text()]
        left = db.Region()
        for shape in touched:
            left += db.Region(shape.polygon)
        for shape in touched:
            shapes.erase(shape)
        shapes.insert(left.merged() - db.Region(box))
