"""Notches and holes of one net's metal that are narrower or smaller than a process allows are filled.

A route to a macro's pin ends in a pad beside it, sometimes a few nm away: one shape with a slit.
What fills a slit joins nothing that was not one shape before.
"""

from collections.abc import Iterable, Mapping

from talbot.base.gds import db
from talbot.platforms.layers import Layer

from .boxes import on_grid


def fill(layout: "db.Layout", top: "db.Cell", metals: Iterable[Layer], spaces: Mapping[str, float]) -> int:
    """Fill them in the top cell ``top``, cells have none; spaces: least, by layer (um). Returns how many."""
    filled = 0
    for of in metals:
        layer = layout.layer(*of.gds)
        metal = db.Region(top.begin_shapes_rec(layer)).merged()
        narrow = metal.notch_check(round(spaces[of.name] / layout.dbu), False, db.Region.Projection)
        found = [db.Polygon(db.Box(*on_grid(pair.bbox()))) for pair in narrow.each()]
        holes = (metal + db.Region(found)).merged().holes()
        found += [hole for hole in holes.each() if hole.area() * layout.dbu**2 < of.min_hole_um2]
        for polygon in found:
            top.shapes(layer).insert(polygon)
        filled += len(found)
    return filled
