"""Pictures of a layout: KLayout's own rendering, without its window; the cells by block."""

from pathlib import Path
from typing import Any

from talbot.flow.layout.netlist.netlist import Netlist
from talbot.flow.layout.netlist.placed import MIRRORED
from talbot.platforms.coriolis import CoriolisPlatform

PALETTE = (0x2E7D32, 0xC62828, 0x1E88E5, 0x8E24AA, 0xF9A825, 0xEF6C00)  # metal layers, from the lowest up
BACKGROUND = "#101014"


def render(gds: Path, png: Path, tech: CoriolisPlatform, side: int = 2400) -> None:
    """Write the metal layers of the layout ``gds`` as a picture of ``side`` x ``side`` pixels."""
    import klayout.lay as lay

    view = lay.LayoutView()
    for name, value in (("background-color", BACKGROUND), ("grid-visible", "false"), ("text-visible", "false")):
        view.set_config(name, value)
    view.load_layout(str(gds), False)
    view.max_hier()
    colors = {wire.gds: color for wire, color in zip(tech.metals, PALETTE)}
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


def by_block(
    png: Path,
    netlist: Netlist,
    placed: list[list[Any]],
    areas: dict[str, float],
    tech: CoriolisPlatform,
    found: dict[str, str],
    plan: dict[str, Any],
) -> None:
    """Draw the cells, coloured by block.

    placed: instances of the placement, in the netlist's order. areas: cell -> um2. found: instance -> block. plan: with
    width_um and height_um.
    """
    from matplotlib.collections import PatchCollection
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    figure = Figure(figsize=(8, 6), layout="constrained")
    axes = figure.subplots()
    groups = {}
    for instance, (_, cell, x, y, orientation) in zip(netlist.instances, placed, strict=True):
        if instance.name in found and instance.pins:
            (across, up), width = MIRRORED[orientation], areas[cell] / tech.row_um
            box = Rectangle((x, y), across * width, up * tech.row_um)
            groups.setdefault(found[instance.name], []).append(box)
    for k, (block, boxes) in enumerate(sorted(groups.items(), key=lambda item: -len(item[1]))):
        axes.add_collection(PatchCollection(boxes, facecolor=f"C{k % 10}", edgecolor="white", linewidth=0.2))
        axes.plot([], [], "s", color=f"C{k % 10}", label=f"{block} ({len(boxes)})")
    axes.set(xlim=(0, plan["width_um"]), ylim=(0, plan["height_um"]), aspect="equal", xlabel="um", ylabel="um")
    figure.legend(loc="outside right upper", frameon=False)
    figure.savefig(png, dpi=130, metadata={"Software": None})
