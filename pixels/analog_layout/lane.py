"""The converter lane: the comparator between its two arrays of capacitors, the switches beyond these.

    balance switches        north: lane_a, lane_b
    balance array           common node `other`
    comparator              symmetric; both common nodes reach it over its axis
    DAC array               common node `top`
    DAC switches
    drivers                 south: bits, sample, strobe, comparator

Between strips and arrays nets run on the fourth metal: next to an array or over the strips.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from talbot.pixels.analog_layout.array import Array, ArrayPlan, draw_array, edges
from talbot.pixels.analog_layout.cells import MARGIN, Cell, new_canvas
from talbot.pixels.analog_layout.comparator import BETWEEN_STRIPS, comparator_plans, devices, draw_comparator, pair
from talbot.pixels.analog_layout.device import Device, Strap
from talbot.pixels.analog_layout.pattern import binary, halves
from talbot.pixels.analog_layout.strip import (
    FOURTH,
    RAIL_AT,
    RAIL_ENDS,
    THIRD,
    TRACK,
    WELL_ENDS,
    Strip,
    draw_strip,
    join_rails,
    trunk,
)
from talbot.pixels.analog_layout.strip_plan import TRUNK, Plan, in_columns
from talbot.pixels.analog_layout.switch import ORDER
from talbot.pixels.circuits.dac import BITS
from talbot.pixels.circuits.interface import CHIP, LATE, LINE, interface
from talbot.pixels.circuits.lane import PINS, LaneSizes, sar_lane
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
CHANNEL = 9.0  # width next to the arrays, for lines that pass them
CHANNEL_FIRST = 0.9
CHANNEL_PITCH = 1.6
ARRAY_SPACE = 1.6  # from an array to a rail
WEST, EAST = ("lane_a", "refn", "bottoms", "refp", "bottoms_n"), ("vcm", "sample_1", "sample_2", "comparator", "fire")
GATES = (("n", "p"),), (("na", "pa"), ("nb", "pb"))  # of an inverter, of a gate of two inputs
NORTH = "lane_a", "lane_b", "refp", "refn", "vcm"  # pins there
NET_PITCH = 2.8  # of the nets over the strips
JOG = 5.0  # of the common nodes' ways into the comparator from its axis
Column = tuple[Device | None, Device | None]


# A lane between the chip and its amplifier
CHIP_PINS = tuple(pin for pin in PINS if pin not in ("sample", "strobe")) + (*CHIP, "reset")
INTERFACE = (
    tuple(f"drivers.{name}" for name in ORDER),
    (
        *("clkn", *(f"past{k}" for k in range(LINE)), "settles", "rests", "fired"),
        *("held", "holds", "over", *(f"late{k}" for k in range(LATE)), "sampled"),
    ),
)


@dataclass(frozen=True)
class LanePlan:
    """Strips and arrays of a lane, from the south. at: x of the nets between them."""

    left: float
    right: float
    drivers: tuple[Plan, ...]
    dac_switches: tuple[Plan, ...]
    dac: ArrayPlan
    comparator: tuple[Plan, Plan]
    balance: ArrayPlan
    balance_switches: Plan
    at: dict[str, float]


def _switch(d: dict[str, Device], prefix: str) -> list[Column]:
    """Columns of the transistors of one switch circuit that are there."""
    names = [("in_n", "in_p"), ("low", "high"), *((f"off_high.{n}", f"off_high.{p}") for n, p in GATES[1])]
    names += [(f"on_low.{n}", f"on_low.{p}") for n, p in GATES[1]]
    present = [(d.get(prefix + n), d.get(prefix + p)) for n, p in names]
    return [column for column in present if any(column)]


def _gates(d: dict[str, Device], names: Iterable[str]) -> list[Column]:
    columns: list[Column] = []
    for name in names:
        legs = GATES[0] if f"{name}.n" in d else GATES[1]
        columns += [(d[f"{name}.{n}"], d[f"{name}.{p}"]) for n, p in legs]
    return columns


def lane_plan(masks: AnalogMasks, sizes: LaneSizes, d: dict[str, Device]) -> LanePlan:
    """Plan a lane. Raises ParameterError where it does not fit."""
    edge, half = edges(sizes.dac, masks)
    nets = {f"bit{k}": f"dac.b{k}" for k in reversed(range(BITS))} | {"terminator": "dac.bt", "half": "dac.bh"}
    probe = ArrayPlan(binary(), nets, "top", edge, half, 0, 0)
    left, right = 0.0, round(probe.size_um[0] + 2 * CHANNEL, 2)
    axis = right / 2
    dac = ArrayPlan(binary(), nets, "top", edge, half, left, right)
    other = {"refp": "balance.b_refp", "refn": "balance.b_refn", "half": "refn"}
    balance = ArrayPlan(halves(), other, "other", edge, half, left, right)

    at = _places(left, right, nets, other)
    switches = [_switch(d, f"dac.switch{k}.") for k in reversed(range(BITS))]
    switches += [_switch(d, "dac.switch_t."), _switch(d, "dac.switch_h.")]
    strips: list[list[Column]] = [[]]
    for switch in switches:
        if in_columns([*strips[-1], *switch], left)[2] > right:
            strips.append([])
        strips[-1] += switch

    def plan(columns: Sequence[Column]) -> Plan:
        n, p, end = in_columns(columns, left, (right - in_columns(columns, left)[2]) / len(columns) - 1e-3)
        present = {net for pl in (*n, *p) for net in pl.device.transistor.nodes}
        reach = {net: (x,) for net, x in at.items() if net in present}
        return Plan(n, p, left, right, reach, quiet=frozenset({*nets.values(), *other.values(), "lane_a", "lane_b"}))

    drivers = [_gates(d, gates) for gates in INTERFACE] if "rests.n" in d else []
    drivers.append(
        _gates(d, ("sample_0", "sample_1", "sample_2", "sample_3", "sample_n", "sample_p", "strobe_n", "strobe_p"))
    )
    plates = [pair(d, f"plate_other_{kind}", f"plate_top_{kind}") for kind in ("n", "p")]
    names = _switch(d, "balance.switch_refp.") + _switch(d, "balance.switch_refn.")
    return LanePlan(
        left,
        right,
        tuple(plan(column_list) for column_list in drivers),
        tuple(plan(column_list) for column_list in strips),
        dac,
        comparator_plans(
            d,
            axis,
            (left, right),
            "comparator.",
            [plates[0]],
            [plates[1]],
            {net: (x,) for net, x in at.items()} | {"top": (axis + JOG,), "other": (axis - JOG,)},
        ),
        balance,
        plan(names),
        at,
    )


def lane_cell(masks: AnalogMasks, sizes: LaneSizes, chip: bool = False) -> Cell:
    """Draw the lane; its south-west corner is at the origin, its pins are in the south and in the north.

    chip: with the `interface` between the chip and the amplifier, instead of pins sample and strobe.
    """
    ports, d = CHIP_PINS if chip else PINS, devices(sar_lane(sizes))
    canvas = new_canvas(masks, "adc_lane" if chip else "sar_lane")
    if chip:
        d |= devices(interface())
    plan = lane_plan(masks, sizes, d)
    y, south = MARGIN, list[Strip]()
    for strip_plan in (*plan.drivers, *plan.dac_switches):
        south.append(draw_strip(canvas, masks, strip_plan, y))
        y += strip_plan.height_um + BETWEEN_STRIPS
    y += ARRAY_SPACE - BETWEEN_STRIPS
    dac = draw_array(canvas, masks, plan.dac, y)
    y += plan.dac.size_um[1] + ARRAY_SPACE
    middle = draw_comparator(canvas, masks, plan.comparator, y)
    y = middle[-1].y + middle[-1].plan.height_um + ARRAY_SPACE
    balance = draw_array(canvas, masks, plan.balance, y, bus_south=False)
    y += plan.balance.size_um[1] + ARRAY_SPACE
    north = draw_strip(canvas, masks, plan.balance_switches, y)
    top = y + plan.balance_switches.height_um + MARGIN
    strips = [*south, *middle, north]
    join_rails(canvas, strips)
    for array, net, way in ((dac, "top", 1), (balance, "other", -1)):
        _meet(canvas, array, middle[0], net, way * JOG)
        _ground(canvas, array, plan.left - RAIL_AT)
    tracks = [*dac.tracks, *balance.tracks, *(track for strip in strips for track in strip.tracks)]
    _nets(canvas, plan, tracks, top, ports)
    ends = RAIL_ENDS + WELL_ENDS
    canvas.box(masks.base.outline, plan.left - ends, 0, plan.right + ends, top)
    plates = [
        plate._replace(name=f"{side}_{plate.name}")
        for side, array in (("dac", plan.dac), ("balance", plan.balance))
        for plate in array.plates()
    ]
    ends = tuple(terminal for strip in strips for terminal in strip.terminals)
    arrays = ("dac", dac), ("balance", balance)
    taps = [tap._replace(name=f"{side}_{tap.name}") for side, array in arrays for tap in array.taps]
    return Cell(canvas.layout, canvas.cell, ports, tuple(d.values()), tuple(plates), ends, tuple(taps))


def _meet(canvas: Canvas, array: Array, arm: Strip, net: str, aside: float) -> None:
    """A common node from its array to its half of a track in the comparator, ``aside`` of the axis."""
    x, y = array.exit
    half, to = TRUNK / 2, x + aside
    canvas.wire(FOURTH, min(x, to) - half, y - half, max(x, to) + half, y + half)
    trunk(canvas, arm.tracks, net, to, y)


def _ground(canvas: Canvas, array: Array, x: float) -> None:
    """The dummies' net to what joins the lower rails."""
    track = next(row for row in array.tracks if row.net == array.plan.ground)
    canvas.wire(THIRD, x - TRACK / 2, track.y - TRACK / 2, track.left, track.y + TRACK / 2)
    canvas.stack(x, track.y, THIRD, FOURTH)


def _places(left: float, right: float, nets: Mapping[str, str], other: Mapping[str, str]) -> dict[str, float]:
    """Return x of the nets between strips: next to the arrays, or over the strips on one side of them."""
    places: dict[str, float] = {net: left + CHANNEL_FIRST + CHANNEL_PITCH * k for k, net in enumerate(WEST)}
    places |= {net: right - CHANNEL_FIRST - CHANNEL_PITCH * k for k, net in enumerate(EAST)}
    bits = [f"d{k}" for k in reversed(range(BITS))]
    over = [*nets.values(), *bits]
    over += ["sample", "strobe", *CHIP]
    first = (left + right) / 2 - NET_PITCH * (len(over) - 1) / 2
    places |= {net: first + NET_PITCH * k for k, net in enumerate(["track", *over, "reset"], -1)}
    beside = [*other.values(), "lane_b"]
    return places | {net: first + NET_PITCH * (3 * k + 1) for k, net in enumerate(beside) if net not in places}


def _nets(canvas: Canvas, plan: LanePlan, tracks: Sequence[Strap], top: float, ports: Sequence[str]) -> None:
    """Draw the nets between strips, up to the pins."""
    present = {track.net for track in tracks}
    for net, x in plan.at.items():
        edge = top if net in NORTH else 0.0
        if net in present:
            trunk(canvas, tracks, net, x, *([edge] if net in ports else []))
        if net in ports:
            canvas.label(FOURTH, net, x, edge - 0.3 if edge else 0.3)
