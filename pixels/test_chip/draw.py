"""The test chip's masks, on the outline and pins of a Tiny Tapeout analog project of 1x2 tiles with 3.3 V.

digital pins    ==|=|=|=|=|==========   outputs tied to ground
                level shifters          a strip
channel of    | pixels, dummies, rings | buses | stripes of ground and supplies
lines         |                        |       |
                switches, followers     a strip
analog pins     ---|-----|-----|-----
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from talbot.base.gds import db
from talbot.models.parameters import ArrayParameters, TileParameters
from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.device import Device
from talbot.pixels.analog_layout.row_driver import GATE_OF_VDD, ROOM, legs
from talbot.pixels.analog_layout.strip import (
    FIRST,
    FOURTH,
    RAIL_ENDS,
    RAIL_HALF,
    TAP_HALF,
    THIRD,
    WELL_ENDS,
    Strip,
    Terminal,
    draw_rails,
    draw_rows,
    trunk,
)
from talbot.pixels.analog_layout.strip_plan import Placed, Plan, in_columns
from talbot.pixels.drawn import DUMMIES
from talbot.pixels.layout.array import GROUND_BUS, SUPPLY_BUS, ArrayLayout, corner, draw_surroundings, inside
from talbot.pixels.layout.canvas import Canvas
from talbot.pixels.layout.circuit import SIDES
from talbot.pixels.layout.pixel import draw, draw_reference
from talbot.pixels.layout.write import drawn_pixels
from talbot.pixels.test_chip.circuit import ANALOG, GROUND, HIGH, INPUTS, LOGIC, NAME, lifts, readout
from talbot.pixels.test_chip.places import COLS, COVERED, REFERENCE, ROWS
from talbot.platforms.analog import AnalogMasks
from talbot.platforms.sky130.tinytapeout import ANALOG_PIN_UM, ANALOG_PINS, ANALOG_PORTS, ANALOG_UM, PORT_UM

# um
WIDTH, HEIGHT = ANALOG_UM
ARRAY = 2.0, 52.0  # south-west corner of the pixels' block
READOUT_Y, LIFTS_Y = 14.0, 180.0  # middle of the lower rail of each strip
READOUT_X, LIFTS_X = 16.0, 17.0  # west end of its transistors
CHANNEL, CHANNEL_PITCH, LINE = 2.6, 0.8, 0.4  # of the lines in the west
STRIPES = {GROUND: 132.0, LOGIC: 136.0, HIGH: 140.0}  # middles
STRIPE, STRIPE_ENDS = 2.0, (8.0, 217.0)
TIE = 221.0, 223.0  # the bar that ties the outputs
GROUND_BAR = 2.0, 5.0  # above the array: from the ground's bus to its stripe
VDDA_Y = 5.0
THICK_WELL, THICK_MARGIN, TIP = 0.33, 0.33, 0.185  # as in a row's level shifters
TIED = tuple(f"{name}[{bit}]" for name in ("uo_out", "uio_out", "uio_oe") for bit in range(8))


@dataclass(frozen=True)
class TestChip:
    """The drawn chip. array: what its pixels are drawn from. devices: of both strips. pixels: cell name by position."""

    __test__ = False

    layout: "db.Layout"
    cell: "db.Cell"
    array: ArrayLayout
    devices: tuple[Device, ...]
    terminals: tuple[Terminal, ...]
    pixels: Mapping[tuple[int, int], str]


def array_layout(pdk: str) -> ArrayLayout:
    """Return the tile's pixels with edges at multiples of 45 degrees, as the shuttle's rules ask."""
    tile = TileParameters()
    drawn = tuple(replace(pixel, octilinear=True) for pixel in drawn_pixels(pdk, tile))
    return ArrayLayout(ArrayParameters(ROWS, COLS), tile, drawn)


def draw_chip(masks: AnalogMasks) -> TestChip:
    """Draw the chip."""
    array = array_layout(masks.base.name)
    layout = db.Layout()
    layout.dbu = 0.001
    canvas = Canvas(layout, NAME, masks.base)
    block, places = _pixels(layout, array)
    trans = db.Trans(canvas.snap(ARRAY[0]), canvas.snap(ARRAY[1]))
    for cell in layout.each_cell():  # the top's names alone are nets
        for index in layout.layer_indexes():
            for shape in [*cell.shapes(index).each(db.Shapes.STexts)]:
                shape.delete()
    canvas.cell.insert(db.CellInstArray(block.cell_index(), trans))
    d = {t.name: Device.of(t) for circuit in (lifts(), readout()) for t in flat.transistors(circuit)}
    channel = {line: CHANNEL + CHANNEL_PITCH * k for k, line in enumerate(INPUTS.values())}
    _stripes(canvas)
    strips = _lifts(canvas, masks, d, channel), _readout(canvas, masks, d, channel, array)
    _rows(canvas, array, channel)
    _supplies(canvas, array)
    _pins(canvas)
    canvas.box(masks.base.outline, 0, 0, WIDTH, HEIGHT)
    terminals = tuple(
        end._replace(strap=end.strap._replace(net=LOGIC)) if end.strap.net == GATE_OF_VDD else end
        for strip in strips
        for end in strip.terminals
    )
    return TestChip(layout, canvas.cell, array, tuple(d.values()), terminals, places)


def relabelled(layout: "db.Layout", names: Mapping[str, str]) -> "db.Layout":
    """Return a copy whose top cell has the labels of ``names`` alone, with their new names."""
    copy = db.Layout()
    copy.assign(layout)
    for index in copy.layer_indexes():
        for shape in [*copy.top_cell().shapes(index).each(db.Shapes.STexts)]:
            if name := names.get(shape.text_string):
                shape.text_string = name
            else:
                shape.delete()
    return copy


def _pixels(layout: "db.Layout", array: ArrayLayout) -> tuple["db.Cell", dict[tuple[int, int], str]]:
    """Return the pixels with dummies and rings, and the cell at each position; row 0 is the north one."""
    canvas = Canvas(layout, "pixels", array.pixels[0].process)
    tile, cells = array.tile, [draw(layout, pixel).cell for pixel in array.pixels]
    oblique = next(pixel for pixel in array.pixels if pixel.axis is None)
    reference = [draw_reference(layout, oblique, covered).cell for covered in (False, True)]
    places = {}
    for row in range(-DUMMIES, ROWS + DUMMIES):
        for col in range(-DUMMIES, COLS + DUMMIES):
            number = tile.order[row % tile.rows * tile.cols + col % tile.cols]
            plain = row == REFERENCE and 0 <= col < COLS
            cell = reference[col in COVERED] if plain else cells[number]
            x, y = corner(array, row, col)
            canvas.cell.insert(db.CellInstArray(cell.cell_index(), db.Trans(canvas.snap(x), canvas.snap(y))))
            places[row, col] = cell.name
    draw_surroundings(canvas, array)
    return canvas.cell, places


def _stripes(canvas: Canvas) -> None:
    """Draw the stripes of ground and supplies, and their pins."""
    for name, x in STRIPES.items():
        box = x - STRIPE / 2, STRIPE_ENDS[0], x + STRIPE / 2, STRIPE_ENDS[1]
        _pin(canvas, name, box)


def _pin(canvas: Canvas, name: str, box: tuple[float, float, float, float]) -> None:
    metal = canvas.process.metals[FOURTH]
    for mask in (metal.gds, metal.pin):
        canvas.box(mask, *box)
    canvas.label(FOURTH, name, (box[0] + box[2]) / 2, (box[1] + box[3]) / 2)


def _to_stripe(canvas: Canvas, net: str, level: int, x: float, y: float) -> None:
    """Draw a net's segment on metal ``level`` from ``x`` to its stripe."""
    to = STRIPES[net]
    canvas.wire(level, x, y - RAIL_HALF, to + 0.9, y + RAIL_HALF)
    for metal in range(level + 1, FOURTH):
        canvas.wire(metal, to - 0.9, y - RAIL_HALF, to + 0.9, y + RAIL_HALF)
    for at in (to - 0.6, to, to + 0.6):
        canvas.stack(at, y, level, FOURTH)


def _draw_strip(canvas: Canvas, masks: AnalogMasks, plan: Plan, y: float) -> Strip:
    """Draw a strip of thick oxide, its rails up to their stripes."""
    strip, top = draw_rows(canvas, masks, plan, y), y + plan.height_um
    draw_rails(canvas, masks, plan, y)
    base = canvas.process
    (oxide, _), (tip, _) = base.thick
    ends = RAIL_ENDS + WELL_ENDS + THICK_MARGIN
    west, east = plan.left - ends, plan.right + ends
    canvas.box(oxide, west, y - TAP_HALF - THICK_MARGIN, east, top + TAP_HALF + THICK_WELL + THICK_MARGIN)
    low = min(top - 0.96 - placed.device.finger_um for placed in plan.p) - THICK_WELL
    canvas.box(base.well, west + THICK_MARGIN, low, east - THICK_MARGIN, top + TAP_HALF + THICK_WELL)
    high = max(y + 0.96 + placed.device.finger_um for placed in plan.n)
    left, right = plan.n[0].x, plan.n[-1].x + plan.n[-1].device.width_um
    canvas.box(tip, left - TIP, y + 0.96 - TIP, right + TIP, high + TIP)
    for net, at in ((GROUND, y), (HIGH, top)):
        _to_stripe(canvas, net, FIRST, plan.right, at)
    return strip


def _renamed(device: Device) -> Device:
    """Return a shifter's transistor whose gate is at the logic's supply, with the net of its track."""
    t = device.transistor
    return replace(device, transistor=t._replace(gate=GATE_OF_VDD)) if t.gate == LOGIC else device


def _lifts(canvas: Canvas, masks: AnalogMasks, d: Mapping[str, Device], channel: Mapping[str, float]) -> Strip:
    """Draw the level shifters in the order of their pins, and the ends of their lines in the channel."""
    at = dict(ANALOG_PORTS)
    pins = sorted(INPUTS, key=lambda pin: at[pin])
    columns = [(_renamed(a), _renamed(b)) for pin in pins for a, b in legs(d, INPUTS[pin]) if a and b]
    n, p, right = in_columns(columns, LIFTS_X, ROOM)
    through: dict[str, Sequence[float]] = {pin: (at[pin],) for pin in pins}
    through |= {line: (x,) for line, x in channel.items()} | {GATE_OF_VDD: (STRIPES[LOGIC],)}
    plan = Plan(n, p, LIFTS_X, right, through, rails=(GROUND, HIGH))
    strip = _draw_strip(canvas, masks, plan, LIFTS_Y)
    for pin in pins:
        trunk(canvas, strip.tracks, pin, at[pin], HEIGHT - PORT_UM[1] / 2)
    for line, x in channel.items():
        end = READOUT_Y if line.startswith("column") else ARRAY[1]
        ys = [track.y for track in strip.tracks if track.net == line]
        for y in ys:
            canvas.stack(x, y, THIRD, FOURTH)
        canvas.wire(FOURTH, x - LINE / 2, end, x + LINE / 2, max(ys) + LINE / 2)
    for track in strip.tracks:
        if track.net == GATE_OF_VDD:
            canvas.stack(STRIPES[LOGIC], track.y, THIRD, FOURTH)
    # outputs: on ground, which comes from the rail below
    west = LIFTS_X - RAIL_ENDS + 0.5
    first, last = (pick(at[name] for name in TIED) for pick in (min, max))
    canvas.wire(FOURTH, first - PORT_UM[0] / 2, TIE[0], last + PORT_UM[0] / 2, TIE[1])
    canvas.wire(FOURTH, west - 0.4, LIFTS_Y - RAIL_HALF, west + 0.4, TIE[1])
    for metal in (2, THIRD):
        canvas.wire(metal, west - 0.4, LIFTS_Y - RAIL_HALF, west + 0.4, LIFTS_Y + RAIL_HALF)
    canvas.stack(west, LIFTS_Y, FIRST, FOURTH)
    for name in TIED:
        canvas.wire(FOURTH, at[name] - PORT_UM[0] / 2, TIE[0], at[name] + PORT_UM[0] / 2, HEIGHT)
    return strip


def _rows(canvas: Canvas, array: ArrayLayout, channel: Mapping[str, float]) -> None:
    """Join the rows' lines, on the third metal at the array's west edge, with the channel."""
    for pin in array.block.pins:
        name, _, row = pin.name.rstrip("]").partition("_row[")
        line = "pixel_reset" if name == "pixel_reset" else f"read[{row}]"
        if name in ("pixel_reset", "read"):
            y, x = ARRAY[1] + pin.at_um, channel[line]
            canvas.wire(THIRD, ARRAY[0], y - 0.2, max(x, ARRAY[0]) + 0.2, y + 0.2)
            canvas.stack(x, y, THIRD, FOURTH)


def _readout(
    canvas: Canvas, masks: AnalogMasks, d: Mapping[str, Device], channel: Mapping[str, float], array: ArrayLayout
) -> Strip:
    """Draw switches and followers, with the columns from the north and the analog pins in the south."""
    n_names = [f"switch_{side}{col}" for col in range(COLS) for side in SIDES]
    names = [*n_names[:6], "sink_a", "input", "turn", "sink_b", *n_names[6:]]
    p_names = ["source_a", "follower_a", "reference", "source_b", "follower_b"]
    ua = dict(ANALOG_PINS)
    x0 = ARRAY[0]
    columns = {pin.name: x0 + pin.at_um for pin in array.block.pins if pin.name.startswith("column_")}
    n, p = _row(d, names, READOUT_X), _row(d, p_names, READOUT_X)
    right = max(placed.high for placed in (*n, *p))
    through: dict[str, Sequence[float]] = {net: (x,) for net, x in columns.items()}
    through |= {line: (x,) for line, x in channel.items() if line.startswith("column")}
    through |= {net: (ua[net],) for net in ANALOG[1:]}
    plan = Plan(n, p, READOUT_X, right, through, rails=(GROUND, HIGH))
    strip = _draw_strip(canvas, masks, plan, READOUT_Y)
    for net, x in columns.items():
        trunk(canvas, strip.tracks, net, x, ARRAY[1] + 0.5)
    for net in ANALOG[1:]:
        trunk(canvas, strip.tracks, net, ua[net], 0.0)
    for line, x in channel.items():
        for track in strip.tracks:
            if track.net == line:
                canvas.stack(x, track.y, THIRD, FOURTH)
    return strip


def _row(d: Mapping[str, Device], names: Sequence[str], left: float) -> tuple[Placed, ...]:
    """Return a row of transistors from ``left`` on, with room for their drops."""
    placed, x = list[Placed](), left
    for name in names:
        width = max(d[name].width_um + 0.5, 3 * 0.52) + ROOM
        placed.append(Placed(d[name], round((x + (width - d[name].width_um) / 2) / 0.005) * 0.005, x, x + width))
        x += width
    return tuple(placed)


def _supplies(canvas: Canvas, array: ArrayLayout) -> None:
    """Join the array's ground with its stripe, and its supply with the first analog pin."""
    _, bottom, right, top = (at + ARRAY[k % 2] for k, at in enumerate(inside(array)))
    low, high = (right + at for at in GROUND_BUS)
    canvas.wire(FOURTH, low, top, high, top + GROUND_BAR[1])
    canvas.wire(FOURTH, low, top + GROUND_BAR[0], STRIPES[GROUND], top + GROUND_BAR[1])
    low, _ = (right + at for at in SUPPLY_BUS)
    pin, x = ANALOG_PINS[0][1], low + 2.0
    canvas.wire(FOURTH, x - 2.0, VDDA_Y - 1, x + 2.0, bottom)
    canvas.wire(THIRD, x - 2.0, VDDA_Y - 1, pin + 1.5, VDDA_Y + 1)
    canvas.wire(FOURTH, pin - 1.5, VDDA_Y - 1, pin + 1.5, VDDA_Y + 1)
    canvas.wire(FOURTH, pin - ANALOG_PIN_UM[0] / 2, 0, pin + ANALOG_PIN_UM[0] / 2, VDDA_Y)
    for middle, count in ((x, 4), (pin, 3)):
        for k in range(count):
            for dy in (-0.5, 0.5):
                canvas.stack(middle + (k - (count - 1) / 2) * 0.9, VDDA_Y + dy, THIRD, FOURTH)


def _pins(canvas: Canvas) -> None:
    """Draw the pins at the edges."""
    for name, x in ANALOG_PORTS:
        _pin(canvas, name, (x - PORT_UM[0] / 2, HEIGHT - PORT_UM[1], x + PORT_UM[0] / 2, HEIGHT))
    for name, x in ANALOG_PINS:
        _pin(canvas, name, (x - ANALOG_PIN_UM[0] / 2, 0, x + ANALOG_PIN_UM[0] / 2, ANALOG_PIN_UM[1]))
