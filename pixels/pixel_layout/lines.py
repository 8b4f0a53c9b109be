"""Resistance and capacitance of a pixel's lines, extracted from drawn arrays.

Two arrays that differ by a tile's rows, or columns, and in nothing else: what a line has more in the larger one, over
the pixels that it has more, is a pixel's part, without the ends. Lines are in the array's middle, with all of their
neighbours. Gates and junctions are the transistors' and not counted.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from talbot.base.gds import db, pex
from talbot.base.steps import StepError
from talbot.pixels.layout.array import ArrayLayout, draw_array, draw_pixels
from talbot.pixels.layout.pixel import COLUMN, COLUMNS, LINE, READ_Y, RESET_Y, ROWS_ON, PixelLayout, draw
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.platforms.wires import CORNERS
from talbot.signoff.parasitics.capacitance import capacitances
from talbot.signoff.parasitics.extract import floating, with_fill_floating
from talbot.signoff.parasitics.shapes import labels, shapes

LEAST = 4, 6  # rows and columns of the smaller array, which has whole tiles
ROWS, COLUMN_NETS = ("pixel_reset", "read"), ("column_a", "column_b")
NAMES = ROWS + COLUMN_NETS


@dataclass(frozen=True)
class Line:
    """A line's part in each pixel. ohm: of the line's metal. farad: least, typical and most, to all else."""

    ohm: float
    farad: dict[str, float]


def extracted(made: ArrayLayout) -> dict[str, Line]:
    """Return the lines `NAMES` of the pixels of an array. Raises StepError."""

    def farads(rows: int, cols: int) -> dict[str, dict[str, float]]:
        return _farads(replace(made, array=replace(made.array, rows=rows, cols=cols)))

    tile, pixel = made.tile, made.pixels[0]
    rows, cols = (-(-least // size) * size for least, size in zip(LEAST, (tile.rows, tile.cols), strict=True))
    small, taller, wider = farads(rows, cols), farads(2 * rows, cols), farads(rows, 2 * cols)
    out = {}
    for name in NAMES:
        large, more = (wider, cols) if name in ROWS else (taller, rows)
        out[name] = Line(_ohm(pixel, name), {c: (large[name][c] - small[name][c]) / more for c in CORNERS})
    return out


def table(pdk: str, found: Mapping[float, Mapping[str, Line]]) -> dict[str, Any]:
    """Return the lines for models and circuits: `models.parameters.drawn_lines`. found: by pitch in um, ascending."""
    return {
        "command": f"make pixel-layout, {pdk}",
        "source": "extracted from drawn arrays, a pixel's part: platforms.wires, fitted to OpenROAD's tables",
        "pitches_um": [*found],
        "parameters": [_parameters(lines) for lines in found.values()],
        "lines": [{name: asdict(line) for name, line in lines.items()} for lines in found.values()],
    }


def _parameters(found: Mapping[str, Line]) -> dict[str, float]:
    """Return the fields of `LineParameters`."""
    parameters = {}
    for line, names in (("row", ROWS), ("column", COLUMN_NETS)):
        ohm, farad = max(found[name].ohm for name in names), max(found[name].farad["typ"] for name in names)
        parameters |= {f"{line}_ohm": float(f"{ohm:.4g}"), f"{line}_farad": float(f"{farad:.4g}")}
    return parameters


def _farads(made: ArrayLayout) -> dict[str, dict[str, float]]:
    """Return the capacitance of the lines in the middle of the array, F, at the corners of wires."""
    layout = db.Layout()
    layout.dbu = 0.001
    top = draw_array(layout, made, draw_pixels(layout, made))
    pdk = made.pixels[0].process.name
    tech, devices = layout_platform(pdk), extraction_platform(pdk)
    found = shapes(layout, top, tech, devices)
    places = labels(layout, top, tech)
    middle = {name: f"{name}_row[{made.array.rows // 2}]" for name in ROWS}
    middle |= {name: f"{name}[{made.array.cols // 2}]" for name in COLUMN_NETS}
    nets = {}
    for name, label in middle.items():
        box = next((found.at(*point) for point in places.get(label, ()) if found.at(*point) >= 0), -1)
        if box < 0:
            raise StepError(f"lines: {label} has no metal under its label")
        nets[name] = int(found.nets[box])
    driven = [int(found.nets[found.at(*point)]) for points in places.values() for point in points[:1]]
    floats = floating(found, np.array(driven))
    corners = [tech.wires[corner] for corner in CORNERS]
    out: dict[str, dict[str, float]] = {name: {} for name in NAMES}
    for corner, one in zip(CORNERS, capacitances(found, corners, floats), strict=True):
        own = np.bincount(found.nets, with_fill_floating(found, one, floats))
        for name, net in nets.items():
            out[name][corner] = 1e-15 * float(own[net])
    return out


def _ohm(made: PixelLayout, name: str) -> float:
    """Return the resistance of a line's metal from one edge of the pixel to the other, with its branches."""
    layout = db.Layout()
    layout.dbu = 0.001
    cell = draw(layout, made).cell
    pitch, half = made.geometry.pitch_um, made.geometry.pitch_um / 2
    level = ROWS_ON if name in ROWS else COLUMNS
    at = {"pixel_reset": RESET_Y, "read": READ_Y, "column_a": half - COLUMN, "column_b": half + COLUMN}[name]
    ends = (0.0, pitch)
    spots = [db.DBox(end - 0.002, at - LINE / 2, end + 0.002, at + LINE / 2) for end in ends]
    if level == COLUMNS:
        spots = [db.DBox(spot.bottom, spot.left, spot.top, spot.right) for spot in spots]
    metal = made.process.metals[level]
    ports = [db.Region(spot.to_itype(layout.dbu)) for spot in spots]
    line = db.Region(cell.begin_shapes_rec(layout.layer(*metal.gds))).merged().interacting(ports[0])
    rules, conductor = pex.RExtractorTech(), pex.RExtractorTechConductor()
    conductor.layer, conductor.resistance = 1, metal.sheet_ohm
    rules.add_conductor(conductor)
    polygons = {1: [polygon for port in ports for polygon in (port & line).merged().each()]}
    network = pex.RNetExtractor(layout.dbu).extract(rules, {1: line}, {}, polygons)
    network.simplify()
    return sum(element.resistance() for element in network.each_element())
