"""The abstract (LEF) of a block made from its GDS: size, pins on edges and straps, obstructions elsewhere."""

import re

from flow.layout.geometry.antenna import connected
from flow.layout.netlist.netlist import SUPPLIES
from models.parameters import ParameterError

EDGE_UM = 0.3  # how far from the edge a pin is taken for one
USES = dict(zip(SUPPLIES, ("POWER", "GROUND"), strict=True))


def ports(verilog):
    """dict pin -> 'input' or 'output' of the first module of a netlist, a bus bit by bit."""
    found = {}
    for direction, high, name in re.findall(r"(?m)^\s*(input|output)\s+(?:\[(\d+):0\]\s+)?(\w+);", verilog):
        names = [f"{name}[{bit}]" for bit in range(int(high) + 1)] if high else [name]
        found |= dict.fromkeys(names, direction)
    return found


def abstract(gds, directions, known):
    """Text of the LEF of the GDS's top cell.

    directions: dict pin -> 'input' or 'output'; the supplies are pins too. Raises ParameterError
    for a port without metal.
    """
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(gds))
    (top,) = layout.top_cells()
    site, row = (round(size / layout.dbu) for size in (known.site_um, known.row_um))
    box = top.bbox()
    die = db.Box(0, 0, box.right // site * site, box.top // row * row)  # wells reach farther
    found = {}
    for wire in known.metals:
        for net, pin in _pins(layout, top, die, wire, known, strap=wire is known.metals[-1]):
            found.setdefault(net, []).append((wire, pin))
    charged = antennas(layout, top, known, found, set(directions))
    lacking = sorted((set(directions) | set(SUPPLIES)) - set(found))
    if lacking:
        raise ParameterError(f"gds = {gds}: must have metal for the pins {', '.join(lacking[:5])}")

    def rectangles(layer, boxes, indent):
        yield f"{indent}LAYER {layer.lef} ;"
        for part in boxes:
            corners = (part.left, part.bottom, part.right, part.top)
            yield f"{indent}  RECT {' '.join(f'{value * layout.dbu:.3f}' for value in corners)} ;"

    lines = [
        "VERSION 5.8 ;",
        'BUSBITCHARS "[]" ;',
        'DIVIDERCHAR "/" ;',
        f"MACRO {top.name}",
        "  CLASS BLOCK ;",
        f"  SIZE {die.width() * layout.dbu:.3f} BY {die.height() * layout.dbu:.3f} ;",
        "  SYMMETRY X Y ;",
    ]
    for name in sorted(found):
        direction = directions.get(name, "inout").upper()
        lines += [
            f"  PIN {name}",
            f"    DIRECTION {direction} ;",
            f"    USE {USES.get(name, 'SIGNAL')} ;",
            *_antenna(charged.get(name)),
            "    PORT",
        ]
        for wire, pin in found[name]:
            lines += rectangles(wire, [pin], "      ")
        lines += ["    END", f"  END {name}"]
    lines.append("  OBS")
    keep_off = round(max(known.pin_pitch_um.values()) / layout.dbu)
    for wire in known.metals:
        pins = db.Region([pin for boxes in found.values() for of, pin in boxes if of is wire]).sized(keep_off)
        rest = (db.Region(die) - pins).decompose_trapezoids_to_region(db.Polygon.TD_htrapezoids)
        lines += rectangles(wire, (part.bbox() for part in rest.each()), "    ")
    return "\n".join([*lines, "  END", f"END {top.name}", "END LIBRARY", ""])


def antennas(layout, top, known, found, signals):
    """What the nets of the pins ``found`` gather and bear: dict net -> (um2 of gates, um2 of diffusions, list of
    (Wire, um2 of side walls)), all wires joined. signals: nets that are asked for."""

    nets = next(connected(layout, top, known, [len(known.metals) - 1]))

    def area(net, region):
        return nets.l2n.shapes_of_net(net, region, True).merged().area() * layout.dbu**2

    made = {}
    for name in sorted(signals & set(found)):
        wire, pin = found[name][0]
        net = nets.l2n.probe_net(nets.metals[known.metals.index(wire)], pin.center())
        if net is not None:
            sides = [
                (of, nets.l2n.shapes_of_net(net, metal, True).merged().perimeter() * layout.dbu * of.thickness_um)
                for of, metal in zip(known.metals, nets.metals, strict=True)
            ]
            made[name] = area(net, nets.gate), area(net, nets.diffusion), [(of, side) for of, side in sides if side]
    return made


def _antenna(charged):
    """Lines of LEF. charged: as of `antennas`, or None."""
    gate, diffusion, sides = charged or (0, 0, [])
    for wire, side in sides:
        layer = wire.lef
        yield f"    ANTENNAPARTIALMETALSIDEAREA {side:.4f} LAYER {layer} ;"
    if gate:
        yield "    ANTENNAMODEL OXIDE1 ;"
        yield f"    ANTENNAGATEAREA {gate:.4f} ;"
    if diffusion:
        yield f"    ANTENNADIFFAREA {diffusion:.4f} ;"


def read_back(lef, gds, directions, known):
    """What is wrong with the file ``lef`` as KLayout reads it, against ``gds``: list of str, the rest as `abstract`.

    Every pin must be there, on metal of its layer, and all other metal inside the outline under an obstruction or
    nearer to a pin than obstructions come.
    """
    import klayout.db as db

    layout, drawn = db.Layout(), db.Layout()
    layout.read(str(lef))
    drawn.read(str(gds))
    made, top = layout.cell(drawn.top_cell().name), drawn.top_cell()
    layers = {info.name: layout.layer(info) for info in layout.layer_infos()}

    def shapes(name):
        return made.shapes(layers[name]) if name in layers else db.Shapes()

    wrong, labelled, outline = [], set(), db.Region(shapes("OUTLINE"))
    for wire in known.metals:
        name = wire.lef
        pins, obstructions = (db.Region(shapes(f"{name}.{kind}")) for kind in ("PIN", "OBS"))
        metal = db.Region(top.begin_shapes_rec(drawn.layer(*wire.gds))).merged()
        labelled |= {shape.text.string for shape in shapes(f"{name}.LABEL").each(db.Shapes.STexts)}
        if not (pins - metal).is_empty():
            wrong.append(f"{name}: a pin where there is no metal")
        near = pins.sized(round(max(known.pin_pitch_um.values()) / drawn.dbu) + 1)
        if not ((metal & outline) - obstructions - near).is_empty():
            wrong.append(f"{name}: metal that is neither pin nor obstruction")
    if labelled != set(directions) | set(SUPPLIES):
        wrong.append(f"pins that differ: {', '.join(sorted(labelled ^ (set(directions) | set(SUPPLIES)))[:5])}")
    return wrong


def _pins(layout, top, die, wire, known, strap):
    """Pairs (net, Box) of a wire's metal: signals where it reaches the west or east edge, supplies on the straps."""
    import klayout.db as db

    edge = round(EDGE_UM / layout.dbu)
    beyond = die.enlarged(edge, 0)
    bands = db.Region(
        [
            db.Box(beyond.left, die.bottom, die.left + edge, die.top),
            db.Box(die.right - edge, die.bottom, beyond.right, die.top),
        ]
    )
    metal = db.Region(top.begin_shapes_rec(layout.layer(*wire.gds))).merged()
    texts = db.Texts(top.shapes(layout.layer(*wire.pin)))
    for polygon in metal.each():
        shape = db.Region(polygon)
        for net in sorted({text.string for text in (texts & shape).each()}):
            if net in SUPPLIES:
                if strap:
                    yield net, polygon.bbox() & die
            else:
                for part in (shape & bands).decompose_trapezoids_to_region(db.Polygon.TD_htrapezoids).each():
                    pin = part.bbox()  # of an L, which a rerouted net may have there, both arms
                    if pin.left <= die.left or pin.right >= die.right:
                        yield net, pin & die
