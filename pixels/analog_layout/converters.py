"""All converters in the frame `adc_lanes` of the die: lanes beside each other, a channel to the chip's pins, supplies.

    north     lane_a, lane_b of each lane, at the column amplifiers' pins
              references and vcm across all lanes
              the lanes
              channel: a track for each of the chip's nets, between its pin and the lanes
    south     the chip's pins; refp, refn, vcm, which the die connects to pins of its own

The channel's tracks are on the third metal, what comes from the south on the fourth, from the lanes on the second: nets
meet on no metal. Supplies are straps of the top metal over the lanes, the ground's joined in the
west, the others in the east, where the pins are.
"""

from dataclasses import dataclass, replace

from talbot.base.gds import db
from talbot.models.parameters import ChipParameters, ParameterError
from talbot.pixels.blocks import DIODES, AnalogSizes, Block, Pin, blocks
from talbot.pixels.circuits.dac import BITS
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.footprints import draw_pins, lef
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

from .cells import Cell, new_canvas
from .lane import lane_cell
from .strip import FOURTH, RAIL_AT, SECOND, THIRD, TRACK, TRACK_PITCH, TRUNK

NAME = "adc_lanes"
TOP = 5
# um
INSIDE = 4.0  # of a lane's cell from its place's west end
FIRST_TRACK, APART = 5.0, 1.0  # of the channel from the south; between nets on a track
DOWN = 0.3  # width of what comes from the lanes
REFERENCES, REFERENCE_WIDE, REFERENCE_PITCH, REFERENCE_AWAY = ("refp", "refn", "vcm"), 4.0, 6.0, 10.0
JOGS = 2.0, 3.5  # of lane_a and lane_b above the lanes
STRAP, STRAP_PITCH, SPINE = 4.0, 30.0, (2.0, 13.0)  # of the supplies; of what joins straps from the edge
VIA_PITCH = 1.6
SUPPLIES = {"vdd": "vddc", "vss": "vssa"}


@dataclass(frozen=True)
class Converters:
    """The drawn block. lane: its cell. nets: of the ports of each lane."""

    block: Block
    layout: "db.Layout"
    cell: "db.Cell"
    lane: Cell
    nets: tuple[tuple[str, ...], ...]

    @property
    def count(self) -> int:
        """Transistors."""
        return len(self.nets) * self.lane.count

    def spice(self, masks: AnalogMasks) -> str:
        """Its text for LVS."""
        ports = dict.fromkeys(net for nets in self.nets for net in nets)
        lines = [f"X{k} {' '.join(nets)} {self.lane.cell.name}" for k, nets in enumerate(self.nets)]
        return self.lane.spice(masks) + "\n".join([f".subckt {NAME} {' '.join(ports)}", *lines, f".ends {NAME}", ""])

    def lef(self, masks: AnalogMasks) -> str:
        """Its LEF: all metals taken."""
        return lef(self.block, masks.base.name, AnalogSizes().supply_um, [metal.lef for metal in masks.base.metals])


def frame(chip: ChipParameters, sizes: AnalogSizes) -> Block:
    """The frame, with pins for the references between the chip's in the south."""
    block = next(one for one in blocks(chip=chip, sizes=sizes) if one.name == NAME)
    south = sorted(pin.at_um for pin in block.pins if pin.side == "south")
    extra = []
    for k, name in enumerate(REFERENCES):
        wanted = (k + 1) * sizes.lane_um if chip.lanes > len(REFERENCES) else (k + 1) * block.width_um / 4
        at = min(range(len(south) - 1), key=lambda n: abs((south[n] + south[n + 1]) / 2 - wanted))
        extra.append(Pin(name, "inout", "south", round((south[at] + south[at + 1]) / 2, 2)))
    return replace(block, pins=(*block.pins, *extra))


def lane_nets(lane: int, chip: ChipParameters, ports: tuple[str, ...]) -> tuple[str, ...]:
    """The block's nets at the ports of a lane."""
    index = f"[{lane}]" if chip.lanes > 1 else ""
    own = {f"d{bit}": f"dac[{BITS * lane + bit}]" for bit in range(BITS)}
    own |= {"en": f"en{index}", "comparator": f"comparator{index}"} | SUPPLIES
    own |= {f"lane_{diode}": f"lane_{diode}[{lane}]" for diode in DIODES}
    return tuple(own.get(port, port) for port in ports)


def draw_converters(masks: AnalogMasks, sizes: LaneSizes, chip: ChipParameters, room: AnalogSizes) -> Converters:
    """Draw all lanes in their frame. Raises ParameterError where they do not fit."""
    block, lane = frame(chip, room), lane_cell(masks, sizes, chip=True)
    box = lane.cell.dbbox()
    if box.width() > room.lane_um:
        raise ParameterError(f"lane_um = {room.lane_um:g}: must be {box.width():.2f} at the least, the drawn lane")
    canvas = new_canvas(masks, NAME)
    at = _ports(lane)
    nets = tuple(lane_nets(k, chip, lane.ports) for k in range(chip.lanes))
    rows = _channel(block, at, nets, lane.ports, room)
    south = FIRST_TRACK + TRACK_PITCH * len(rows) + 3.0
    if (need := south + box.height() + REFERENCE_AWAY + REFERENCE_PITCH * 3 + 5) > room.lanes_um:
        raise ParameterError(f"lanes_um = {room.lanes_um:g}: must be {need:.0f} at the least for the drawn lanes")
    _instances(canvas, lane, chip, room, south)
    _draw_channel(canvas, block, rows, at, nets, lane.ports, room, south)
    _north(canvas, block, at, nets, lane.ports, room, south, south + box.height())
    _supplies(canvas, block, lane, chip, room, south)
    draw_pins(canvas.layout, canvas.cell, block, masks.base.name, room.supply_um)
    canvas.box(masks.base.outline, 0, 0, block.width_um, block.height_um)
    return Converters(block, canvas.layout, canvas.cell, lane, nets)


def _ports(lane: Cell) -> dict[str, float]:
    """X of a lane's pins, in its cell, on the fourth metal."""
    process = lane.layout
    found = {}
    for index in process.layer_indexes():
        for shape in lane.cell.shapes(index).each(db.Shapes.STexts):
            found[shape.text_string] = shape.text.x * process.dbu
    return found


def _x(lane: int, at: float, room: AnalogSizes) -> float:
    return lane * room.lane_um + INSIDE + at


Row = list[tuple[str, float, float]]


def _channel(
    block: Block, at: dict[str, float], nets: tuple[tuple[str, ...], ...], ports: tuple[str, ...], room: AnalogSizes
) -> list[Row]:
    """(net, left, right) on every track of the channel: of each net between the chip's pin and the lanes."""
    south = {pin.name: pin.at_um for pin in block.pins if pin.side == "south"}
    spans = {}
    for net, pin in south.items():
        xs = [
            _x(k, at[port], room)
            for k, own in enumerate(nets)
            for port, one in zip(ports, own, strict=True)
            if one == net and net not in REFERENCES
        ]
        if net in REFERENCES:
            xs = [_gap(net, room)]
        if xs:
            spans[net] = min(*xs, pin), max(*xs, pin)
    rows: list[Row] = []
    for net in sorted(spans, key=lambda net: spans[net]):
        left, right = spans[net]
        row = next((row for row in rows if all(right + APART < a or b + APART < left for _, a, b in row)), None)
        if row is None:
            row = []
            rows.append(row)
        row.append((net, left, right))
    return rows


def _gap(net: str, room: AnalogSizes) -> float:
    """X between two lanes at which a reference comes down."""
    return (REFERENCES.index(net) + 1) * room.lane_um


def _instances(canvas: Canvas, lane: Cell, chip: ChipParameters, room: AnalogSizes, y: float) -> None:
    """The lanes, without their pins' names."""
    copy = canvas.layout.create_cell(lane.cell.name)
    copy.copy_tree(lane.cell)
    for index in canvas.layout.layer_indexes():
        texts = list(copy.shapes(index).each(db.Shapes.STexts))
        for shape in texts:
            copy.shapes(index).erase(shape)
    for k in range(chip.lanes):
        where = db.Trans(canvas.snap(_x(k, 0.0, room)), canvas.snap(y))
        canvas.cell.insert(db.CellInstArray(copy.cell_index(), where))


def _draw_channel(
    canvas: Canvas,
    block: Block,
    rows: list[Row],
    at: dict[str, float],
    nets: tuple[tuple[str, ...], ...],
    ports: tuple[str, ...],
    room: AnalogSizes,
    top: float,
) -> None:
    south = {pin.name: pin.at_um for pin in block.pins if pin.side == "south"}
    half = TRACK / 2
    for number, row in enumerate(rows):
        y = FIRST_TRACK + TRACK_PITCH * (number + 0.5)
        for net, left, right in row:
            canvas.wire(THIRD, left - half, y - half, right + half, y + half)
            canvas.wire(FOURTH, south[net] - half, 0, south[net] + half, y + half)
            canvas.stack(south[net], y, THIRD, FOURTH)
            downs = [
                _x(k, at[port], room)
                for k, own in enumerate(nets)
                for port, one in zip(ports, own, strict=True)
                if one == net and net not in REFERENCES
            ]
            for x in [_gap(net, room)] if net in REFERENCES else downs:
                canvas.wire(SECOND, x - DOWN / 2, y - half, x + DOWN / 2, top - 1.2)
                canvas.stack(x, y, SECOND, THIRD)
                canvas.stack(x, top - 1.2, SECOND, FOURTH)
                canvas.wire(THIRD, x - 0.3, top - 1.5, x + 0.3, top - 0.9)
                canvas.wire(FOURTH, x - TRUNK / 2, top - 1.5, x + TRUNK / 2, top + 0.1)


def _north(
    canvas: Canvas,
    block: Block,
    at: dict[str, float],
    nets: tuple[tuple[str, ...], ...],
    ports: tuple[str, ...],
    room: AnalogSizes,
    bottom: float,
    y: float,
) -> None:
    """From the lanes' tops to the pins in the north, and the references across."""
    north = {pin.name: pin.at_um for pin in block.pins if pin.side == "north"}
    half = TRUNK / 2
    for k, own in enumerate(nets):
        for port, net in zip(ports, own, strict=True):
            x = _x(k, at.get(port, 0.0), room)
            if net in north:
                jog, to = y + JOGS[DIODES.index(port[-1])], north[net]
                canvas.wire(FOURTH, x - half, y - 0.1, x + half, jog + half)
                canvas.wire(THIRD, min(x, to) - half, jog - half, max(x, to) + half, jog + half)
                canvas.wire(FOURTH, to - half, jog - half, to + half, block.height_um)
                for end in (x, to):
                    canvas.stack(end, jog, THIRD, FOURTH)
            elif net in REFERENCES:
                across = y + REFERENCE_AWAY + REFERENCE_PITCH * REFERENCES.index(net)
                canvas.wire(FOURTH, x - half, y - 0.1, x + half, across + 1)
                for step in (-0.6, 0.0, 0.6):
                    canvas.stack(x, across + step, THIRD, FOURTH)
    for net in REFERENCES:
        across, x = y + REFERENCE_AWAY + REFERENCE_PITCH * REFERENCES.index(net), _gap(net, room)
        wide = REFERENCE_WIDE / 2
        canvas.wire(THIRD, 3.0, across - wide, block.width_um - 3.0, across + wide)
        for step in (-1.2, -0.6, 0.0, 0.6, 1.2):
            canvas.stack(x, across + step, THIRD, FOURTH)
        canvas.wire(FOURTH, x - 0.5, bottom - 1.5, x + 0.5, across + wide)


def _supplies(canvas: Canvas, block: Block, lane: Cell, chip: ChipParameters, room: AnalogSizes, y: float) -> None:
    """Straps over the lanes, joined in the east and in the west."""
    via, half, width = canvas.process.vias[FOURTH].gds, STRAP / 2, block.width_um
    own = {pin.name: pin.at_um for pin in block.pins if pin.supply}
    box = lane.cell.dbbox()
    right = box.right + box.left  # the cell's ends are as far from the tracks' in the west as in the east
    trunks = {"vss": -RAIL_AT, "vdd": right + RAIL_AT}
    count = int((box.height() - 20) / STRAP_PITCH)
    ys: dict[str, list[float]] = {"vss": [], "vdd": []}
    for n in range(count):
        net = ("vdd", "vss")[n % 2]
        ys[net].append(round(y + 12 + STRAP_PITCH * n, 2))
    for net, heights in ys.items():
        begin, end = (SPINE[0], width - SPINE[1] - 4) if net == "vss" else (SPINE[1] + 4, width - SPINE[0])
        for at_y in heights:
            canvas.wire(TOP, begin, at_y - half, end, at_y + half)
            for k in range(chip.lanes):
                x = _x(k, trunks[net], room)
                canvas.wire(FOURTH, x - 0.6, at_y - half, x + 0.6, at_y + half)
                for step in (-VIA_PITCH / 2, VIA_PITCH / 2):
                    canvas.square(via, x, at_y + step, 0.8)
        pin = own[SUPPLIES[net]]
        reach = [*heights, pin]
        wide = room.supply_um / 2
        x0, x1 = SPINE if net == "vss" else (width - SPINE[1], width - SPINE[0])
        canvas.wire(TOP, x0, min(reach) - wide, x1, max(reach) + wide)
        canvas.wire(TOP, x0, pin - wide, width, pin + wide)
