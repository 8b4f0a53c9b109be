"""LEF and GDS of the drawn pixel array, from the gratings that a process keeps."""

import argparse
import sys
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from talbot.base.command import main
from talbot.base.files import staged
from talbot.base.gds import db, write_gds
from talbot.base.sensor import add_sensor, sensor_asked
from talbot.models.parameters import ArrayParameters, ParameterError, TileParameters
from talbot.pixels.blocks import AnalogSizes
from talbot.pixels.designs import gratings
from talbot.pixels.drawn import ARRAY_FIELDS, DRAWN_ARRAY
from talbot.pixels.footprints import lef
from talbot.pixels.layout.array import ArrayLayout, draw_array, draw_pixels
from talbot.pixels.layout.pixel import PixelLayout, pixel_layout
from talbot.pixels.optics.design import REACHED, measure
from talbot.pixels.optics.fit import Fit
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.platforms.pixel import pixel_process

NAME = "pixel_array"


def drawn_pixels(
    pdk: str, tile: TileParameters, pitch_um: float = ArrayParameters().pitch_um
) -> tuple[PixelLayout, ...]:
    """The tile's types on the gratings that ``pdk`` keeps. Raises ParameterError for a beta that it does not have."""
    wavelength = gratings(pdk).wavelength_um
    return tuple(
        pixel_layout(replace(geometry, pitch_um=pitch_um), kind, fitted(geometry, wavelength))
        for kind, geometry in zip(tile.types, tile_geometries(pdk, tile), strict=True)
    )


def tile_geometries(pdk: str, tile: TileParameters) -> list[PixelGeometry]:
    """Of each of the tile's types the gratings that ``pdk`` keeps. Raises ParameterError for one without."""
    pixel_process(pdk)
    chosen, out = gratings(pdk), []
    for kind in tile.types:
        beta = min(chosen.geometries, key=lambda b: abs(b - kind.beta))
        if abs(beta - kind.beta) > REACHED * beta:
            known = ", ".join(f"{b:g}" for b in chosen.geometries)
            raise ParameterError(f"beta = {kind.beta:g}: must be one of {known}, which {pdk!r} has gratings for")
        out.append(chosen.geometries[beta])
    return out


@lru_cache(maxsize=64)
def fitted(geometry: PixelGeometry, wavelength_um: float) -> Fit:
    """Eq. 3.1 fitted to a geometry."""
    return measure(geometry, wavelength_um).fit


def array_layout(
    pdk: str, rows: int, cols: int, tile: TileParameters = TileParameters(), pitch: float = ArrayParameters.pitch
) -> ArrayLayout:
    """Return an array of a tile; ``pitch`` in m. Raises ParameterError."""
    array = ArrayParameters(rows, cols, pitch)
    return ArrayLayout(array, tile, drawn_pixels(pdk, tile, array.pitch_um))


def array_lef(array: ArrayLayout) -> str:
    """Return the LEF of the array: outline, pins, all metals taken."""
    process = array.pixels[0].process
    return lef(array.block, process.name, AnalogSizes().supply_um, [metal.lef for metal in process.metals])


def write(out: str | Path, array: ArrayLayout) -> None:
    """Write pixel_array.lef and pixel_array.gds into ``out``."""
    layout = db.Layout()
    layout.dbu = 0.001
    cell = draw_array(layout, array, draw_pixels(layout, array))
    with staged(out) as part:
        (part / f"{NAME}.lef").write_text(array_lef(array), encoding="utf-8")
        write_gds(layout, part / f"{NAME}.gds", cell)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `python -m talbot.pixels.layout.write`."""
    parser.add_argument("--pdk", default="sky130", help="process")
    add_sensor(parser, ARRAY_FIELDS)
    parser.add_argument("--out", type=Path, required=True, help="folder of the files")


def run(options: argparse.Namespace) -> int:
    """Write the files."""
    sensor = sensor_asked(options, DRAWN_ARRAY, ARRAY_FIELDS)
    write(options.out, array_layout(options.pdk, *sensor.shape, sensor.tile, sensor.array.pitch))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.modules[__name__]))
