"""The bank south of all rows: predecoders of both addresses and buffers, in strips.

All nets between strips, and from the pins in the south, are on the fourth metal, each at a separate x.
"""

from collections.abc import Iterator, Sequence

from talbot.pixels.analog_layout.cells import Cell
from talbot.pixels.analog_layout.comparator import BETWEEN_STRIPS, devices
from talbot.pixels.analog_layout.row_driver import LINE_PITCH, ROOM, RowPlan, legs
from talbot.pixels.analog_layout.strip import FOURTH, RAIL_HALF, SECOND, THIRD, Strip, draw_strip, trunk
from talbot.pixels.analog_layout.strip_plan import Plan, in_columns
from talbot.pixels.circuits.row_driver import ADDRESS, BANK_INPUTS, BANK_OUTPUTS, CODES, CONTROLS, LATE, SIDES, bank
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

NORTH = 2.0  # um, of the strips
SOUTH = 3.0  # um, of the strips
CROSSING_SPACE = 0.95  # um, least, between centres of lines that cross strips
JOINT_SPACE = 1.2  # um, from such a line to the centre of the metal that joins rails


def _strips() -> Iterator[list[str]]:
    """Gates of each strip, from the south."""
    for side in SIDES:
        yield [f"{side}_i{bit}" for bit in range(ADDRESS)] + [
            f"{name}_{end}" for name in _codes(side, "high") for end in "ns"
        ]
        for group in ("mid", "low"):
            extra = CONTROLS if (side, group) == ("amp", "mid") else ()
            waits = ("ref_ctl_n", *(f"read_l{k}" for k in range(LATE))) if extra else ()
            yield [*(f"{name}_{end}" for name in (*_codes(side, group), *extra) for end in "ns"), *waits]


def _codes(side: str, group: str) -> list[str]:
    return [f"{side}_{group}{code}" for code in range(CODES[group])]


def crossings(rows: RowPlan) -> dict[str, float]:
    """Return x of every net between strips."""
    at = dict(rows.pins)
    for name, x in rows.lines.items():
        at[f"{name}_line" if name in CONTROLS else name] = x
    taken = [*at.values()]
    for side in SIDES:
        for bit in range(ADDRESS):
            position = at[f"{side}_row{bit}"]
            nearest = max(position, max(rows.lines[name] for name in _codes("reset", "low")))
            place = nearest
            while any(abs(place - x) < CROSSING_SPACE for x in taken) or any(
                abs(place - x) < JOINT_SPACE for x in rows.joints.values()
            ):
                place = round(place + LINE_PITCH / 4, 3)
            at[f"{side}_row{bit}n"] = place
            taken.append(place)
    return at


def draw_bank(canvas: Canvas, masks: AnalogMasks, rows: RowPlan) -> tuple[Cell, float]:
    """Draw it with its south edge at y = 0; returns it and its height."""
    d, at = devices(bank()), crossings(rows)
    rows_of = [in_columns([leg for name in gates for leg in legs(d, name)], 0.0, ROOM) for gates in _strips()]
    right = max(rows.logic.right, *(end for _, _, end in rows_of))
    y, strips = SOUTH, list[Strip]()
    for n, p, _ in rows_of:
        present = {net for device in (*n, *p) for net in device.device.transistor.nodes}
        reach = {net: (x,) for net, x in at.items() if net in present}
        strips.append(draw_strip(canvas, masks, Plan(n, p, 0.0, right, reach), y))
        y += strips[-1].plan.height_um + BETWEEN_STRIPS
    top = round(y - BETWEEN_STRIPS + NORTH, 2)
    tracks = [track for strip in strips for track in strip.tracks]
    for net, x in at.items():
        beyond = [0.0] if net in rows.pins else [top] if net in BANK_OUTPUTS else []
        if beyond or sum(track.net == net for track in tracks) > 1:
            trunk(canvas, tracks, net, x, *beyond)
    for net in ("vss", "vdd"):
        _join(canvas, strips, net, rows.joints[net], top)
    ports = (*BANK_INPUTS, *BANK_OUTPUTS, "vdd", "vss")
    terminals = tuple(terminal for strip in strips for terminal in strip.terminals)
    return Cell(canvas.layout, canvas.cell, ports, tuple(d.values()), terminals=terminals), top


def _join(canvas: Canvas, strips: Sequence[Strip], net: str, x: float, top: float) -> None:
    """Rails of all strips to what joins those of the rows."""
    canvas.wire(FOURTH, x - 0.5, strips[0].y - 0.5, x + 0.5, top)
    for strip in strips:
        y = strip.y + (strip.plan.height_um if net == strip.plan.rails[1] else 0.0)
        for level in (SECOND, THIRD):
            canvas.wire(level, x - 0.5, y - RAIL_HALF, x + 0.5, y + RAIL_HALF)
        for side in (-0.25, 0.25):
            canvas.stack(x + side, y, 1, FOURTH)
