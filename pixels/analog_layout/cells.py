"""Whole cells: strips joined by their rails, with pins, an outline and their circuit."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

from talbot.base.gds import db, write_gds
from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.comparator import comparator_plans, devices, draw_comparator, least_half
from talbot.pixels.analog_layout.device import Device, Strap
from talbot.pixels.analog_layout.strip import RAIL_ENDS, THIRD, Strip, Terminal, join_rails
from talbot.pixels.circuits.comparator import ComparatorSizes, comparator
from talbot.pixels.circuits.netlist import Resistor, Transistor
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

MARGIN = 2.0  # of a cell beyond its rails, um


@dataclass(frozen=True)
class Cell:
    """A drawn cell.

    boxes: cells in it that LVS compares separately: none.
    ports: in the order of its pins.
    devices: its transistors in fingers.
    plates: its capacitors.
    terminals: of its transistors.
    taps: of its capacitors, as in `Array`, under the names of ``plates``.
    tracks: of its nets, for a cell with one strip.
    matched: units of fringe capacitors between two nets, names in alphabetical order.
    unit: F of such a unit.
    resistors, ends: drawn resistors and their ends.
    """

    boxes: ClassVar[tuple[str, ...]] = ()
    layout: "db.Layout"
    cell: "db.Cell"
    ports: tuple[str, ...]
    devices: tuple[Device, ...]
    plates: tuple[flat.Plate, ...] = ()
    terminals: tuple[Terminal, ...] = ()
    taps: tuple[flat.Tap, ...] = ()
    tracks: tuple[Strap, ...] = ()
    matched: Mapping[tuple[str, str], int] = field(default_factory=dict)
    unit: float = 0.0
    resistors: tuple[Resistor, ...] = ()
    ends: tuple[flat.Ends, ...] = ()

    @property
    def transistors(self) -> list[Transistor]:
        """All transistors, dummies too."""
        return [t for device in self.devices for t in (device.transistor, *device.off)]

    @property
    def count(self) -> int:
        """Transistors."""
        return len(self.transistors)

    def spice(self, masks: AnalogMasks) -> str:
        """Netlist for LVS."""
        return flat.spice(
            self.cell.name, self.ports, self.transistors, masks, self.plates, self.resistors, self.matched
        )

    def write(self, path: Path) -> None:
        """Write its GDS."""
        write_gds(self.layout, path, self.cell)


def new_canvas(masks: AnalogMasks, name: str) -> Canvas:
    """Return an empty cell in a new layout."""
    layout = db.Layout()
    layout.dbu = 0.001
    return Canvas(layout, name, masks.base)


def comparator_cell(masks: AnalogMasks, sizes: ComparatorSizes) -> Cell:
    """Return the comparator alone; its pins are at the west ends of its tracks."""
    canvas, circuit, axis = new_canvas(masks, "comparator"), comparator(sizes), 40.0
    drawn = devices(circuit)
    half = least_half(comparator_plans(drawn, axis, (0, 2 * axis))) + 0.6
    strips = draw_comparator(canvas, masks, comparator_plans(drawn, axis, (axis - half, axis + half)), MARGIN)
    finish(canvas, strips, circuit.ports[:4])
    ends = tuple(terminal for strip in strips for terminal in strip.terminals)
    return Cell(canvas.layout, canvas.cell, circuit.ports, tuple(drawn.values()), terminals=ends)


def finish(canvas: Canvas, strips: Sequence[Strip], pins: Iterable[str]) -> None:
    """Join the rails, put the pins on the first piece of a track of their nets, draw the outline."""
    join_rails(canvas, strips)
    for net in pins:
        track = next(track for strip in strips for track in strip.tracks if track.net == net)
        canvas.label(THIRD, net, track.left + 0.3, track.y)
    plan = strips[0].plan
    bottom, top = strips[0].y, strips[-1].y + strips[-1].plan.height_um
    ends = plan.left - RAIL_ENDS - MARGIN, plan.right + RAIL_ENDS + MARGIN
    canvas.box(canvas.process.outline, ends[0], bottom - MARGIN, ends[1], top + MARGIN)
