"""The abstract (LEF) of a block made from its GDS: size, pins on edges and straps, obstructions elsewhere."""

import re

from flow.layout.netlist import SUPPLIES
from models.parameters import ParameterError

EDGE_UM = 0.3           # how far from the edge a pin is taken for one
USES = dict(zip(SUPPLIES, ("POWER", "GROUND"), strict=True))


def ports(verilog):
    """dict pin -> 'input' or 'output' of the first module of a netlist, a bus bit by bit."""
    found = {}
    for direction, high, name in re.findall(r"(?m)^\s*(input|output)\s+(?:\[(\d+):0\]\s+)?(\w+);", verilog):
        names = [f"{name}[{bit}]" for bit in range(int(high) + 1)] if high else [name]
        found |= dict.fromkeys(names, direction)
    return found


def abstract(gds, directions, known, names):
    """Text of the LEF of the GDS's top cell.

    directions: dict pin -> 'input' or 'output'; the supplies are pins too. known: flow.platforms.embedded.Embedded.
    names: dict (GDS layer, datatype) -> name of the layer in LEF, where it is not that of the wire. Raises
    ParameterError for a port without metal.
    """
    import klayout.db as db
    layout = db.Layout()
    layout.read(str(gds))
    top, = layout.top_cells()
    site, row = (round(size / layout.dbu) for size in (known.site_um, known.row_um))
    box = top.bbox()
    die = db.Box(0, 0, box.right // site * site, box.top // row * row)     # wells reach farther
    found = {}
    for wire in known.wires:
        for net, pin in _pins(layout, top, die, wire, known, strap=wire is known.wires[-1]):
            found.setdefault(net, []).append((wire, pin))
    lacking = sorted((set(directions) | set(SUPPLIES)) - set(found))
    if lacking:
        raise ParameterError(f"gds = {gds}: must have metal for the pins {', '.join(lacking[:5])}")

    def rectangles(layer, boxes, indent):
        yield f"{indent}LAYER {names.get((layer.layer, layer.datatype), layer.name)} ;"
        for part in boxes:
            corners = (part.left, part.bottom, part.right, part.top)
            yield f"{indent}  RECT {' '.join(f'{value * layout.dbu:.3f}' for value in corners)} ;"

    lines = ["VERSION 5.8 ;", 'BUSBITCHARS "[]" ;', 'DIVIDERCHAR "/" ;', f"MACRO {top.name}", "  CLASS BLOCK ;",
             f"  SIZE {die.width() * layout.dbu:.3f} BY {die.height() * layout.dbu:.3f} ;", "  SYMMETRY X Y ;"]
    for name in sorted(found):
        direction = directions.get(name, "inout").upper()
        lines += [f"  PIN {name}", f"    DIRECTION {direction} ;", f"    USE {USES.get(name, 'SIGNAL')} ;", "    PORT"]
        for wire, pin in found[name]:
            lines += rectangles(wire, [pin], "      ")
        lines += ["    END", f"  END {name}"]
    lines.append("  OBS")
    keep_off = round(max(known.pin_pitch_um.values()) / layout.dbu)
    for wire in known.wires:
        pins = db.Region([pin for boxes in found.values() for of, pin in boxes if of is wire]).sized(keep_off)
        rest = (db.Region(die) - pins).decompose_trapezoids_to_region(db.Polygon.TD_htrapezoids)
        lines += rectangles(wire, (part.bbox() for part in rest.each()), "    ")
    return "\n".join([*lines, "  END", f"END {top.name}", "END LIBRARY", ""])


def _pins(layout, top, die, wire, known, strap):
    """Pairs (net, Box) of a wire's metal: signals where it reaches the west or east edge, supplies on the straps."""
    import klayout.db as db
    edge = round(EDGE_UM / layout.dbu)
    beyond = die.enlarged(edge, 0)
    bands = db.Region([db.Box(beyond.left, die.bottom, die.left + edge, die.top),
                       db.Box(die.right - edge, die.bottom, beyond.right, die.top)])
    metal = db.Region(top.begin_shapes_rec(layout.layer(wire.layer, wire.datatype))).merged()
    texts = db.Texts(top.shapes(layout.layer(wire.layer, known.pin_datatype)))
    for polygon in metal.each():
        shape = db.Region(polygon)
        for net in sorted({text.string for text in (texts & shape).each()}):
            if net in SUPPLIES:
                if strap:
                    yield net, polygon.bbox() & die
            else:
                for part in (shape & bands).merged().each():
                    pin = part.bbox()
                    if pin.left <= die.left or pin.right >= die.right:
                        yield net, pin & die
