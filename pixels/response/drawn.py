"""The tile of a plan's pixels as masks, where the process has a drawn pixel and it has room for the plan's gratings."""

from pathlib import Path

from talbot.base.gds import db, write_gds
from talbot.models.parameters import ArrayParameters, ParameterError, TileParameters
from talbot.pixels.layout.array import ArrayLayout, draw_pixels, draw_tile
from talbot.pixels.layout.pixel import pixel_layout
from talbot.pixels.response.search import Plan
from talbot.pixels.response.types import nearest


def write_tile(plan: Plan, tile: TileParameters, gds: Path, pitch: float = ArrayParameters.pitch) -> str:
    """Write ``gds``; returns "", or why the tile cannot be drawn."""
    try:
        designs = [plan.designs[nearest(plan, kind.beta)] for kind in tile.types]
        pixels = tuple(pixel_layout(d.geometry, kind, d.fit) for kind, d in zip(tile.types, designs, strict=True))
        made = ArrayLayout(ArrayParameters(tile.rows, tile.cols, pitch), tile, pixels)
        layout = db.Layout()
        layout.dbu = 0.001
        write_gds(layout, gds, draw_tile(layout, made, draw_pixels(layout, made)))
    except ParameterError as error:
        return str(error)
    return ""
