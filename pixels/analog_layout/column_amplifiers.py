"""The column amplifiers of the die: all columns with their lines, and south of them what drives these.

north     column_a, column_b of each column
          the columns, turned: their strips' lines run from west to east
          band: bank, bias, the ends of the lanes' lines
south     the chip's pins | lane_a, lane_b of each lane | pins of EXTERNAL_PINS and SOURCE

Supplies are straps of the top metal over the columns, in turn the supply's and the ground's; between them, across the
band. The pins in the south-east are none of the black box: the die has pins for them.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import ClassVar

from talbot.base.gds import db
from talbot.models.parameters import ArrayParameters, ChipParameters, ParameterError
from talbot.pixels.analog_layout.cells import new_canvas
from talbot.pixels.analog_layout.column_band import Band, draw_band
from talbot.pixels.analog_layout.column_plan import EXIT_Y, LINE_WIDTH
from talbot.pixels.analog_layout.columns import WAY_END, Columns, column_nets, draw_columns, draw_grounds, draw_way
from talbot.pixels.analog_layout.device import snap
from talbot.pixels.analog_layout.drawn_block import DrawnBlock
from talbot.pixels.analog_layout.row_drivers import TOP, VIA, VIA_PAD, VIA_PITCH, chip_pin
from talbot.pixels.analog_layout.strip import FOURTH
from talbot.pixels.analog_layout.strip_plan import TRUNK
from talbot.pixels.blocks import DEEP_UM, AnalogSizes, Block, Pin, blocks
from talbot.pixels.circuits.column import BIASES
from talbot.pixels.circuits.column_block import BANK_INPUTS, BANK_OUTPUTS
from talbot.pixels.circuits.column_sizes import ColumnSizes
from talbot.pixels.footprints import draw_pins
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

NAME = "column_amplifiers"
# Nets that a column or the band has from outside of the chip; lines across that no column is on
INPUTS, OUTPUTS = ("dark", "reference", "start", "start_a"), (*BIASES, "level")
EXTERNAL_PINS = {**dict.fromkeys(INPUTS, "input"), **dict.fromkeys(OUTPUTS, "output")}
SOURCE = "ibias_columns"
EXTRA = ("turn", "turnn", "turnb", "turnbn", "vbl", "reference", "dark", "ibias")
OUTWARD = (*BANK_OUTPUTS, "ibias", "vbp", "vcp", "vcn", "vbl", "level", "reference", "dark")
NETS = {"vdd": "vddc", "vss": "vssa"}
# um
OVERLAP = 0.3  # of a line and what it meets in the band
PIN_COLUMNS = 4  # columns from the converters to the first pin in the south-east, and between pins
STRAP = 8.0  # width of the top metal's straps over the columns
STRAP_PITCH = 400.0
STRAP_SPACE = 6.0  # between straps of both supplies
EDGE_STRAP = 3.0, 2.5  # width and centre of the supply's first strap in the west
BAND_STRAP_WIDTH = 6.0  # of the straps across the band
BAND_STRAP_Y = {"vss": 27.0, "vdd": 37.0}


@dataclass(frozen=True)
class ColumnAmplifiers(DrawnBlock):
    """The drawn block. columns, band: its parts."""

    boxes: ClassVar[tuple[str, ...]] = ("column",)

    columns: Columns
    band: Band
    lanes: int

    @property
    def count(self) -> int:
        """Transistors."""
        return self.columns.count * self.columns.column.count + self.band.cell.count

    def spice(self, masks: AnalogMasks) -> str:
        """Netlist for LVS; unused pins are no ports."""
        column, band = self.columns.column, self.band.cell
        parts = [(column, column_nets(k, self.lanes)) for k in range(self.columns.count)]
        parts.append((band, band_nets(band.ports, self.lanes)))
        used = {net for _, nets in parts for net in nets}
        ports = dict.fromkeys(pin.name for pin in self.block.pins if pin.name in used)
        lines = [f"X{k} {' '.join(nets)} {cell.cell.name}" for k, (cell, nets) in enumerate(parts)]
        top = [f".subckt {NAME} {' '.join(ports)}", *lines, f".ends {NAME}", ""]
        return column.spice(masks) + band.spice(masks) + "\n".join(top)


def band_nets(ports: Iterable[str], lanes: int) -> tuple[str, ...]:
    """Return the block's nets at the ports of the band."""
    nets = NETS | {name: chip_pin(name) for name in BANK_INPUTS} | {"ibias": SOURCE}
    nets |= {f"lane_{d}{lane}": f"lane_{d}[{lane}]" for d in "ab" for lane in range(lanes)}
    return tuple(nets.get(port, port) for port in ports)


def draw_column_amplifiers(
    masks: AnalogMasks,
    sizes: ColumnSizes,
    array: ArrayParameters,
    chip: ChipParameters,
    room: AnalogSizes | None = None,
) -> ColumnAmplifiers:
    """Draw all columns and their drivers. Raises ParameterError where they do not fit."""
    room = room or AnalogSizes.of(array, chip)
    canvas = new_canvas(masks, NAME)
    columns = draw_columns(canvas.layout, masks, sizes, array, chip.lanes, EXTRA)
    plain = frame(array, chip, room)
    south = {pin.name: pin.at_um for pin in plain.pins if pin.side == "south"}
    nets = {name: chip_pin(name) for name in BANK_INPUTS}
    nets |= {f"lane_{d}{lane}": f"lane_{d}[{lane}]" for d in "ab" for lane in range(chip.lanes)}
    pins = {name: south[pin] for name, pin in nets.items()}
    lanes = [name for name in nets if name.startswith("lane_")]
    band = draw_band(canvas.layout, masks, sizes, array.pitch_um, chip.lanes, pins, (*OUTWARD, *lanes))
    height = snap(band.height - OVERLAP + WAY_END + columns.plan.right)
    block = frame(array, chip, replace(room, columns_um=height))
    turned = Canvas(canvas.layout, "columns_and_ways", masks.base)
    turned.cell.insert(db.CellInstArray(columns.cell.cell_index(), db.Trans()))
    vias: dict[int, list[float]] = {}
    for net, numbers in band.ways.items():
        for k, number in enumerate(numbers):
            xs = draw_way(turned, columns, nets.get(net, net), number, k if net in lanes else None)
            vias.setdefault(number, []).extend(xs)
    for pin in block.pins:
        if pin.name in EXTERNAL_PINS or pin.name == SOURCE:
            number = round(pin.at_um / array.pitch_um)
            xs = draw_way(turned, columns, "ibias" if pin.name == SOURCE else pin.name, number)
            vias.setdefault(number, []).extend(xs)
            canvas.wire(FOURTH, pin.at_um - TRUNK / 2, 0, pin.at_um + TRUNK / 2, band.height)
    draw_grounds(turned, columns, vias)
    for pin in block.pins:
        if pin.side == "north":
            _join(turned, pin, array.pitch_um)
    lying = db.Trans(3, False, 0, canvas.snap(height))
    canvas.cell.insert(db.CellInstArray(turned.cell.cell_index(), lying))
    canvas.cell.insert(db.CellInstArray(band.cell.cell.cell_index(), db.Trans()))
    _supplies(canvas, block, columns, band, room)
    draw_pins(canvas.layout, canvas.cell, block, masks.base.name, room.supply_um)
    canvas.box(masks.base.outline, 0, 0, block.width_um, block.height_um)
    return ColumnAmplifiers(block, canvas.layout, canvas.cell, columns, band, chip.lanes)


def _join(canvas: Canvas, pin: Pin, pitch: float) -> None:
    """A column's line, where it is in the column, and the array's pin."""
    at = pin.at_um // pitch * pitch + EXIT_Y[pin.name.split("[")[0]]
    canvas.wire(FOURTH, 0, min(at, pin.at_um) - LINE_WIDTH / 2, DEEP_UM, max(at, pin.at_um) + LINE_WIDTH / 2)


def frame(array: ArrayParameters, chip: ChipParameters, room: AnalogSizes) -> Block:
    """Return the black box's frame, with pins in the south-east."""
    block = next(candidate for candidate in blocks(array, chip, room) if candidate.name == NAME)
    first = max(pin.at_um for pin in block.pins if pin.side == "south") + room.bias_um + room.lane_um
    number = round(first / array.pitch_um)
    names = {**EXTERNAL_PINS, SOURCE: "input"}
    extra = [
        Pin(name, way, "south", array.pitch_um * (number + PIN_COLUMNS * k))
        for k, (name, way) in enumerate(names.items(), 1)
    ]
    if (end := extra[-1].at_um) > block.width_um:
        raise ParameterError(f"array.cols = {array.cols}: {block.width_um:g} um must have room for pins, {end:g} um")
    return replace(block, pins=(*block.pins, *extra))


def _supplies(canvas: Canvas, block: Block, columns: Columns, band: Band, room: AnalogSizes) -> None:
    """Straps over the columns, in turn; between them across the band; pins to the nearest."""
    width, height, half = block.width_um, block.height_um, room.supply_um / 2
    last = int((width - STRAP_PITCH / 2) / STRAP_PITCH)
    straps = {
        "vdd": [(EDGE_STRAP[1], EDGE_STRAP[0]), *((20.0 + STRAP_PITCH * k, STRAP) for k in range(1, last + 1))],
        "vss": [(20.0 + STRAP_PITCH * (k + 0.5), STRAP) for k in range(last)],
    }
    pins = {(pin.name, pin.side): pin.at_um for pin in block.pins if pin.supply}
    cuts: dict[float, float] = {}
    for net, supply in NETS.items():
        first, final = straps[net][0][0], straps[net][-1][0]
        for side, ends in (("west", (0.0, first + EDGE_STRAP[0] / 2)), ("east", (final - EDGE_STRAP[0] / 2, width))):
            at = pins[supply, side]
            canvas.wire(TOP, ends[0], at - half, ends[1], at + half)
            cuts |= {x: at for x, _ in straps["vdd"] if net == "vss" and ends[0] < x < ends[1]}
    joints = {net: [height - x for x in columns.plan.joints[net]] for net in NETS}
    for net, spans in straps.items():
        others = sorted(x for other, xs in straps.items() if other != net for x, _ in xs)
        for x, wide in spans:
            pieces = [(1.0, height - 1.0)]
            if x in cuts:
                pieces = [(1.0, cuts[x] - half - 2.0), (cuts[x] + half + 2.0, height - 1.0)]
            for low, high in pieces:
                canvas.wire(TOP, x - wide / 2, low, x + wide / 2, high)
            for y in joints[net]:
                if any(low < y < high for low, high in pieces):
                    _vias(canvas, x, y, wide)
            west = max((other for other in others if other < x), default=None)
            east = min((other for other in others if other > x), default=width - 1.0)
            begin = x - wide / 2 if west is None else west + STRAP / 2 + STRAP_SPACE
            if west is not None and west == EDGE_STRAP[1]:
                begin = west + EDGE_STRAP[0] / 2 + 1.7
            y = BAND_STRAP_Y[net]
            canvas.wire(TOP, begin, y - BAND_STRAP_WIDTH / 2, east - STRAP / 2 - STRAP_SPACE, y + BAND_STRAP_WIDTH / 2)
    for net, rails in band.joints.items():
        y = BAND_STRAP_Y[net]
        for x, low, high in rails:
            canvas.wire(
                FOURTH, x - 0.5, min(low, y - BAND_STRAP_WIDTH / 2), x + 0.5, max(high, y + BAND_STRAP_WIDTH / 2)
            )
            canvas.wire(FOURTH, x - VIA_PAD, y - BAND_STRAP_WIDTH / 2, x + VIA_PAD, y + BAND_STRAP_WIDTH / 2)
            for step in (-1, 0, 1):
                canvas.square(canvas.process.vias[FOURTH].gds, x, y + VIA_PITCH * step, VIA)


def _vias(canvas: Canvas, x: float, y: float, wide: float) -> None:
    """Vias of a strap to what joins the columns' rails, in a row along that."""
    count = int((wide - 1.5) / VIA_PITCH) + 1
    for k in range(count):
        canvas.square(canvas.process.vias[FOURTH].gds, snap(x + (k - (count - 1) / 2) * VIA_PITCH), y, VIA)
    canvas.wire(FOURTH, x - wide / 2, y - VIA_PAD, x + wide / 2, y + VIA_PAD)
