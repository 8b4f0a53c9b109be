"""`python -m pixels.footprints --out DIR`: the analog blocks' footprints, LEF and GDS frames, for `make layout`.

A frame is an outline with pins: it holds a block's place on the die until a circuit of the same pins takes it.
"""

import argparse
import sys
from pathlib import Path

from base.files import staged
from base.gds import write_gds
from models.parameters import ArrayParameters, ChipParameters, ParameterError
from platforms.coriolis import coriolis_platform
from platforms.die import top_metal

from .blocks import DEEP_UM, AnalogSizes, blocks

# Of CoriolisPlatform.wires: of pins in the north and south, and in the west and east
VERTICAL, ACROSS = 4, 3
WIDE_UM = 0.4  # of a signal's pin


def layer(pin, pdk):
    """The Layer of a pin."""
    if pin.supply:
        return top_metal(pdk).metal
    return coriolis_platform(pdk).metals[VERTICAL if pin.side in ("north", "south") else ACROSS]


def box(pin, block, supply_um, grid_um):
    """(left, bottom, right, top) in um of a pin, on the grid."""
    vertical = pin.side in ("north", "south")
    wide = (supply_um if pin.supply else WIDE_UM) / 2
    deep = supply_um if pin.supply else DEEP_UM
    low, high = (round(round((pin.at_um + way * wide) / grid_um) * grid_um, 3) for way in (-1, 1))
    far = block.height_um if vertical else block.width_um
    begin, end = (0.0, deep) if pin.side in ("south", "west") else (round(far - deep, 3), far)
    return (low, begin, high, end) if vertical else (begin, low, end, high)


def lef(block, pdk, supply_um):
    """The LEF of a block as text: outline, pins, and what lies deeper than these an obstruction on their layers."""
    known = coriolis_platform(pdk)
    found = {}
    for pin in block.pins:
        found.setdefault(pin.name, []).append((pin, layer(pin, pdk).lef, box(pin, block, supply_um, known.grid_um)))
    lines = [
        "VERSION 5.8 ;",
        'BUSBITCHARS "[]" ;',
        'DIVIDERCHAR "/" ;',
        f"MACRO {block.name}",
        "  CLASS BLOCK ;",
        f"  SIZE {block.width_um:.3f} BY {block.height_um:.3f} ;",
    ]
    for name, pieces in found.items():
        use = {"vdda": "POWER", "vssa": "GROUND"}.get(name, "SIGNAL")
        lines += [f"  PIN {name}", f"    DIRECTION {pieces[0][0].direction.upper()} ;", f"    USE {use} ;", "    PORT"]
        for _, of, corners in pieces:
            lines += [f"      LAYER {of} ;", f"        RECT {' '.join(f'{value:.3f}' for value in corners)} ;"]
        lines += ["    END", f"  END {name}"]
    lines.append("  OBS")
    deep = DEEP_UM + supply_um
    inside = min(block.width_um, block.height_um) > 2 * deep
    for name in dict.fromkeys(name for pieces in found.values() for _, name, _ in pieces) if inside else ():
        lines += [
            f"    LAYER {name} ;",
            f"      RECT {deep:.3f} {deep:.3f} {block.width_um - deep:.3f} {block.height_um - deep:.3f} ;",
        ]
    return "\n".join([*lines, "  END", f"END {block.name}", "END LIBRARY", ""])


def frame(block, pdk, supply_um):
    """The klayout.db.Layout of a block's frame: its pins with their names, and its outline."""
    import klayout.db as db

    known, layout = coriolis_platform(pdk), db.Layout()
    layout.dbu = 0.001
    cell = layout.create_cell(block.name)
    for pin in block.pins:
        metal = layer(pin, pdk)
        corners = db.DBox(*box(pin, block, supply_um, known.grid_um))
        text = db.DText(pin.name, corners.center().x, corners.center().y)
        cell.shapes(layout.layer(*metal.gds)).insert(corners)
        for named in (metal.pin, metal.label):
            cell.shapes(layout.layer(*named)).insert(text)
    cell.shapes(layout.layer(*known.outline)).insert(db.DBox(0, 0, block.width_um, block.height_um))
    return layout


def write(out, made, pdk, supply_um):
    """Write <block>.lef and <block>.gds of every Block into ``out``."""
    with staged(out) as part:
        for block in made:
            (part / f"{block.name}.lef").write_text(lef(block, pdk, supply_um))
            write_gds(frame(block, pdk, supply_um), part / f"{block.name}.gds")


def main(argv=None):
    parser = argparse.ArgumentParser(prog="python -m pixels.footprints", description=__doc__.splitlines()[0])
    parser.add_argument("--pdk", default="sky130")
    parser.add_argument("--rows", type=int, default=ArrayParameters().rows)
    parser.add_argument("--cols", type=int, default=ArrayParameters().cols)
    parser.add_argument("--lanes", type=int, default=ChipParameters().lanes)
    parser.add_argument("--out", type=Path, required=True, help="folder")
    options = parser.parse_args(argv)
    sizes = AnalogSizes()
    try:
        made = blocks(ArrayParameters(options.rows, options.cols), ChipParameters(options.lanes), sizes)
        write(options.out, made, options.pdk, sizes.supply_um)
    except (ParameterError, OSError) as error:
        print(f"pixels.footprints: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
