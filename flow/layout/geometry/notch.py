"""Notches and holes of one net's metal that are narrower or smaller than a process allows are filled.

A route that `reroute` leads to a block's pin ends in a pad beside it, now and then a few nm away: one shape with a slit.
What fills a slit joins nothing that was not one shape before.
"""


def fill(layout, top, wires, spaces):
    """Fill them in the top cell ``top``; wires: tuple of Wire; spaces: dict wire -> least space (um). Returns how many
    were filled. Cells have none of their own."""
    import klayout.db as db

    filled = 0
    for wire in wires:
        layer = layout.layer(*wire.gds)
        metal = db.Region(top.begin_shapes_rec(layer)).merged()
        found = [
            db.Polygon(pair.bbox())
            for pair in metal.notch_check(round(spaces[wire.name] / layout.dbu), False, db.Region.Projection).each()
        ]
        found += [
            hole
            for hole in (metal + db.Region(found)).merged().holes().each()
            if hole.area() * layout.dbu**2 < wire.min_hole_um2
        ]
        for polygon in found:
            top.shapes(layer).insert(polygon)
        filled += len(found)
    return filled
