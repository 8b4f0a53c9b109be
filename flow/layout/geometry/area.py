"""Pads that alone are smaller than a process allows are made longer.

The router draws a stack of cuts with pads of their least size, and a wire of a layer that is nothing but such a pad may
be too small. It grows along one side, or both, where nothing of its layer is near.
"""

GRID_NM = 5


def grow(layout, top, wires, rules):
    """Grow them in the top cell ``top``; rules: dict wire -> {'area': um2, 'space': um}. Returns how many were grown.

    One that has no room stays, and the design rules find it.
    """
    import klayout.db as db

    grown = 0
    for wire in wires:
        least = round(rules[wire.name]["area"] / layout.dbu**2)
        space = round(rules[wire.name]["space"] / layout.dbu)
        layer = layout.layer(*wire.gds)
        metal = db.Region(top.begin_shapes_rec(layer)).merged()
        for polygon in metal.with_area(1, least, False).each() if least else ():
            others = metal - db.Region(polygon)
            for box in longer(polygon.bbox(), least):
                new = db.Region(box) - db.Region(polygon)  # its neighbours are as near as tracks are
                if (others & new.sized(space)).is_empty():
                    top.shapes(layer).insert(box)
                    metal += box
                    grown += 1
                    break
    return grown


def longer(box, area):
    """Boxes with at least ``area`` that hold ``box``, as long as it or as high: both ways first, then one."""
    import klayout.db as db

    def lack(length, width):
        return -(-max(0, -(-area // width) - length) // (2 * GRID_NM)) * 2 * GRID_NM  # even in grids

    across, along = lack(box.width(), box.height()), lack(box.height(), box.width())
    for left, right in ((across // 2, across // 2), (across, 0), (0, across)):
        yield db.Box(box.left - left, box.bottom, box.right + right, box.top)
    for down, up in ((along // 2, along // 2), (along, 0), (0, along)):
        yield db.Box(box.left, box.bottom - down, box.right, box.top + up)
