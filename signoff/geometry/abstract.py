"""The abstract (LEF) of a block from its GDS: size, pins on edges and straps, obstructions elsewhere."""

import re
from collections.abc import Iterator, Mapping, Sequence, Set
from pathlib import Path
from typing import NamedTuple

from talbot.base.gds import db, read_gds
from talbot.base.lef import write
from talbot.base.lef.write import Rectangles
from talbot.models.parameters import ParameterError
from talbot.platforms.layers import Layer
from talbot.platforms.layout import LayoutPlatform
from talbot.signoff.geometry.antenna import connected
from talbot.signoff.netlist.netlist import SUPPLIES

EDGE_UM = 0.3  # how far from the edge a pin is taken for one
USES = "POWER", "GROUND"  # of supply and ground


class PinArea(NamedTuple):
    """A pin's box on a metal, in database units."""

    metal: Layer
    box: "db.Box"


class Charge(NamedTuple):
    """Antenna areas of a net in um2: its gates, its diffusions, side walls by metal."""

    gate: float
    diffusion: float
    sides: list[tuple[Layer, float]]


def ports(verilog: str) -> dict[str, str]:
    """Pin -> 'input' or 'output' of the first module of a netlist, a bus bit by bit."""
    found = {}
    for direction, high, name in re.findall(r"(?m)^\s*(input|output)\s+(?:\[(\d+):0\]\s+)?(\w+);", verilog):
        names = [f"{name}[{bit}]" for bit in range(int(high) + 1)] if high else [name]
        found |= dict.fromkeys(names, direction)
    return found


def abstract(
    gds: Path, directions: Mapping[str, str], tech: LayoutPlatform, supplies: Sequence[str] = SUPPLIES,
    framed: bool = False,
) -> str:  # fmt: skip
    """Text of the LEF of the GDS's top cell.

    directions: pin -> 'input' or 'output'; the ``supplies`` are pins too. framed: whether the size is the outline's and
    pins are what is drawn as such. Raises ParameterError for a port without metal.
    """
    layout = read_gds(gds)
    (top,) = layout.top_cells()
    site, row = (round(size / layout.dbu) for size in (tech.site_um, tech.row_um))
    box = top.bbox()
    die = db.Box(0, 0, box.right // site * site, box.top // row * row)  # wells reach farther
    if framed:
        die = db.Region(top.shapes(layout.layer(*tech.outline))).bbox()
    found: dict[str, list[PinArea]] = {}
    for metal in tech.metals:
        strap = metal is tech.metals[-1]
        pieces = _marked(layout, top, metal) if framed else _pins(layout, top, die, metal, strap, supplies)
        for net, pin in pieces:
            found.setdefault(net, []).append(PinArea(metal, pin))
    lacking = sorted((set(directions) | set(supplies)) - set(found))
    if lacking:
        raise ParameterError(f"gds = {gds}: must have metal for the pins {', '.join(lacking[:5])}")
    charges = antennas(layout, top, tech, found, set(directions))
    pins, uses = [], dict(zip(supplies, USES, strict=True))
    for name in sorted(found):
        lines = [f"DIRECTION {directions.get(name, 'inout').upper()}", f"USE {uses.get(name, 'SIGNAL')}"]
        lines += _antenna(charges[name]) if name in charges else ()
        boxes = [Rectangles(metal.lef, [write.um(pin, layout.dbu)]) for metal, pin in found[name]]
        pins.append(write.Pin(name, lines, boxes))
    distance, obstructions = round(max(tech.pin_pitch_um.values()) / layout.dbu), []
    for metal in tech.metals:
        near = db.Region()
        for pin in [pin for areas in found.values() for of, pin in areas if of is metal]:
            near.insert(pin)
        rest = (db.Region(die) - near.sized(distance)).decompose_trapezoids_to_region(db.Polygon.TD_htrapezoids)
        obstructions.append(Rectangles(metal.lef, [write.um(part.bbox(), layout.dbu) for part in rest.each()]))
    size = write.size(die.width() * layout.dbu, die.height() * layout.dbu)
    macro = write.macro(top.name, ["CLASS BLOCK", size, "SYMMETRY X Y"], pins, obstructions)
    return write.HEADER + macro + write.END


def antennas(
    layout: "db.Layout", top: "db.Cell", tech: LayoutPlatform, found: Mapping[str, list[PinArea]], signals: Set[str]
) -> dict[str, Charge]:
    """Antenna areas of those nets of the pins ``found`` that are in ``signals``, with all metals connected."""
    nets = next(connected(layout, top, tech, [len(tech.metals) - 1]))

    def area(net: "db.Net", region: "db.Region") -> float:
        """The um2 of a net in ``region``."""
        return nets.l2n.shapes_of_net(net, region, True).merged().area() * layout.dbu**2

    charges = {}
    for name in sorted(signals & set(found)):
        metal, pin = found[name][0]
        net = nets.l2n.probe_net(nets.metals[tech.metals.index(metal)], pin.center())
        if net is not None:
            sides = []
            for of, region in zip(tech.metals, nets.metals, strict=True):
                perimeter = nets.l2n.shapes_of_net(net, region, True).merged().perimeter()
                if side := perimeter * layout.dbu * of.thickness_um:
                    sides.append((of, side))
            charges[name] = Charge(area(net, nets.gate), area(net, nets.diffusion), sides)
    return charges


def _antenna(charge: Charge) -> Iterator[str]:
    """Statements of LEF."""
    for metal, side in charge.sides:
        yield f"ANTENNAPARTIALMETALSIDEAREA {side:.4f} LAYER {metal.lef}"
    if charge.gate:
        yield "ANTENNAMODEL OXIDE1"
        yield f"ANTENNAGATEAREA {charge.gate:.4f}"
    if charge.diffusion:
        yield f"ANTENNADIFFAREA {charge.diffusion:.4f}"


def read_back(
    lef: Path, gds: Path, directions: Mapping[str, str], tech: LayoutPlatform, supplies: Sequence[str] = SUPPLIES
) -> list[str]:
    """What is wrong with the file ``lef`` as KLayout reads it, against ``gds``. Other arguments: see `abstract`.

    Every pin must be on metal of its layer, and all other metal inside the outline under an obstruction or nearer to a
    pin than obstructions come.
    """
    layout, drawn = read_gds(lef), read_gds(gds)
    top = drawn.top_cell()
    macro = layout.cell(top.name)
    layers = {info.name: layout.layer(info) for info in layout.layer_infos()}

    def shapes(name: str) -> "db.Shapes":
        """Shapes on a layer of the LEF."""
        return macro.shapes(layers[name]) if name in layers else db.Shapes()

    wrong, labelled, outline = [], set(), db.Region(shapes("OUTLINE"))
    distance = round(max(tech.pin_pitch_um.values()) / drawn.dbu) + 1
    for layer in tech.metals:
        pins, obstructions = (db.Region(shapes(f"{layer.lef}.{kind}")) for kind in ("PIN", "OBS"))
        metal = db.Region(top.begin_shapes_rec(drawn.layer(*layer.gds))).merged()
        labelled |= {shape.text.string for shape in shapes(f"{layer.lef}.LABEL").each(db.Shapes.STexts)}
        if not (pins - metal).is_empty():
            wrong.append(f"{layer.lef}: a pin where there is no metal")
        if not ((metal & outline) - obstructions - pins.sized(distance)).is_empty():
            wrong.append(f"{layer.lef}: metal that is neither pin nor obstruction")
    if differ := labelled ^ {*directions, *supplies}:
        wrong.append(f"pins that differ: {', '.join(sorted(differ)[:5])}")
    return wrong


def _marked(layout: "db.Layout", top: "db.Cell", layer: Layer) -> Iterator[tuple[str, "db.Box"]]:
    """Pairs (net, box) of what is drawn as a layer's pins."""
    shapes = top.shapes(layout.layer(*layer.pin))
    texts = [shape.text for shape in shapes.each(db.Shapes.STexts)]
    for pin in db.Region(shapes).merged().each():
        for net in sorted({text.string for text in texts if pin.inside(db.Point(text.x, text.y))}):
            yield net, pin.bbox()


def _pins(
    layout: "db.Layout", top: "db.Cell", die: "db.Box", layer: Layer, strap: bool, supplies: Sequence[str]
) -> Iterator[tuple[str, "db.Box"]]:
    """Pairs (net, box) of a layer's metal: signals where it reaches the west or east edge, supplies on the straps."""
    edge = round(EDGE_UM / layout.dbu)
    beyond = die.enlarged(edge, 0)
    bands = db.Region(db.Box(beyond.left, die.bottom, die.left + edge, die.top))
    bands.insert(db.Box(die.right - edge, die.bottom, beyond.right, die.top))
    metal = db.Region(top.begin_shapes_rec(layout.layer(*layer.gds))).merged()
    texts = db.Texts(top.shapes(layout.layer(*layer.pin)))
    for polygon in metal.each():
        shape = db.Region(polygon)
        for net in sorted({text.string for text in (texts & shape).each()}):
            if net in supplies:
                if strap:
                    yield net, polygon.bbox() & die
            else:
                for part in (shape & bands).decompose_trapezoids_to_region(db.Polygon.TD_htrapezoids).each():
                    pin = part.bbox()  # of an L, which a rerouted net may have there, both arms
                    if (pin.left <= die.left or pin.right >= die.right) and (pin & die).area():
                        yield net, pin & die
