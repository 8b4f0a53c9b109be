"""A laid-out cell as a LEF macro for place and route: outline, pins, obstructions, antenna areas.

A pin is all metal of its net, as SkyWater's abstracts have it; every other net's metal is an obstruction. Antenna:
the gate area on an input (W x L), the diffusion area on any signal (LEF 5.8: ANTENNAGATEAREA, ANTENNADIFFAREA).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from talbot.base.gds import db
from talbot.base.lef import write
from talbot.base.lef.write import Rectangles
from talbot.cells.extract.devices import CellLayout, find, read_cell
from talbot.models.parameters import ParameterError, check_choice
from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.layers import DIFFUSION, Via

DIRECTIONS = ("INPUT", "OUTPUT", "INOUT")
USES = ("SIGNAL", "CLOCK", "POWER", "GROUND")


@dataclass(frozen=True)
class PinKind:
    """The kind of a pin; direction: INPUT, OUTPUT or INOUT; use: SIGNAL, CLOCK, POWER or GROUND."""

    direction: str
    use: str = "SIGNAL"

    def __post_init__(self) -> None:
        check_choice("direction", self.direction, DIRECTIONS)
        check_choice("use", self.use, USES)


def abstract(
    gds: str | Path,
    name: str,
    tech: ExtractionPlatform,
    pins: Mapping[str, PinKind],
    site: str,
    kind: str = "CORE",
    vias: Sequence[Via] = (),
) -> str:
    """LEF macro of cell ``name`` in the file ``gds``. pins: in order; site: of its placement; kind: its CLASS.

    vias: those that are drawn, in the pin whose lower layer they are on. Wells and poly are left out: rows take care
    of the first, and nobody routes on the second. Raises ParameterError when a pin has no metal in the cell, or the
    cell no outline.
    """
    layout = find(gds, name, tech)
    outline = _outline(gds, name, tech)
    metals = [layer.lef for layer in tech.conductors if layer.lef != "poly"]
    for via in vias:
        layout.shapes[via.lef] = _by_net(gds, name, via, layout)
    metals += [via.lef for via in vias]
    others = {metal: [layout.shapes[metal][net] for net in layout.shapes[metal] if net not in pins] for metal in metals}
    blocked = {metal: sum(regions, db.Region()) for metal, regions in others.items()}
    head = [f"CLASS {kind}", f"FOREIGN {name}", "ORIGIN 0.000 0.000", write.size(outline.width(), outline.height())]
    head += ["SYMMETRY X Y", f"SITE {site}"]
    obstructions = list(_rectangles(blocked, layout.dbu)) if any(others.values()) else None
    return write.macro(name, head, [_pin(pin, kind, layout, metals) for pin, kind in pins.items()], obstructions)


def _by_net(gds: str | Path, name: str, via: Via, found: CellLayout) -> "dict[str, db.Region]":
    """A cell's vias by the net of the metal below each."""
    layout, cell = read_cell(gds, name)
    drawn = db.Region(cell.begin_shapes_rec(layout.layer(*via.gds))).merged()
    below = [nets for layer in via.below if (nets := found.shapes.get(layer))]
    return {net: drawn.inside(metal.merged()) for nets in below for net, metal in nets.items()}


def _outline(gds: str | Path, name: str, tech: ExtractionPlatform) -> "db.DBox":
    layout, cell = read_cell(gds, name)
    boxes = (db.Region(cell.begin_shapes_rec(layout.layer(*layer))).bbox() for layer in tech.outlines)
    for box in boxes:
        if not box.empty():
            return box.to_dtype(layout.dbu)
    raise ParameterError(f"cell = {name!r}: must have an outline on one of the GDS layers {tech.outlines}")


def _pin(pin: str, kind: PinKind, layout: CellLayout, metals: Sequence[str]) -> write.Pin:
    shapes = {metal: layout.shapes[metal][pin] for metal in metals if pin in layout.shapes[metal]}
    if not shapes:
        raise ParameterError(f"pin = {pin!r}: must be a labelled net with metal in the cell")
    statements = []
    if kind.use in ("SIGNAL", "CLOCK"):
        gates = sum(d.width * d.length for d in layout.devices if d.gate == pin)
        diffusion = layout.shapes[DIFFUSION].get(pin)
        if gates:
            statements.append(f"ANTENNAGATEAREA {gates:.4f}")
        if diffusion:
            statements.append(f"ANTENNADIFFAREA {diffusion.area() * layout.dbu**2:.4f}")
    statements += [f"DIRECTION {kind.direction}", f"USE {kind.use}"]
    if kind.use in ("POWER", "GROUND"):
        statements.append("SHAPE ABUTMENT")
    return write.Pin(pin, statements, list(_rectangles(shapes, layout.dbu)))


def _rectangles(regions: "Mapping[str, db.Region]", dbu: float) -> Iterator[Rectangles]:
    """Rectangles of the regions by layer, sorted; none of an empty one."""
    for metal, region in regions.items():
        boxes = [part.bbox() for part in region.merged().decompose_trapezoids_to_region().each()]
        boxes.sort(key=lambda box: (box.left, box.bottom, box.right, box.top))
        if boxes:
            yield Rectangles(metal, [write.um(box, dbu) for box in boxes])
