"""All converters in the frame `adc_lanes` of the die: lanes, their amplifiers above them, a bias for all of these.

    north     lane_a, lane_b: of each lane, from the column amplifiers to its amplifier
              the amplifiers                                               | bias
              channel: balance, wake, mode, sub; of each lane its reset, its current, the amplifier's output
              references, vcm and vref across all lanes
              the lanes, whose interface gives the amplifier its reset     | what rises to the amplifiers
              channel: the chip's nets, between their pins and the lanes   |
    south     the chip's pins                                              | refp, refn, vcm, vref

A lane's own reset rises between it and the next. The pins in the south-east are none of the black box: the die has pins
for them. Supplies are straps of the top metal over lanes and amplifiers, the ground's joined in the west, the others in
the east, where the pins are: the ground's line passes between lanes and amplifiers.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from talbot.base.gds import db
from talbot.models.parameters import ChipParameters, ParameterError
from talbot.pixels.analog_layout.amplifier import amplifier_cell
from talbot.pixels.analog_layout.bias import bias_cell
from talbot.pixels.analog_layout.cells import Cell, new_canvas
from talbot.pixels.analog_layout.channel import Channel, up
from talbot.pixels.analog_layout.drawn_block import DrawnBlock
from talbot.pixels.analog_layout.lane import lane_cell
from talbot.pixels.analog_layout.strip import FOURTH, RAIL_AT, SECOND, THIRD
from talbot.pixels.analog_layout.strip_plan import TRUNK
from talbot.pixels.blocks import DIODES, AnalogSizes, Block, Pin, blocks
from talbot.pixels.circuits.amplifier import TRIM_BITS, AmplifierSizes
from talbot.pixels.circuits.dac import BITS
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.footprints import draw_pins
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

NAME = "adc_lanes"
TOP = 5
REFERENCES = "refp", "refn", "vcm", "vref"
# Nets of the chip that rise to the amplifiers; pins of the frame that no circuit is on
RISING = (*(f"balance[{bit}]" for bit in range(TRIM_BITS)), "wake", "mode[1]", "mode[0]", "sub[0]")
UNUSED = "unsigned_", "sub[1]"
# um
CELL_INSET = 4.0  # of a cell from its place's west end
FIRST_TRACK = 5.0  # of the lower channel from the south
FIRST_REFERENCE_RISER = 8.0  # lines to the amplifiers in the east
REFERENCE_RISER_PITCH = 5.0
FIRST_RISER = 32.0
RISER_PITCH = 2.0
REFERENCE_RISER_WIDTH = 2.0
REFERENCE_WIDTH = 4.0
REFERENCE_PITCH = 6.0
REFERENCE_SPACE = 8.0
JOGS = 2.0, 3.5  # of lane_a and lane_b above the amplifiers
NORTH = 6.0  # from the amplifiers to the block's north
STRAP = 4.0  # width of the supplies' straps
STRAP_PITCH = 30.0
SPINE = 2.0, 13.0  # of the metal that joins straps, from the edge
STRAP_INSET = 2.5  # of a strap from its rails' ends
VIA_PITCH = 1.6  # of the supplies' vias
UNDERPASS = 9.0  # of lines that pass below another, over their vias
SUPPLIES = {"vdd": "vddc", "vss": "vssa"}


@dataclass(frozen=True)
class Converters(DrawnBlock):
    """The drawn block. parts: its cells, each with the nets of the ports of its instances."""

    parts: tuple[tuple[Cell, tuple[tuple[str, ...], ...]], ...]

    @property
    def count(self) -> int:
        """Transistors."""
        return sum(cell.count * len(nets) for cell, nets in self.parts)

    def spice(self, masks: AnalogMasks) -> str:
        """Netlist for LVS."""
        ports = dict.fromkeys(pin.name for pin in self.block.pins if pin.name not in UNUSED)
        lines = [
            f"X{cell.cell.name}{k} {' '.join(instance_nets)} {cell.cell.name}"
            for cell, nets in self.parts
            for k, instance_nets in enumerate(nets)
        ]
        top = [f".subckt {NAME} {' '.join(ports)}", *lines, f".ends {NAME}", ""]
        return "".join(cell.spice(masks) for cell, _ in self.parts) + "\n".join(top)


def frame(chip: ChipParameters, sizes: AnalogSizes) -> Block:
    """Return the frame, with pins for the references in the south-east."""
    block = next(candidate for candidate in blocks(chip=chip, sizes=sizes) if candidate.name == NAME)
    extra = (Pin(name, "inout", "south", rise(name, chip, sizes)) for name in REFERENCES)
    return replace(block, pins=(*block.pins, *extra))


def rise(net: str, chip: ChipParameters, sizes: AnalogSizes) -> float:
    """X at which a net rises east of the lanes."""
    east = chip.lanes * sizes.lane_um
    if net in REFERENCES:
        return east + FIRST_REFERENCE_RISER + REFERENCE_RISER_PITCH * REFERENCES.index(net)
    return east + FIRST_RISER + RISER_PITCH * RISING.index(net)


def lane_nets(lane: int, chip: ChipParameters, ports: tuple[str, ...]) -> tuple[str, ...]:
    """Return the block's nets at the ports of a lane."""
    index = f"[{lane}]" if chip.lanes > 1 else ""
    nets = {f"d{bit}": f"dac[{BITS * lane + bit}]" for bit in range(BITS)}
    nets |= {"en": f"en{index}", "comparator": f"comparator{index}"} | SUPPLIES
    nets |= {"lane_a": f"out_{lane}", "lane_b": "vref", "reset": f"reset_{lane}"}
    return tuple(nets.get(port, port) for port in ports)


def amplifier_nets(lane: int, ports: tuple[str, ...]) -> tuple[str, ...]:
    """Return the block's nets at the ports of the amplifier of a lane."""
    nets = {f"g{bit}": f"balance[{bit}]" for bit in range(TRIM_BITS)}
    nets |= {f"column_{diode}": f"lane_{diode}[{lane}]" for diode in DIODES} | SUPPLIES
    nets |= {"out": f"out_{lane}", "reset": f"reset_{lane}", "ibias": f"ibias_{lane}"}
    nets |= {"mode1": "mode[1]", "mode0": "mode[0]", "sub0": "sub[0]"}
    return tuple(nets.get(port, port) for port in ports)


@dataclass(frozen=True)
class Placed:
    """An instance: its cell, the block's nets at its ports, its place, um."""

    cell: Cell
    nets: tuple[str, ...]
    x: float
    y: float

    def ends(self) -> Iterator[tuple[str, float]]:
        """(net, x) of its pins."""
        at = _ports(self.cell)
        for port, net in zip(self.cell.ports, self.nets, strict=True):
            if port not in SUPPLIES:
                yield net, self.x + at[port]


def draw_converters(
    masks: AnalogMasks, sizes: LaneSizes, amplifier: AmplifierSizes, chip: ChipParameters, room: AnalogSizes
) -> Converters:
    """Draw all lanes and amplifiers in their frame. Raises ParameterError where they do not fit."""
    block = frame(chip, room)
    lane, above = lane_cell(masks, sizes, chip=True), amplifier_cell(masks, amplifier, chip=True)
    bias = bias_cell(masks, chip.lanes)
    for cell, most, name in ((lane, room.lane_um, "lane"), (above, room.lane_um, "lane"), (bias, room.bias_um, "bias")):
        if (need := cell.cell.dbbox().width()) > most:
            raise ParameterError(f"{name}_um = {most:g}: must be {need:.2f} at the least, the drawn {cell.cell.name}")
    canvas = new_canvas(masks, NAME)
    ground = next(pin.at_um for pin in block.pins if pin.name == "vssa")
    top = ground - REFERENCE_SPACE  # of the lanes
    low = top - lane.cell.dbbox().height()
    lanes = [Placed(lane, lane_nets(k, chip, lane.ports), _x(k, room), low) for k in range(chip.lanes)]
    straps = {net: top + REFERENCE_SPACE + REFERENCE_PITCH * k for k, net in enumerate(REFERENCES)}
    south = _south(block, lanes, chip, room)
    middle = top + REFERENCE_SPACE + REFERENCE_PITCH * len(REFERENCES)
    east = chip.lanes * room.lane_um
    currents = tuple(f"ibias_{k}" for k in range(chip.lanes)) + tuple(SUPPLIES.values())
    amplifiers = [Placed(above, amplifier_nets(k, above.ports), _x(k, room), 0.0) for k in range(chip.lanes)]
    biased = Placed(bias, currents, east + CELL_INSET - bias.cell.dbbox().left, 0.0)
    channel = _middle(middle, lanes, amplifiers, biased, block, chip, room)
    amplifiers = [replace(cell_instance, y=channel.top) for cell_instance in amplifiers]
    biased = replace(biased, y=channel.top)
    need = channel.top + above.cell.dbbox().height() + NORTH + max(0.0, south.top - low)
    if need > room.lanes_um or south.top > low:
        raise ParameterError(f"lanes_um = {room.lanes_um:g}: must be greater, {need:.0f} or more, for the drawn lanes")
    _instances(canvas, [*lanes, *amplifiers, biased])
    south.draw(canvas, 0.0, _rising(south, lanes, low, middle, block, chip, room))
    channel.draw(canvas, top - 0.1)
    _references(canvas, lanes, amplifiers, straps, top, channel.top, chip, room)
    _north(canvas, block, amplifiers)
    _supplies(canvas, block, lanes, [*amplifiers, biased], room)
    draw_pins(canvas.layout, canvas.cell, block, masks.base.name, room.supply_um)
    canvas.box(masks.base.outline, 0, 0, block.width_um, block.height_um)
    parts = ((lane, lanes), (above, amplifiers), (bias, [biased]))
    return Converters(
        block,
        canvas.layout,
        canvas.cell,
        tuple((cell, tuple(instance.nets for instance in placed)) for cell, placed in parts),
    )


def _ports(cell: Cell) -> dict[str, float]:
    """Return x of a cell's pins, on the fourth metal."""
    xs = {}
    for index in cell.layout.layer_indexes():
        for shape in cell.cell.shapes(index).each(db.Shapes.STexts):
            xs[shape.text_string] = shape.text.x * cell.layout.dbu
    return xs


def _x(lane: int, room: AnalogSizes) -> float:
    return lane * room.lane_um + CELL_INSET


def _gap(lane: int, room: AnalogSizes) -> float:
    """X between a lane and its neighbour in the east."""
    return (lane + 1) * room.lane_um


def _south(block: Block, lanes: list[Placed], chip: ChipParameters, room: AnalogSizes) -> Channel:
    """Return the channel between the chip's pins and the lanes, with the lines to the amplifiers."""
    pins = {pin.name: [pin.at_um] for pin in block.pins if pin.side == "south"}
    above: dict[str, list[float]] = {}
    for number, lane in enumerate(lanes):
        for net, x in lane.ends():
            if net in pins and net not in REFERENCES or net.startswith("reset_"):
                above.setdefault(net, []).append(x)
        above[f"reset_{number}"].append(_gap(number, room))
    above |= {net: [rise(net, chip, room)] for net in RISING}
    return Channel(FIRST_TRACK, {net: xs for net, xs in pins.items() if net in above}, above)


def _rising(
    south: Channel,
    lanes: list[Placed],
    low: float,
    middle: float,
    block: Block,
    chip: ChipParameters,
    room: AnalogSizes,
) -> dict[float, float]:
    """Y up to which what is above the lower channel leads, by x: to the lanes, or to the upper channel."""
    ends = {x: low + 0.1 for xs in south.above.values() for x in xs}
    high = [rise(net, chip, room) for net in RISING]
    return ends | dict.fromkeys([*high, *(_gap(k, room) for k in range(len(lanes)))], middle + 0.1)


def _middle(
    y: float,
    lanes: list[Placed],
    amplifiers: list[Placed],
    bias: Placed,
    block: Block,
    chip: ChipParameters,
    room: AnalogSizes,
) -> Channel:
    """Return the channel between the lanes and the amplifiers."""
    below: dict[str, list[float]] = {net: [rise(net, chip, room)] for net in RISING}
    below |= {f"reset_{k}": [_gap(k, room)] for k in range(len(lanes))}
    below |= {net: [x] for lane in lanes for net, x in lane.ends() if net.startswith("out_")}
    above: dict[str, list[float]] = {}
    for instance in (*amplifiers, bias):
        for net, x in instance.ends():
            if net in below or net.startswith("ibias_"):
                above.setdefault(net, []).append(x)
    return Channel(y, below, above)


def _instances(canvas: Canvas, placed: list[Placed]) -> None:
    """The cells, without their pins' names."""
    copies: dict[str, db.Cell] = {}
    for instance in placed:
        name = instance.cell.cell.name
        if name not in copies:
            copies[name] = canvas.layout.create_cell(name)
            copies[name].copy_tree(instance.cell.cell)
            for index in canvas.layout.layer_indexes():
                for shape in list(copies[name].shapes(index).each(db.Shapes.STexts)):
                    copies[name].shapes(index).erase(shape)
        where = db.Trans(canvas.snap(instance.x), canvas.snap(instance.y))
        canvas.cell.insert(db.CellInstArray(copies[name].cell_index(), where))


def _references(
    canvas: Canvas,
    lanes: list[Placed],
    amplifiers: list[Placed],
    straps: Mapping[str, float],
    bottom: float,
    top: float,
    chip: ChipParameters,
    room: AnalogSizes,
) -> None:
    """Straps across all lanes from what rises in the east; the lanes below, the amplifiers' vref above."""
    half = TRUNK / 2
    for net, y in straps.items():
        x, wide = rise(net, chip, room), REFERENCE_WIDTH / 2
        canvas.wire(THIRD, 3.0, y - wide, x + wide, y + wide)
        for step in (-1.2, -0.6, 0.0, 0.6, 1.2):
            for aside in (-0.6, 0.0, 0.6):
                canvas.stack(x + aside, y + step, THIRD, FOURTH)
        canvas.wire(FOURTH, x - REFERENCE_RISER_WIDTH / 2, 0.0, x + REFERENCE_RISER_WIDTH / 2, y + wide)
    for lane in lanes:
        for net, x in lane.ends():
            if net in straps:
                y = straps[net]
                canvas.wire(FOURTH, x - half, bottom - 0.1, x + half, y + 1)
                for step in (-0.6, 0.0, 0.6):
                    canvas.stack(x, y + step, THIRD, FOURTH)
    for amplifier in amplifiers:
        for net, x in amplifier.ends():
            if net in straps:
                y, high = straps[net], top - 1.2
                canvas.wire(SECOND, x - half, y - 1, x + half, high + 0.2)
                for step in (-0.6, 0.0, 0.6):
                    canvas.stack(x, y + step, SECOND, THIRD)
                up(canvas, x, high)
                canvas.wire(FOURTH, x - half, high - 0.3, x + half, top + 0.1)


def _north(canvas: Canvas, block: Block, amplifiers: list[Placed]) -> None:
    """Draw the lines from the amplifiers to the pins in the north."""
    north, half = {pin.name: pin.at_um for pin in block.pins if pin.side == "north"}, TRUNK / 2
    for amplifier in amplifiers:
        y = amplifier.y + amplifier.cell.cell.dbbox().top
        for net, x in amplifier.ends():
            if net in north:
                jog, to = y + JOGS[DIODES.index(net[len("lane_")])], north[net]
                canvas.wire(FOURTH, x - half, y - 0.1, x + half, jog + half)
                canvas.wire(THIRD, min(x, to) - half, jog - half, max(x, to) + half, jog + half)
                canvas.wire(FOURTH, to - half, jog - half, to + half, block.height_um)
                for end in (x, to):
                    canvas.stack(end, jog, THIRD, FOURTH)


def _rails(instance: Placed) -> dict[str, tuple[float, float, float]]:
    """(x, low, high) of what joins a cell's rails, by supply."""
    box, rails = instance.cell.cell.dbbox(), {}
    metals = [
        shape.dbbox()
        for index in instance.cell.layout.layer_indexes()
        for shape in instance.cell.cell.shapes(index).each(db.Shapes.SBoxes)
    ]
    edge = -box.left  # the cell's ends are as far from the tracks' in the west as in the east
    for net, x in (("vss", box.left + edge - RAIL_AT), ("vdd", box.right - edge + RAIL_AT)):
        trunk = max(
            (shape for shape in metals if abs(shape.center().x - x) < 0.01 and shape.width() < 1.1),
            key=lambda shape: shape.height(),
        )
        rails[net] = instance.x + x, instance.y + trunk.bottom, instance.y + trunk.top
    return rails


def _supplies(canvas: Canvas, block: Block, lanes: list[Placed], upper: list[Placed], room: AnalogSizes) -> None:
    """Straps over lanes, amplifiers and bias, joined in the east and in the west."""
    via, half, width = canvas.process.vias[FOURTH].gds, STRAP / 2, block.width_um
    heights: dict[str, list[list[float]]] = {"vss": [], "vdd": []}
    for row in (lanes, upper):
        rails = [_rails(instance) for instance in row]
        low = max(bottom for spans in rails[:-1] or rails for _, bottom, _ in spans.values()) + STRAP_INSET
        high = min(top for spans in rails[:-1] or rails for _, _, top in spans.values()) - STRAP_INSET
        ys = [round(low + STRAP_PITCH * n, 2) for n in range(int((high - low) / STRAP_PITCH) + 1)]
        for k, net in enumerate(("vdd", "vss")):
            heights[net].append(ys[k::2])
            begin, end = (SPINE[0], width - SPINE[1] - 4) if net == "vss" else (SPINE[1] + 4, width - SPINE[0])
            for y in ys[k::2]:
                canvas.wire(TOP, begin, y - half, end, y + half)
            for spans in rails:
                x, bottom, top = spans[net]
                near = [y for y in ys[k::2] if bottom < y < top] or [min(ys[k::2], key=lambda y: abs(y - top))]
                canvas.wire(FOURTH, x - 0.6, min(bottom, near[0] - half), x + 0.6, max(top, near[-1] + half))
                for y in near:
                    for step in (-VIA_PITCH / 2, VIA_PITCH / 2):
                        canvas.square(via, x, y + step, 0.8)
    pins = [(pin.name, pin.at_um) for pin in block.pins if pin.supply]
    wide = room.supply_um / 2
    for net, rows in heights.items():
        xs = [at for name, at in pins if name == SUPPLIES[net]]
        x0, x1 = SPINE if net == "vss" else (width - SPINE[1], width - SPINE[0])
        joined = [[y for row in rows for y in row]] if net == "vss" else rows
        for ys, at in zip(joined, xs, strict=True):
            canvas.wire(TOP, x0, min(*ys, at) - wide, x1, max(*ys, at) + wide)
            canvas.wire(TOP, x0, at - wide, width, at + wide)
        if net == "vdd":  # below the ground's line
            ends = max(*rows[0], xs[0]) + wide, min(*rows[1], xs[1]) - wide
            canvas.wire(FOURTH, x0 + 1, ends[0] - UNDERPASS, x1 - 1, ends[1] + UNDERPASS)
            for y in (ends[0] - UNDERPASS / 2, ends[1] + UNDERPASS / 2):
                for across in range(-2, 3):
                    for step in range(-2, 3):
                        canvas.square(via, (x0 + x1) / 2 + VIA_PITCH * across, y + VIA_PITCH * step, 0.8)
