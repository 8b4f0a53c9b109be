"""Pictures of drawn pixels: the tile, and a cross-section with the light in it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from talbot.base.charts import COLOURS
from talbot.base.gds import db, read_gds
from talbot.pixels.layout.pixel import UPPER, PixelLayout, openings
from talbot.pixels.optics.field import field_between
from talbot.pixels.optics.geometry import QUADRATURE
from talbot.platforms.layers import GdsLayer
from talbot.platforms.pixel import PixelProcess

WELL, ACTIVE, POLY = "#c9b8d8", "#6d4c41", "#c9574b"
METALS = ("#7aa874", "#4878a8", "#b8678f", "#e8a33d", "#5f6b7a", "#c9a24b")  # from the lowest
SILICA, NITRIDE, SILICON = "#eef2f6", "#cfe0c9", "#8b7fa0"
WELL_DEPTH_UM = 1.1  # of pictures alone


def _active(process: PixelProcess, colour: str) -> list[tuple[GdsLayer, str]]:
    """Diffusion, of transistors and of taps."""
    return [(process.active, colour), (process.tap, colour)]


def tile(gds: Path, process: PixelProcess) -> Figure:
    """Return the upper gratings of a tile, and all of its masks."""
    figure = Figure(figsize=(10, 3.6), layout="constrained")
    first, second = figure.subplots(1, 2)
    upper = process.metals[UPPER]
    draw_masks(first, gds, [(process.well, WELL), (upper.gds, METALS[UPPER])], f"photodiodes, {upper.lef}")
    everything = [(process.well, WELL), *_active(process, ACTIVE), (process.poly, POLY)]
    everything += [(metal.gds, METALS[k]) for k, metal in enumerate(process.metals[: UPPER + 1])]
    draw_masks(second, gds, everything, "all masks")
    return figure


def responses(curves: Sequence[Mapping[str, Any]]) -> Figure:
    """Shares of both diodes of every type: drawn, and of endless gratings (dotted)."""
    across = 4
    down = -(-len(curves) // across)
    figure = Figure(figsize=(10, 2.1 * down), layout="constrained")
    for axes, curve in zip(figure.subplots(down, across, sharex=True, squeeze=False).flat, curves):
        degrees = np.rad2deg(np.arcsin(curve["sines"]))
        for drawn, endless, colour in zip(curve["shares"], curve["endless"], COLOURS, strict=False):
            axes.plot(degrees, 100 * np.array(drawn), color=colour)
            axes.plot(degrees, 100 * np.array(endless), ":", color=colour, linewidth=1)
        phase = f"{np.rad2deg(curve['alpha']):g}"
        axes.set_title(f"{curve['beta']:g} / {curve['gamma_deg']:g} / {phase}: %, degrees", fontsize=8, loc="left")
        axes.set_ylim(bottom=0)
        axes.tick_params(labelsize=7)
    return figure


def cross_section(gds: Path, made: PixelLayout, wavelength_um: float) -> Figure:
    """Return a cross-section at the middle of the gratings, to scale, with the light of a wave on the axis."""
    g, process = made.geometry, made.process
    pitch = g.pitch_um
    at = 0.65 * pitch
    stack = g.stack
    figure = Figure(figsize=(10, 6.2), layout="constrained")
    axes = figure.subplots()
    axes.add_patch(Rectangle((0, -WELL_DEPTH_UM - 0.4), pitch, WELL_DEPTH_UM + 0.4 + stack.surface_um, color=SILICON))
    bottom = stack.surface_um
    for film in stack.films:
        colour = SILICA if film.material == "silica" else NITRIDE
        axes.add_patch(Rectangle((0, bottom), pitch, film.top_um - bottom, color=colour))
        bottom = film.top_um
    layout = read_gds(gds)
    for left, right in _cut(layout, process.well, at):
        axes.add_patch(Rectangle((left, -WELL_DEPTH_UM), right - left, WELL_DEPTH_UM + stack.surface_um, color=WELL))
        axes.text((left + right) / 2, -0.5, "n well", ha="center", fontsize=9)
    for side, diode in enumerate(made.diodes):
        _light(axes, made, side, diode, wavelength_um)
    for k, metal in enumerate(process.metals):
        known = [one for one in stack.metals if one.name == metal.lef]
        for left, right in _cut(layout, metal.gds, at) if known else []:
            place = (left, known[0].bottom_um)
            axes.add_patch(Rectangle(place, right - left, known[0].thickness_um, color=METALS[k], zorder=3))
    axes.set(xlim=(0, pitch), ylim=(-WELL_DEPTH_UM - 0.4, stack.films[-1].top_um + 0.3), aspect="equal")
    axes.set(xlabel="µm", ylabel="µm")
    return figure


def _light(axes: Axes, made: PixelLayout, side: int, diode: int, wavelength_um: float) -> None:
    """The field between a half's gratings, if their lines are upright in the cross-section."""
    g = made.drawn
    if abs(np.sin(made.kind.gamma)) > 1e-6:
        return
    half = g.pitch_um / 2
    left, _, right, _ = [box for _, box in openings(made)][1 + side]
    moved = replace(g, shift=(g.shift + QUADRATURE[diode]) % 1.0)
    x, up = np.linspace(left, right, 260), np.linspace(0, g.gap_um, 200)
    field = field_between(moved, 0.0, wavelength_um, x - half, up)
    low = g.stack.metal("analyzer", str(g.analyzer)).top_um
    most = float(np.quantile(field, 0.995))
    axes.imshow(
        field, cmap="inferno", extent=(left, right, low, low + g.gap_um), origin="lower", vmin=0, vmax=most, zorder=2
    )


def _cut(layout: "db.Layout", mask: GdsLayer, at_um: float) -> list[tuple[float, float]]:
    """Intervals in um that a mask has on the line y = at_um."""
    top = layout.top_cell()
    y = round(at_um / layout.dbu)
    line = db.Region(db.Box(-(10**7), y, 10**7, y + 1))
    cut = (db.Region(top.begin_shapes_rec(layout.layer(*mask))) & line).merged()
    return [(part.bbox().left * layout.dbu, part.bbox().right * layout.dbu) for part in cut.each()]


def draw_masks(
    axes: Axes, gds: Path, masks: Iterable[tuple[GdsLayer, str]], title: str, window: Sequence[float] | None = None
) -> None:
    """Draw masks of the top cell over one another."""
    layout = read_gds(gds)
    top = layout.top_cell()
    box = db.DBox(*window) if window else db.DBox(0, 0, *_size(layout))
    area = box.to_itype(layout.dbu)
    for number, (mask, colour) in enumerate(masks):
        inside = db.Region(top.begin_shapes_rec_touching(layout.layer(*mask), area)) & db.Region(area)
        shapes = [
            [(point.x * layout.dbu, point.y * layout.dbu) for point in polygon.each_point_hull()]
            for polygon in inside.merged().decompose_trapezoids_to_region().each()
        ]
        axes.add_collection(PolyCollection(shapes, facecolors=colour, edgecolors="none", alpha=0.9 if number else 1.0))
    axes.set(xlim=(box.left, box.right), ylim=(box.bottom, box.top), aspect="equal")
    axes.set_title(title, fontsize=9, loc="left")
    axes.tick_params(labelsize=7)
    if not title and not window:
        axes.set_axis_off()


def _size(layout: "db.Layout") -> tuple[float, float]:
    box = layout.top_cell().dbbox()
    return round(box.right), round(box.top)
