"""A layout as a picture: KLayout's own rendering, without its window."""

PALETTE = (0x2e7d32, 0xc62828, 0x1e88e5, 0x8e24aa, 0xf9a825, 0xef6c00)      # wires, from the lowest up
BACKGROUND = "#101014"


def render(gds, png, known, side=2400):
    """Write the layout ``gds`` as a picture of ``side`` x ``side`` pixels. known: Embedded, whose wires are drawn."""
    import klayout.lay as lay
    view = lay.LayoutView()
    view.set_config("background-color", BACKGROUND)
    view.set_config("grid-visible", "false")
    view.set_config("text-visible", "false")
    view.load_layout(str(gds), False)
    view.max_hier()
    colors = {(wire.layer, wire.datatype): color for wire, color in zip(known.wires, PALETTE)}
    layers = view.begin_layers()
    while not layers.at_end():
        shown = layers.current().dup()
        color = colors.get((shown.source_layer, shown.source_datatype))
        shown.visible = color is not None
        if color is not None:
            shown.fill_color = shown.frame_color = color
            shown.dither_pattern = 0
            shown.transparent = False
        view.set_layer_properties(layers, shown)
        layers.next()
    view.zoom_fit()
    view.save_image(str(png), side, side)
