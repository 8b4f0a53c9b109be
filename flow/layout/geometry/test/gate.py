"""A gate below a wire, for tests of antennas."""


def gate(layout, known):
    """A cell of KLayout's ``layout`` with a gate of 0.075 um2 below a piece of the second wire of ``known`` (CoriolisPlatform)."""
    import klayout.db as db

    cell = layout.create_cell("gate")
    low, wire, cut = known.metals[0], known.metals[1], known.vias[0]
    for layer, *box in (
        (known.active, 0, 0, 1, 0.5),
        (known.poly, 0.4, -1, 0.55, 1),
        (known.contact, 0.4, -0.9, 0.55, -0.8),
        (low.gds, 0.3, -1, 0.7, -0.5),
        (cut.gds, 0.4, -0.7, 0.5, -0.6),
        (wire.gds, 0.3, -0.8, 0.7, -0.5),
    ):
        cell.shapes(layout.layer(*layer)).insert(db.DBox(*box))
    return cell
