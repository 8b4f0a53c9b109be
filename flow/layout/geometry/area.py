"""Pads that alone are smaller than a process allows are made longer.

The router draws a via stack with pads of their least size, and metal of a layer that is nothing but such a pad may be
too small. It grows along one side, or both, where nothing of its layer is near.
"""

from collections.abc import Iterable, Iterator, Mapping

from talbot.base.gds import db
from talbot.platforms.layers import Layer

GRID_NM = 5


def grow(layout: "db.Layout", top: "db.Cell", metals: Iterable[Layer], rules: Mapping[str, Mapping[str, float]]) -> int:
    """Grow them in the top cell ``top``; rules: by layer 'area' (um2) and 'space' (um). Returns how many were grown.

    One that has no room stays, and the design rules find it.
    """
    grown = 0
    for of in metals:
        least = round(rules[of.name]["area"] / layout.dbu**2)
        space = round(rules[of.name]["space"] / layout.dbu)
        layer = layout.layer(*of.gds)
        metal = db.Region(top.begin_shapes_rec(layer)).merged()
        for polygon in metal.with_area(1, least, False).each() if least else ():
            others = metal - db.Region(polygon)
            for box in longer(polygon.bbox(), least):
                new = db.Region(box) - db.Region(polygon)  # its neighbours are as near as tracks are
                if (others & new.sized(space)).is_empty():
                    top.shapes(layer).insert(box)
                    metal.insert(box)
                    grown += 1
                    break
    return grown


def longer(box: "db.Box", area: int) -> "Iterator[db.Box]":
    """Boxes with at least ``area`` that hold ``box``, as long as it or as high: both ways first, then one."""

    def lack(length: int, width: int) -> int:
        """What ``length`` lacks for the area at this ``width``."""
        return -(-max(0, -(-area // width) - length) // (2 * GRID_NM)) * 2 * GRID_NM  # even in grids

    across, along = lack(box.width(), box.height()), lack(box.height(), box.width())
    for left, right in ((across // 2, across // 2), (across, 0), (0, across)):
        yield db.Box(box.left - left, box.bottom, box.right + right, box.top)
    for down, up in ((along // 2, along // 2), (along, 0), (0, along)):
        yield db.Box(box.left, box.bottom - down, box.right, box.top + up)
