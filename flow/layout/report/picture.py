"""Pictures of a layout: every layer by KLayout's own rendering, without its window; the cells by block."""

import io
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image as pillow
from PIL.Image import Image

from talbot.base.gds import db, read_gds
from talbot.base.page import data_url
from talbot.base.style import own_style
from talbot.platforms.layout import LayoutPlatform
from talbot.signoff.netlist.netlist import OUTPUT_PINS, Instance, Netlist, is_register
from talbot.signoff.netlist.placed import MIRRORED

PALETTE = (0x43A047, 0xE53935, 0x1E88E5, 0x8E24AA, 0xF9A825, 0xEF6C00)  # metal layers, from the lowest up
OTHERS = {"fill": 0x707A86, "diffusion": 0x6D4C41, "poly": 0xA1887F}
BACKGROUND = (16, 16, 20)
FILL = 1023, 0  # GDS layer, in memory alone, where fill is apart from its metals
LARGEST = 2400  # px of the longer side


@dataclass(frozen=True)
class Layer:
    """A layer of a picture. mask: where it is. shown: at first."""

    name: str
    rgb: int
    mask: Image
    shown: bool

    @property
    def color(self) -> str:
        """As CSS has it."""
        return f"#{self.rgb:06x}"

    @property
    def src(self) -> str:
        """In its colour on nothing, as a data URL."""
        image = self.mask.convert("P")
        image.putpalette([0, 0, 0, *self.rgb.to_bytes(3, "big")])
        return data_url(image.point([0] + [1] * 255), transparency=0, bits=1, optimize=True)


@dataclass(frozen=True)
class LayoutPicture:
    """A layout's layers, from the lowest up. width_um, height_um: of its outline."""

    width_um: float
    height_um: float
    layers: list[Layer]

    @property
    def image(self) -> Image:
        """All layers that are shown at first, over each other."""
        image = pillow.new("RGB", self.layers[0].mask.size, BACKGROUND)
        for layer in self.layers:
            if layer.shown:
                image.paste(tuple(layer.rgb.to_bytes(3, "big")), mask=layer.mask)
        return image


def render(gds: Path, tech: LayoutPlatform, unfilled: Path | None = None, side: int = LARGEST) -> LayoutPicture:
    """Draw the layers of the layout ``gds``, the longer side ``side`` pixels.

    unfilled: the same layout without metal fill, which then is a layer of its own.
    """
    import klayout.lay as lay

    layout = read_gds(unfilled or gds)
    top = layout.top_cell()
    if unfilled:
        filled, into = read_gds(gds), layout.layer(*FILL)
        for metal in tech.metals:
            drawn = db.Region(filled.top_cell().shapes(filled.layer(*metal.gds)))
            top.shapes(into).insert(drawn - db.Region(top.shapes(layout.layer(*metal.gds))))
    view = lay.LayoutView()
    for name, value in (("background-color", "#000000"), ("grid-visible", "false"), ("text-visible", "false")):
        view.set_config(name, value)
    view.show_layout(layout, True)
    view.max_hier()
    view.add_missing_layers()
    box = top.dbbox()
    size = [max(1, round(side * length / max(box.width(), box.height()))) for length in (box.width(), box.height())]
    wanted = [("diffusion", tech.active, False), ("poly", tech.poly, False)]
    wanted += [("fill", FILL, True)] * bool(unfilled) + [(m.name, m.gds, True) for m in tech.metals]
    colors = OTHERS | {metal.name: color for metal, color in zip(tech.metals, PALETTE)}
    return LayoutPicture(
        round(box.width(), 3),
        round(box.height(), 3),
        [Layer(name, colors[name], _mask(view, at, size, box), shown) for name, at, shown in wanted],
    )


def _mask(view: Any, wanted: tuple[int, int], size: list[int], box: Any) -> Image:
    """Pixels on which a GDS layer is, as an image of two colours."""
    layers = view.begin_layers()
    while not layers.at_end():
        shown = layers.current().dup()
        shown.visible = (shown.source_layer, shown.source_datatype) == wanted
        shown.fill_color = shown.frame_color = 0xFFFFFF
        shown.dither_pattern = 0
        shown.transparent = False
        view.set_layer_properties(layers, shown)
        layers.next()
    drawn = view.get_pixels_with_options(*size, 0, 1, 1.0, box).to_png_data()
    gray = np.asarray(pillow.open(io.BytesIO(drawn)).convert("L"))
    return pillow.fromarray(gray > 127)


@own_style()
def by_block(
    png: Path,
    netlist: Netlist,
    placed: list[list[Any]],
    areas: dict[str, float],
    tech: LayoutPlatform,
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
    axes.set(xlim=(0, plan["width_um"]), ylim=(0, plan["height_um"]), aspect="equal", xlabel="µm", ylabel="µm")
    figure.legend(loc="outside right center", frameon=False)
    figure.savefig(png, dpi=130, bbox_inches="tight", metadata={"Software": None})


@own_style()
def clock_tree(png: Path, netlist: Netlist, placed: list[list[Any]], clock: str, plan: dict[str, Any]) -> None:
    """Draw the nets from the port ``clock`` on: a line from each driver to each of its loads, a colour a level.

    placed: instances of the placement, in the netlist's order. plan: with width_um and height_um.
    """
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure

    at = {i.name: (x, y) for i, (_, _, x, y, _) in zip(netlist.instances, placed, strict=True)}
    loads, outputs = dict[str, list[Instance]](), dict[str, str]()
    for instance in netlist.instances:
        for pin, net in instance.pins.items():
            if pin in OUTPUT_PINS:
                outputs[instance.name] = net
            else:
                loads.setdefault(net, []).append(instance)
    figure = Figure(figsize=(8, 6), layout="constrained")
    axes = figure.subplots()
    nets, level = [(clock, None)], 0
    while nets:
        lines, following, sinks = [], list[tuple[str, Any]](), []
        for net, start in nets:
            for load in loads.get(net, ()):
                lines += [(start, at[load.name])] if start else []
                sinks.append(at[load.name])
                if not is_register(load.cell) and load.name in outputs:
                    following.append((outputs[load.name], at[load.name]))
        axes.add_collection(LineCollection(lines, colors=f"C{level % 10}", linewidths=0.7))
        if sinks:
            axes.plot(
                *zip(*sinks), "s", color=f"C{level % 10}", markersize=3, label=f"level {level}: {len(sinks)} loads"
            )
        nets, level = following, level + 1
    axes.set(xlim=(0, plan["width_um"]), ylim=(0, plan["height_um"]), aspect="equal", xlabel="µm", ylabel="µm")
    figure.legend(loc="outside right center", frameon=False)
    figure.savefig(png, dpi=130, bbox_inches="tight", metadata={"Software": None})


@own_style()
def congestion(png: Path, layout: LayoutPicture, metals: Collection[str], tile_um: float = 5.0) -> None:
    """Draw the share of metal in tiles of ``tile_um``, the mean of the layers named ``metals``."""
    from matplotlib.figure import Figure

    masks = [np.asarray(layer.mask, float) for layer in layout.layers if layer.name in metals]
    share = np.mean(masks, axis=0)
    side = max(1, round(tile_um * share.shape[1] / layout.width_um))
    rows, columns = (length // side for length in share.shape)
    tiles = share[: rows * side, : columns * side].reshape(rows, side, columns, side)
    figure = Figure(figsize=(8, 6), layout="constrained")
    axes = figure.subplots()
    extent = (0, layout.width_um, 0, layout.height_um)
    shown = axes.imshow(tiles.mean(axis=(1, 3)), extent=extent, cmap="inferno", vmin=0)
    figure.colorbar(shown, label="share of metal, mean of the layers")
    axes.set(xlabel="µm", ylabel="µm")
    figure.savefig(png, dpi=130, metadata={"Software": None})
