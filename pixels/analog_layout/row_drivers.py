"""The drivers of all rows in the die's frame `row_driver`: a column of rows at the pixels' pitch, a bank in the south.

west     supplies, each on the top metal to what joins the rows' rails
         row 0
         ...                                                         its lines, at the array's pins    east
         the last row
         bank: predecoders and buffers
south    the chip's pins
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

from talbot.base.gds import db
from talbot.models.parameters import ArrayParameters, ParameterError
from talbot.pixels.analog_layout.cells import Cell, new_canvas
from talbot.pixels.analog_layout.comparator import devices
from talbot.pixels.analog_layout.device import Device, snap
from talbot.pixels.analog_layout.drawn_block import DrawnBlock
from talbot.pixels.analog_layout.row_bank import draw_bank
from talbot.pixels.analog_layout.row_driver import LINE_WIDTH, RowPlan, as_cell, draw_row, row_plan
from talbot.pixels.analog_layout.strip import FOURTH, RAIL_ENDS, THIRD, name_track
from talbot.pixels.blocks import AnalogSizes, Block, row_driver
from talbot.pixels.circuits.row_driver import (
    BANK_INPUTS,
    BANK_OUTPUTS,
    CODES,
    CONTROLS,
    ROW_INPUTS,
    ROW_LINES,
    SIDES,
    SUPPLIES,
    row,
    taken,
)
from talbot.pixels.drawn import check_pitch
from talbot.pixels.footprints import draw_pins
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

NAME = "row_driver"
TOP = 5
NETS = {"vdd": "vddc", "vddr": "vddr", "vss": "vssa"}
JOINTS = {"vddc": ("vdd",), "vddr": ("vddr",), "vssa": ("vss", "vss_thick")}
VIA = 0.8  # um, the top metal's via
VIA_PITCH = 1.6  # um
VIA_PAD = 0.59  # um, half of its pad below


@dataclass(frozen=True)
class RowDrivers(DrawnBlock):
    """The drawn block. row, bank: its cells. rows: how many."""

    boxes: ClassVar[tuple[str, ...]] = ("row",)

    row: Cell
    bank: Cell
    rows: int

    @property
    def count(self) -> int:
        """Transistors."""
        return self.rows * self.row.count + self.bank.count

    def spice(self, masks: AnalogMasks) -> str:
        """Netlist for LVS."""
        ports = list(dict.fromkeys(pin.name for pin in self.block.pins))
        lines = [f"X{k} {' '.join(row_nets(k, self.rows))} {self.row.cell.name}" for k in range(self.rows)]
        lines.append(f"Xbank {' '.join(bank_nets())} {self.bank.cell.name}")
        top = [f".subckt {NAME} {' '.join(ports)}", *lines, f".ends {NAME}", ""]
        return self.row.spice(masks) + self.bank.spice(masks) + "\n".join(top)


def chip_pin(name: str) -> str:
    """Return the block's pin of an input of the bank: amp_row3 is amp_row[3]."""
    return f"{name.rstrip('0123456789')}[{name[len(name.rstrip('0123456789')) :]}]" if name[-1].isdigit() else name


def row_nets(number: int, rows: int) -> tuple[str, ...]:
    """Return the block's nets at the ports of a row."""
    codes = taken(number)
    nets = {f"{side}_{group}": f"{side}_{group}{code}" for side in SIDES for group, code in codes.items()}
    nets |= {name: f"{name}_line" for name in CONTROLS}
    nets |= {name: f"{name}[{number}]" for name in ROW_LINES} | NETS
    return tuple(nets[port] for port in (*ROW_INPUTS, *ROW_LINES, *SUPPLIES))


def bank_nets() -> tuple[str, ...]:
    """Return the block's nets at the ports of the bank."""
    return (*map(chip_pin, BANK_INPUTS), *BANK_OUTPUTS, NETS["vdd"], NETS["vss"])


def _plan(d: Mapping[str, Device], array: ArrayParameters, room: AnalogSizes) -> tuple[Block, RowPlan]:
    """Return the frame as the black box has it, and a row in it."""
    plain = row_driver(array, room)
    south = {pin.name: pin.at_um for pin in plain.pins if pin.side == "south"}
    return plain, row_plan(d, plain.width_um, array.pitch_um, {name: south[chip_pin(name)] for name in BANK_INPUTS})


def row_cell(masks: AnalogMasks, array: ArrayParameters) -> Cell:
    """Return a row alone, its pins named on its tracks: what is extracted and simulated."""
    d, canvas = devices(row()), new_canvas(masks, "row")
    _, plan = _plan(d, array, AnalogSizes())
    cell = as_cell(canvas, d, draw_row(canvas, masks, plan))
    _names(canvas, cell)
    canvas.box(masks.base.outline, plan.logic.left - RAIL_ENDS, 0, plan.right, plan.pitch)
    return cell


def _names(canvas: Canvas, cell: Cell) -> None:
    """A row's ports, each on its track."""
    for track in cell.tracks:
        if track.net in cell.ports:
            name_track(canvas, track)


def draw_row_drivers(masks: AnalogMasks, array: ArrayParameters, room: AnalogSizes | None = None) -> RowDrivers:
    """Draw all rows in their frame. Raises ParameterError where they do not fit, or the bank has too few lines."""
    room = room or AnalogSizes()
    check_pitch(array.pitch_um)
    if taken(array.rows - 1)["high"] >= CODES["high"]:
        raise ParameterError(f"rows = {array.rows}: must be at most {64 * CODES['high']} for the drawn bank")
    d = devices(row())
    plain, plan = _plan(d, array, room)
    canvas = new_canvas(masks, NAME)
    bank_canvas, row_canvas = (Canvas(canvas.layout, name, masks.base) for name in ("row_bank", "row"))
    bank, height = draw_bank(bank_canvas, masks, plan)
    row_cell_drawn = as_cell(row_canvas, d, draw_row(row_canvas, masks, plan))
    _names(row_canvas, row_cell_drawn)
    moved = (pin if pin.side == "south" else replace(pin, at_um=pin.at_um + height) for pin in plain.pins)
    block = Block(NAME, plain.width_um, round(plain.height_um + height, 3), tuple(moved))
    x, y, pitch = canvas.snap(plan.west), canvas.snap(height), canvas.snap(plan.pitch)
    canvas.cell.insert(db.CellInstArray(bank.cell.cell_index(), db.Trans(x, 0)))
    step = db.Vector(0, pitch)
    canvas.cell.insert(
        db.CellInstArray(row_cell_drawn.cell.cell_index(), db.Trans(x, y), step, db.Vector(1, 0), array.rows, 1)
    )
    _lines(canvas, plan, row_cell_drawn, height, array.rows)
    _supplies(canvas, block, plan, height, room)
    draw_pins(canvas.layout, canvas.cell, block, masks.base.name, room.supply_um)
    canvas.box(masks.base.outline, 0, 0, block.width_um, block.height_um)
    return RowDrivers(block, canvas.layout, canvas.cell, row_cell_drawn, bank, array.rows)


def _lines(canvas: Canvas, plan: RowPlan, row: Cell, south: float, rows: int) -> None:
    """Predecoded lines across all rows, and each row's vias to its own."""
    via = Canvas(canvas.layout, "row_code", canvas.process)
    via.stack(0, 0, THIRD, FOURTH)
    tracks = {track.net: track.y for track in row.tracks}
    for side in SIDES:
        for group, count in CODES.items():
            for code in range(count):
                x = plan.west + plan.lines[f"{side}_{group}{code}"]
                canvas.wire(FOURTH, x - LINE_WIDTH / 2, south, x + LINE_WIDTH / 2, south + rows * plan.pitch)
    for number in range(rows):
        for group, code in taken(number).items():
            for side in SIDES:
                x = plan.west + plan.lines[f"{side}_{group}{code}"]
                y = south + (rows - 1 - number) * plan.pitch + tracks[f"{side}_{group}"]
                at = db.Trans(canvas.snap(x), canvas.snap(y))
                canvas.cell.insert(db.CellInstArray(via.cell.cell_index(), at))


def _supplies(canvas: Canvas, block: Block, plan: RowPlan, south: float, room: AnalogSizes) -> None:
    """Draw the supplies from each west pin to the joints of the rows' rails, across the bank where it has none."""
    via, half = canvas.process.vias[FOURTH].gds, room.supply_um / 2
    for pin in (pin for pin in block.pins if pin.supply):
        ends = [plan.west + plan.joints[name] for name in JOINTS[pin.name]]
        canvas.wire(TOP, 0, pin.at_um - half, max(ends) + 2, pin.at_um + half)
        count = int((room.supply_um - 2) / VIA_PITCH)
        for x in ends:
            for k in range(count):
                y = snap(pin.at_um) + (k - (count - 1) / 2) * VIA_PITCH
                canvas.square(via, x, y, VIA)
            canvas.wire(FOURTH, x - VIA_PAD, pin.at_um - half, x + VIA_PAD, pin.at_um + half)
