"""A gate below a metal layer, for tests of antennas."""


def gate(layout, tech):
    """A cell of KLayout's ``layout`` with a gate of 0.075 um2 below a piece of the second metal layer of ``tech``."""
    import klayout.db as db

    cell = layout.create_cell("gate")
    low, metal, via = tech.metals[0], tech.metals[1], tech.vias[0]
    for layer, *box in (
        (tech.active, 0, 0, 1, 0.5),
        (tech.poly, 0.4, -1, 0.55, 1),
        (tech.contact, 0.4, -0.9, 0.55, -0.8),
        (low.gds, 0.3, -1, 0.7, -0.5),
        (via.gds, 0.4, -0.75, 0.4 + via.size_um, -0.75 + via.size_um),
        (metal.gds, 0.3, -0.8, 0.7, -0.5),
    ):
        cell.shapes(layout.layer(*layer)).insert(db.DBox(*box))
    return cell
