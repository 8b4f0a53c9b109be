"""Notches of one net's metal that are narrower than a process allows are filled.

A wire that `mend` leads to a block's pin ends in a pad beside it, now and then a few nm away: one shape with a slit.
What fills a slit joins nothing that was not one shape before.
"""


def fill(layout, top, wires, spaces):
    """Fill them in the top cell ``top``; spaces: dict wire -> least space (um). Returns how many were filled. Cells have
    none of their own."""
    import klayout.db as db
    filled = 0
    for wire in wires:
        layer = layout.layer(wire.layer, wire.datatype)
        metal = db.Region(top.begin_shapes_rec(layer)).merged()
        for pair in metal.notch_check(round(spaces[wire.name] / layout.dbu), False, db.Region.Projection).each():
            top.shapes(layer).insert(pair.bbox())
            filled += 1
    return filled
