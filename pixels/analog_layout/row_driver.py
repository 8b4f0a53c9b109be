"""A row's driver on the pixels' pitch: logic in the west, level shifters in the east, one set of tracks.

    rail vdd   ================   rail vddr  ================
               gates               | n well, hvi  lift  lift |   jogs to the lines' places in the row
    rail vss   ================   rail vss   ================

Predecoded lines and controls cross all rows on the fourth metal; a row has a via at one line of each group.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations

from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout.cells import Cell
from talbot.pixels.analog_layout.device import Device, snap
from talbot.pixels.analog_layout.strip import (
    FOURTH,
    RAIL_AT,
    RAIL_ENDS,
    RAIL_HALF,
    RAIL_TRUNK,
    TAP_HALF,
    THIRD,
    TRACK,
    WELL_ENDS,
    Strip,
    draw_rails,
    draw_rows,
    join_rails,
)
from talbot.pixels.analog_layout.strip_plan import TRUNK, Placed, Plan, in_columns
from talbot.pixels.circuits.row_driver import CODES, CONTROLS, ROW_INPUTS, ROW_LINES, SIDES, SUPPLIES
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
RAIL_GAP = 1.2  # between the centres of adjacent rows' rails
LINE_WIDTH = 0.4  # of lines that cross all rows
LINE_PITCH = 0.8
LINE_SPACE = 0.9  # from these lines to pins
JOINT_SPACE = 1.1  # from the metal that joins rails to pins
WEST_STEP = 0.1  # steps by which the rows move west for it
LEAST_WEST = 3.0  # of the rows in their block
ROOM = 0.6  # next to each device, for its drops
SHIFTER_SPACE = 8.0  # from the logic's tracks to the level shifters: wells of two levels, rails and their joints
THICK_WELL = 0.33  # of the hvi well around diffusion and taps
THICK_MARGIN = 0.33  # of hvi beyond the well
TIP = 0.185  # of hvntm
JOG_PITCH = 0.8  # of the lines to their places
JOG_FIRST = 2.2
PIN_END = 1.5  # east of the last jog
LOGIC = (
    "amp_n",
    "amp_s",
    "reset_n",
    "reset_s",
    "pixel_reset_n",
    "pixel_reset_s",
    "expose_n",
    "open_s",
    "open_n",
    "integrate_n",
    "integrate_s",
    *(f"{name}_{end}" for name in ("tap1", "tap0", "read", "shutter") for end in "ns"),
)
SHIFTERS = "read", "shutter", "pixel_reset", "tap1", "integrate", "tap0"  # in this order all lines have ways out
GATE_OF_VDD = "vdd_gate"  # the track of what the shifters' gates have at the chip's level


@dataclass(frozen=True)
class RowPlan:
    """Positions of a row's parts, um from its logic's west end.

    plan, logic, thick: strips of the row, of its logic and of its level shifters.
    lines: x of the lines that cross all rows.
    joints: x of the supplies that cross all rows.
    jogs: x of the jogs from the tracks to the row lines' places.
    pins: x of the block's south pins.
    right: its east edge.
    west: of its logic from the block's west edge.
    pitch: of the rows.
    """

    plan: Plan
    logic: Plan
    thick: Plan
    lines: Mapping[str, float]
    joints: Mapping[str, float]
    jogs: Mapping[str, float]
    pins: Mapping[str, float]
    right: float
    west: float
    pitch: float

    def places(self) -> dict[str, float]:
        """Return y of each line in its row, from the row's south edge."""
        return {net: snap((k + 0.5) / len(ROW_LINES) * self.pitch) for k, net in enumerate(ROW_LINES)}


def _lines(n: Sequence[Placed], pins: Collection[float]) -> dict[str, float]:
    """Return x of the crossing lines: a control over its gate, predecoded lines in free places from the west.

    pins: x of what comes from the south.
    """
    places = [k * LINE_PITCH for k in range(1, 400) if all(abs(k * LINE_PITCH - x) >= LINE_SPACE for x in pins)]
    lines = {}
    for control in CONTROLS:
        (gate,) = (placed for placed in n if placed.device.transistor.gate == control)
        middle = (gate.low + gate.high) / 2
        lines[control] = min(places, key=lambda x: abs(x - middle))
    free = iter(x for x in places if x not in lines.values())
    for name in (f"{side}_{group}{k}" for side in SIDES for group, count in CODES.items() for k in range(count)):
        lines[name] = next(free)
    return {name: round(x, 3) for name, x in lines.items()}


def legs(d: Mapping[str, Device], name: str) -> list[tuple[Device | None, Device | None]]:
    """Columns of a gate or of a level shifter."""
    if f"{name}.pa" in d and f"{name}.n" in d:
        return [(d[f"{name}.{n}"], d[f"{name}.{p}"]) for n, p in (("na", "pa"), ("nb", "pb"), ("n", "p"))]
    legs = [leg for leg in ("", *"abcd") if f"{name}.n{leg}" in d]
    return [(d[f"{name}.n{leg}"], d[f"{name}.p{leg}"]) for leg in legs]


def _renamed(device: Device) -> Device:
    """Return a shifter's transistor whose gate has the chip's level, with the net of its track."""
    t = device.transistor
    thick = t.role.endswith("thick")
    return replace(device, transistor=t._replace(gate=GATE_OF_VDD)) if thick and t.gate == "vdd" else device


def row_plan(d: Mapping[str, Device], width: float, pitch: float, pins: Mapping[str, float]) -> RowPlan:
    """Return the row of a ``pitch`` in a block of ``width`` (um), whose ``pins`` in the south are so far from its west.

    Raises ParameterError where the row is wider, or has more nets than its pitch has tracks.
    """
    n, p, end = in_columns([leg for name in LOGIC for leg in legs(d, name)], 0.0, ROOM)
    thick = [(_renamed(a), _renamed(b)) for name in SHIFTERS for a, b in legs(d, f"{name}_l") if a and b]
    begin = round(end + SHIFTER_SPACE, 2)
    tn, tp, right = in_columns(thick, begin, ROOM)
    first = right + RAIL_AT + JOG_FIRST
    joints = {"vss": -RAIL_AT, "vdd": end + RAIL_AT, "vss_thick": begin - RAIL_AT, "vddr": right + RAIL_AT}
    whole = round(first + JOG_PITCH * len(ROW_LINES) + PIN_END, 2)
    while any(abs(x - (width - whole) - at) < JOINT_SPACE for x in pins.values() for at in joints.values()):
        whole = round(whole + WEST_STEP, 2)
    west = round(width - whole, 3)
    if west < LEAST_WEST:
        raise ParameterError(f"row_driver_um = {width:g}: must be {whole + LEAST_WEST:g} at the least, the drawn row")
    pins = {name: round(x - west, 3) for name, x in pins.items()}
    lines = _lines(n, pins.values())
    reach: dict[str, tuple[float, ...]] = {name: (lines[name],) for name in CONTROLS}
    for side in SIDES:
        for group, count in CODES.items():
            reach[f"{side}_{group}"] = lines[f"{side}_{group}0"], lines[f"{side}_{group}{count - 1}"]
    reach[GATE_OF_VDD] = (joints["vdd"],)
    least = pitch - RAIL_GAP
    for order in permutations(ROW_LINES):
        jogs = {net: round(first + JOG_PITCH * k, 3) for k, net in enumerate(order)}
        through = reach | {net: (at,) for net, at in jogs.items()}
        plan = Plan((*n, *tn), (*p, *tp), 0.0, right, through, rails=("vss", "vdd", "vddr"), least_um=least)
        if plan.height_um > pitch - RAIL_GAP + 1e-9:
            raise ParameterError(f"row = {len(plan.tracks())} nets: must have tracks in {pitch:g} um")
        row = RowPlan(plan, plan, plan, lines, joints, jogs, pins, whole, west, pitch)
        if _clear(row):
            break
    else:
        raise ParameterError("row: its lines must have ways to their places")
    logic = Plan(n, p, 0.0, end, {}, least_um=least)
    shifters = Plan(tn, tp, begin, right, {}, rails=("vss", "vddr"), least_um=least)
    return replace(row, logic=logic, thick=shifters)


def _clear(row: RowPlan) -> bool:
    """Return whether no line from its jog to its place is next to the track of a longer one."""
    at, jogs = row.places(), row.jogs
    tracks = {track.net: RAIL_GAP / 2 + track.y for track in row.plan.tracks() if track.net in jogs}
    return not any(
        jogs[far] > jogs[near] and abs(tracks[far] - at[near]) < TRACK + 0.32
        for near in jogs
        for far in jogs
        if near != far
    )


def draw_row(canvas: Canvas, masks: AnalogMasks, row: RowPlan) -> Strip:
    """Return a row, its south edge at y = 0, with its part of the controls and supplies that cross all rows."""
    y, top = RAIL_GAP / 2, row.pitch - RAIL_GAP / 2
    strip = draw_rows(canvas, masks, row.plan, y)
    for plan in (row.logic, row.thick):
        draw_rails(canvas, masks, plan, y)
        join_rails(canvas, [Strip(plan, y)])
    canvas.wire(1, row.logic.right, y - RAIL_HALF, row.thick.left, y + RAIL_HALF)  # one ground
    _thick(canvas, row, y, top)
    crossing = {name: row.lines[name] for name in CONTROLS}
    for places_of, wide in ((crossing, LINE_WIDTH), (row.joints, RAIL_TRUNK)):
        for x in places_of.values():
            canvas.wire(FOURTH, x - wide / 2, 0, x + wide / 2, row.pitch)
    at = row.places()
    for track in strip.tracks:
        for x in [row.lines[track.net]] if track.net in CONTROLS else []:
            canvas.stack(x, track.y, THIRD, FOURTH)
        if track.net == GATE_OF_VDD:
            canvas.stack(row.joints["vdd"], track.y, THIRD, FOURTH)
        if track.net in row.jogs:
            x, to, half = row.jogs[track.net], at[track.net], LINE_WIDTH / 2
            low, high = sorted((track.y, to))
            canvas.wire(THIRD, x - half, to - half, row.right, to + half)
            if high - low < TRACK + 0.32:  # no notch between both, and no room for two vias
                canvas.wire(THIRD, x - TRUNK / 2, low, x + TRUNK / 2, high)
                continue
            canvas.wire(FOURTH, x - half, low - half, x + half, high + half)
            for end in (track.y, to):
                canvas.stack(x, end, THIRD, FOURTH)
    return strip


def _thick(canvas: Canvas, row: RowPlan, y: float, top: float) -> None:
    """Draw the thick oxide's masks: over all shifters, the tip implant over n, more well around p."""
    process, plan = canvas.process, row.thick
    (oxide, _), (tip, _) = process.thick
    ends = RAIL_ENDS + WELL_ENDS + THICK_MARGIN
    canvas.box(oxide, plan.left - ends, 0, plan.right + ends, row.pitch)
    low = min(top - 0.96 - placed.device.finger_um for placed in plan.p) - THICK_WELL
    canvas.box(
        process.well,
        plan.left - ends + THICK_MARGIN,
        low,
        plan.right + ends - THICK_MARGIN,
        top + TAP_HALF + THICK_WELL,
    )
    high = max(y + 0.96 + placed.device.finger_um for placed in plan.n)
    left, right = plan.n[0].x, plan.n[-1].x + plan.n[-1].device.width_um
    canvas.box(tip, left - TIP, y + 0.96 - TIP, right + TIP, high + TIP)


def as_cell(canvas: Canvas, d: Mapping[str, Device], strip: Strip) -> Cell:
    """Return the drawn row with its circuit's names."""
    terminals = tuple(
        terminal._replace(strap=terminal.strap._replace(net="vdd")) if terminal.strap.net == GATE_OF_VDD else terminal
        for terminal in strip.terminals
    )
    ports = (*ROW_INPUTS, *ROW_LINES, *SUPPLIES)
    return Cell(canvas.layout, canvas.cell, ports, tuple(d.values()), terminals=terminals, tracks=tuple(strip.tracks))
