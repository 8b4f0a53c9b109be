"""Which boxes of a layout are which net, pin and port of the netlist."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from talbot.base.gds import db
from talbot.base.steps import StepError
from talbot.platforms.layout import LayoutPlatform
from talbot.signoff.geometry.instances import transformation
from talbot.signoff.netlist.netlist import Netlist
from talbot.signoff.parasitics.shapes import Labels, Shapes, labels

Pin = tuple[str, str]  # instance and its pin, or "" and a port's bit


@dataclass(frozen=True)
class Place:
    """A pin on the layout. cell: its cell, "" for a port. box: in Shapes.boxes. at: dbu."""

    pin: Pin
    cell: str
    box: int
    at: tuple[int, int]


def places(
    netlist: Netlist, placement: Path, layout: "db.Layout", tech: LayoutPlatform, shapes: Shapes
) -> dict[str, list[Place]]:
    """Every net's pins and ports, by the texts in the cells and in the top cell.

    placement: JSON of `stream_out.placement`. Raises StepError for a pin without metal, and for a net whose pins the
    layout does not connect.
    """
    found: dict[str, list[Place]] = {}
    for net, pin, cell, at in _texts(netlist, placement, layout, tech):
        boxes = [(shapes.at(*point), point) for point in at]
        box, point = next((pair for pair in boxes if pair[0] >= 0), (-1, (0, 0, 0)))
        if box < 0:
            raise StepError(f"extraction: {'.'.join(filter(None, pin))} has no metal under its label")
        found.setdefault(net, []).append(Place(pin, cell, box, point[1:]))
    numbers: dict[int, str] = {}
    for net, ends in found.items():
        own = {int(shapes.nets[end.box]) for end in ends}
        if len(own) > 1 or numbers.setdefault(min(own), net) != net:
            raise StepError(f"extraction: the layout does not connect {net} as the netlist does")
    return found


def _texts(
    netlist: Netlist, placement: Path, layout: "db.Layout", tech: LayoutPlatform
) -> Iterator[tuple[str, Pin, str, list[tuple[int, int, int]]]]:
    """(net, pin, cell, [(level, x, y)]) of every pin and port."""
    placed = json.loads(placement.read_text(encoding="utf-8"))["instances"]
    cells: dict[str, Labels] = {}
    for instance, (_, cell, x, y, orientation) in zip(netlist.instances, placed, strict=True):
        if not instance.pins:
            continue
        trans = transformation(layout, x, y, orientation)
        if cell not in cells:
            cells[cell] = labels(layout, layout.cell(cell), tech)
        for pin, net in instance.pins.items():
            points = [(level, trans * db.Point(*at)) for level, *at in cells[cell].get(pin, ())]
            yield net, (instance.name, pin), cell, [(level, point.x, point.y) for level, point in points]
    ports = labels(layout, layout.top_cell(), tech)
    for port in netlist.ports:
        for bit in port.bits():
            yield bit, ("", bit), "", ports.get(bit, [])
