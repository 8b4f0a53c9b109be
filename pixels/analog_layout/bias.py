"""The bias: a pair of 1 to 16 with its mirror, an output for each amplifier, a resistor of n+ diffusion, the starter.

    upper    an output's second half each, mirror of the four; below them the starter
    lower    an output's first half each, mirror of the one; below them the four about the one
    resistor straight bars, one after the other

Both halves of an output are at the same distance from the middle, on opposite sides. Rows end with dummies.
"""

from itertools import pairwise

from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.cells import MARGIN, Cell, new_canvas
from talbot.pixels.analog_layout.comparator import BETWEEN_STRIPS
from talbot.pixels.analog_layout.device import IMPLANT, Device, snap
from talbot.pixels.analog_layout.rows import dummies, row
from talbot.pixels.analog_layout.strip import (
    FIRST,
    FOURTH,
    RAIL_ENDS,
    RAIL_HALF,
    THIRD,
    WELL_ENDS,
    draw_strip,
    join_rails,
    trunk,
)
from talbot.pixels.analog_layout.strip_plan import Plan
from talbot.pixels.circuits.support import bias
from talbot.pixels.layout.canvas import CONTACT_UM, Canvas
from talbot.platforms.analog import AnalogMasks

# um
RESISTOR_WIDTH = 1.0
RESISTOR_HEAD = 1.0  # length of the resistor's ends
RESISTOR_BELOW = 2.0  # from the lowest rail down to the resistor's centre
BAR_PITCH = 2.0  # of the resistor's bars
STRIP_ENDS = 1.5  # of the strips beyond their longest row
PIN_INSET = 4.0  # of the outputs from the strips' ends


def resistor_um(ohm: float, masks: AnalogMasks) -> float:
    """Length of a bar, on the grid."""
    return snap(ohm / masks.sheet_ohm * RESISTOR_WIDTH)


def bias_cell(masks: AnalogMasks, outputs: int) -> Cell:
    """Draw a bias with ``outputs`` outputs, whose pins are in the south."""
    circuit = bias(outputs)
    d = {t.name: Device.of(t) for t in flat.transistors(circuit)}
    for name, like in (("four", "one"), ("lower", "mirror_one"), ("upper", "mirror_four")):
        d |= dummies(name, d[like])
    pins = circuit.ports[:outputs]
    halves = [[f"{pin.replace('ibias', 'out')}_{k}" for pin in pins] for k in range(2)]
    half = outputs // 2
    lower = ("lower_west", *halves[0][:half], "mirror_one", *halves[0][half:], "lower_east")
    turned = halves[1][::-1]
    upper = ("upper_west", *turned[: outputs - half], "mirror_four", *turned[outputs - half :], "upper_east", "keep")
    fours = ("four_west", "four_0", "four_1", "one", "four_2", "four_3", "four_east")
    parts = circuit.resistors
    length = resistor_um(parts[0].value, masks)
    long = max(sum(d[name].width_um + 0.5 for name in upper), length + 2 * RESISTOR_HEAD) + 2 * STRIP_ENDS
    right = 2 * snap(long / 2)
    west = snap((right - length) / 2)
    at = {net: right / 2 + 5.0 * way for net, way in (("vbn", -1), ("vbp", 1))}
    at |= {"source": west - RESISTOR_HEAD / 2}
    step = (right - 2 * PIN_INSET) / outputs
    at |= {pin: snap(PIN_INSET + step * (k + 0.5)) for k, pin in enumerate(pins)}
    plans = []
    for n, p in ((fours, lower), (("stop", "start"), upper)):
        rows = row(d, n, right / 2), row(d, p, right / 2)
        present = {net for placed in (*rows[0], *rows[1]) for net in placed.device.transistor.nodes}
        plans.append(Plan(*rows, 0.0, right, {net: (x,) for net, x in at.items() if net in present}))
    canvas, y = new_canvas(masks, "bias"), MARGIN + 2 * RESISTOR_BELOW + (len(parts) - 1) * BAR_PITCH
    strips = []
    for plan in plans:
        strips.append(draw_strip(canvas, masks, plan, y))
        y += plan.height_um + BETWEEN_STRIPS
    join_rails(canvas, strips)
    # Bars from the uppermost, every second one from the east; an even number of them, so that the last ends in the west
    high, ends = strips[0].y - RESISTOR_BELOW, list[flat.Ends]()
    for k, part in enumerate(parts):
        places = _resistor(canvas, masks, west, high - k * BAR_PITCH, length)
        ends.append(flat.Ends(part.name, *(places[::-1] if k % 2 else places)))
    for bar, after in pairwise(ends):
        x = bar.last[0]
        canvas.wire(FIRST, x - 0.3, after.first[1] - 0.3, x + 0.3, bar.last[1] + 0.3)
    x, low = ends[-1].last
    away = x - 2 * RESISTOR_HEAD
    canvas.wire(FIRST, away - 0.3, low - 0.3, x + 0.3, low + 0.3)
    canvas.wire(FIRST, away - 0.3, low - 0.3, away + 0.3, strips[0].y + RAIL_HALF)
    canvas.stack(at["source"], high, FIRST, FOURTH)
    canvas.wire(THIRD, at["source"] - 0.35, high - 0.19, at["source"] + 0.35, high + 0.19)
    tracks = [track for strip in strips for track in strip.tracks]
    for net, x in at.items():
        beyond = [high] if net == "source" else [0.0] if net in pins else []
        trunk(canvas, tracks, net, x, *beyond)
        if net in pins:
            canvas.label(FOURTH, net, x, 0.3)
    beside = RAIL_ENDS + WELL_ENDS
    canvas.box(masks.base.outline, -beside, 0, right + beside, y - BETWEEN_STRIPS + MARGIN)
    terminals = tuple(terminal for strip in strips for terminal in strip.terminals)
    value = length / RESISTOR_WIDTH * masks.sheet_ohm
    return Cell(
        canvas.layout,
        canvas.cell,
        circuit.ports,
        tuple(d.values()),
        terminals=terminals,
        resistors=tuple(part._replace(value=value) for part in parts),
        ends=tuple(ends),
    )


def _resistor(
    canvas: Canvas, masks: AnalogMasks, x: float, y: float, length: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return a bar of diffusion from ``x`` on, its middle at ``y``, with its ends on the first metal; returns these."""
    base, half = masks.base, RESISTOR_WIDTH / 2
    canvas.box(base.active, x - RESISTOR_HEAD, y - half, x + length + RESISTOR_HEAD, y + half)
    around = half + IMPLANT
    canvas.box(base.nplus, x - RESISTOR_HEAD - IMPLANT, y - around, x + length + RESISTOR_HEAD + IMPLANT, y + around)
    canvas.box(masks.resistor, x, y - half, x + length, y + half)
    ends = (x - RESISTOR_HEAD / 2, y), (x + length + RESISTOR_HEAD / 2, y)
    for at, _ in ends:
        for dx in (-0.2, 0.2):
            for dy in (-0.2, 0.2):
                canvas.square(base.contact, at + dx, y + dy, CONTACT_UM)
                canvas.square(base.vias[0].gds, at + dx, y + dy, CONTACT_UM)
        for level in (0, FIRST):
            canvas.wire(level, at - 0.4, y - 0.4, at + 0.4, y + 0.4)
    return ends
