"""Footprints of the analog blocks, LEF and GDS, for `make layout`.

A footprint is a black-box macro, an outline with pins: it keeps a block's place on the die until a circuit with the
same pins takes it.
"""

import argparse
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from talbot.base.command import main
from talbot.base.files import staged
from talbot.base.gds import write_gds
from talbot.base.lef import write as lef_text
from talbot.base.lef.read import Box
from talbot.base.sensor import Varied, add_sensor, sensor_asked
from talbot.pixels.blocks import DEEP_UM, SUPPLIES, AnalogSizes, Block, Pin, blocks
from talbot.platforms.die import top_metal
from talbot.platforms.layers import Layer
from talbot.platforms.layout import layout_platform

if TYPE_CHECKING:
    import klayout.db as db

# Of LayoutPlatform.metals: of pins in the north and south, and in the west and east
VERTICAL, ACROSS = 4, 3
WIDE_UM = 0.4  # of a signal's pin
FIELDS = {"rows": "array.rows", "cols": "array.cols", "lanes": "chip.lanes"}
VARIED = Varied(used=(*FIELDS.values(), "array.pitch"))
USES = {name: "GROUND" if name == "vssa" else "POWER" for name in SUPPLIES}


def layer(pin: Pin, pdk: str) -> Layer:
    """Return the metal of a pin. Raises ParameterError for a process without one for supplies."""
    if pin.supply:
        return top_metal(pdk).metal
    return layout_platform(pdk).metals[VERTICAL if pin.side in ("north", "south") else ACROSS]


def box(pin: Pin, block: Block, supply_um: float, grid_um: float) -> Box:
    """Return the shape of a pin, on the grid."""
    vertical = pin.side in ("north", "south")
    wide = (supply_um if pin.supply else WIDE_UM) / 2
    deep = supply_um if pin.supply else DEEP_UM
    low, high = (round(round((pin.at_um + way * wide) / grid_um) * grid_um, 3) for way in (-1, 1))
    far = block.height_um if vertical else block.width_um
    begin, end = (0.0, deep) if pin.side in ("south", "west") else (round(far - deep, 3), far)
    return (low, begin, high, end) if vertical else (begin, low, end, high)


def lef(block: Block, pdk: str, supply_um: float, taken: Iterable[str] = ()) -> str:
    """Return the LEF of a block: outline, pins, and an obstruction on their layers over all that is deeper than these.

    taken: LEF names of further layers that are obstructed.
    """
    grid_um = layout_platform(pdk).grid_um
    pieces: dict[str, list[tuple[Pin, str]]] = {}
    for pin in block.pins:
        pieces.setdefault(pin.name, []).append((pin, layer(pin, pdk).lef))
    pins = [
        lef_text.Pin(
            name,
            [f"DIRECTION {shapes[0][0].direction.upper()}", f"USE {USES.get(name, 'SIGNAL')}"],
            [lef_text.Rectangles(of, [box(pin, block, supply_um, grid_um)]) for pin, of in shapes],
        )
        for name, shapes in pieces.items()
    ]
    deep = DEEP_UM + supply_um
    inside = [(deep, deep, block.width_um - deep, block.height_um - deep)]
    layers = dict.fromkeys([*(of for shapes in pieces.values() for _, of in shapes), *taken])
    obstructions = [lef_text.Rectangles(of, inside) for of in layers]
    macro = lef_text.macro(
        block.name,
        ["CLASS BLOCK", lef_text.size(block.width_um, block.height_um)],
        pins,
        obstructions if min(block.width_um, block.height_um) > 2 * deep else [],
    )
    return lef_text.HEADER + macro + lef_text.END


def black_box(block: Block, pdk: str, supply_um: float) -> "db.Layout":
    """Return the layout of a footprint: pins with their names, and the outline."""
    import klayout.db as db

    tech, layout = layout_platform(pdk), db.Layout()
    layout.dbu = 0.001
    cell = layout.create_cell(block.name)
    draw_pins(layout, cell, block, pdk, supply_um)
    cell.shapes(layout.layer(*tech.outline)).insert(db.DBox(0, 0, block.width_um, block.height_um))
    return layout


def draw_pins(layout: "db.Layout", cell: "db.Cell", block: Block, pdk: str, supply_um: float) -> None:
    """Draw the pins of a block into its cell, with their names."""
    import klayout.db as db

    tech = layout_platform(pdk)
    for pin in block.pins:
        metal = layer(pin, pdk)
        corners = db.DBox(*box(pin, block, supply_um, tech.grid_um))
        text = db.DText(pin.name, corners.center().x, corners.center().y)
        cell.shapes(layout.layer(*metal.gds)).insert(corners)
        for numbers in (metal.pin, metal.label):
            cell.shapes(layout.layer(*numbers)).insert(text)


def write(out: str | Path, footprints: Iterable[Block], pdk: str, supply_um: float) -> None:
    """Write <block>.lef and <block>.gds of every block into ``out``."""
    with staged(out) as part:
        for block in footprints:
            (part / f"{block.name}.lef").write_text(lef(block, pdk, supply_um), encoding="utf-8")
            write_gds(black_box(block, pdk, supply_um), part / f"{block.name}.gds")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `talbot footprints`."""
    parser.add_argument("--pdk", default="sky130", help="process")
    add_sensor(parser, FIELDS)
    parser.add_argument("--out", type=Path, required=True, help="folder of the files")


def run(options: argparse.Namespace) -> int:
    """Write the footprints."""
    sensor = sensor_asked(options, VARIED, FIELDS)
    sizes = AnalogSizes.of(sensor.array, sensor.chip)
    write(options.out, blocks(sensor.array, sensor.chip, sizes), options.pdk, sizes.supply_um)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.modules[__name__]))
