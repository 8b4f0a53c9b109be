"""The difference amplifier: the operational amplifier between the banks of its two inputs, the trim's switches beyond.

    pick         switches of both columns, with their gates      north: column_a, column_b
    trim         10 inverters and selectors, in two strips
    bank         common node xp: trim, and what evens it out
    load         mirror, cascodes; switches of reset and rest
    pair         half of the pair's parts over half of the sinks
    tails        parts of the tail, mirrors of the bias
    pair         the other half
    bank         common node xm: both parts of a, feedback
                                                                 south: out, vref, ibias, wake, reset, g9 .. g0, mode

Both sides of the pair have the same middle in every strip, and every row of parts ends with dummies.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.amplifier_bank import BankPlan, draw_bank, units
from talbot.pixels.analog_layout.cells import MARGIN, Cell, new_canvas
from talbot.pixels.analog_layout.comparator import BETWEEN_STRIPS
from talbot.pixels.analog_layout.device import Device, snap
from talbot.pixels.analog_layout.row_driver import legs
from talbot.pixels.analog_layout.rows import dummies, row
from talbot.pixels.analog_layout.strip import (
    FOURTH,
    RAIL_ENDS,
    RAIL_HALF,
    SECOND,
    THIRD,
    WELL_ENDS,
    draw_strip,
    join_rails,
    trunk,
)
from talbot.pixels.analog_layout.strip_plan import TRUNK, Placed, Plan, in_columns
from talbot.pixels.circuits.amplifier import LATE, PICK, PINS, TRIM_BITS, AmplifierSizes, amplifier
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
STRIP_LENGTH = 92.0
BANK_WEST = 16.5  # x of a bank's first finger
BANK_SPACE = 1.6  # from a bank to a rail
FIRST_TRUNK = 0.9  # x of the first trunk next to the banks
TRUNK_PITCH = 1.0
FIRST_OVER_STRIPS = 20.0  # x of the first trunk over the strips
OVER_STRIPS_PITCH = 4.0
PATCH_HALF = 0.35  # half length of the third metal where a common node goes up
RAIL_VIAS = 24  # of a rail
RAIL_VIA_SPACE = 0.5  # from a rail's vias to other vias
BIAS_ROOM = 5.0  # additional room between the bias's transistors, for drops between those of the tails
# Parts in a strip, from the west: of side p or n of the pair and of the sinks; a capital steers, or is a diode
PAIR_ORDER = "pnnPPnnp", "nppNNppn"
SINK_ORDER = "pnNPnp", "pnnppn"
NORTH = "column_a", "column_b"
WEST = ("whole", "half", "out", *(f"bottom{k}" for k in reversed(range(TRIM_BITS))), "vref")
EAST = ("trim", *(f"g{k}" for k in range(TRIM_BITS)), "reset", "on", "wake", *PICK)
OVER_PICK = {"column_a": 24.0, "column_b": 68.0}  # x of the columns' pins
PICK_GATES = ("not_mode", "plain", "raw", "not_sub", "nand_first", "drive_first", "nand_second", "drive_second")
WAKE_GATES = (*(f"late{k}" for k in range(LATE)), "asleep", "awake")
INNER = ("tail", "fold_p", "steer_n", "diode_p", "vcn"), ("vcp", "diode_n", "steer_p", "fold_n")  # west, east
INPUTS = "xm", "xp"


def bank_nets(side: str) -> dict[str, str]:
    """Nets of a bank's capacitors: side m has both parts of a, feedback and rest; side p the trim and rest."""
    if side == "m":
        return {name: {"b9": "whole", "b8": "half", "rest": "out"}.get(name, "vref") for name in units()}
    nets = {f"b{k}": f"bottom{k}" for k in range(TRIM_BITS)}
    return {name: nets.get(name, "vref") for name in units()}


def matched_units() -> dict[tuple[str, str], int]:
    """Units between each two nets of the drawn amplifier."""
    total: dict[tuple[str, str], int] = {}
    for side in "mp":
        nets = bank_nets(side)
        for name, count in units().items():
            key = min(f"x{side}", nets[name]), max(f"x{side}", nets[name])
            total[key] = total.get(key, 0) + count
    return total


def devices(sizes: AmplifierSizes, chip: bool = False) -> dict[str, Device]:
    """All transistors by name, in fingers; dummies at the ends of rows, too. chip: see `amplifier`."""
    by_name = {t.name: Device.of(t) for t in flat.transistors(amplifier(sizes, chip))}
    for name, like in (("pair0", "inp_0"), ("pair1", "inp_0"), ("sink0", "sink_p_0"), ("sink1", "sink_p_0")):
        by_name |= dummies(name, by_name[f"ota.{like}"])
    return by_name | dummies("tails", by_name["ota.tail_0"]) | dummies("load", by_name["ota.down_p"])


def _order(orders: Sequence[str], names: str, capital: str) -> list[list[str]]:
    """Names of parts by strip. names, capital: with {side} and {k}, which counts."""
    counts: dict[str, Iterator[int]] = {letter: iter(range(100)) for letter in "pnPN"}
    return [
        [(capital if a.isupper() else names).format(side=a.lower(), k=next(counts[a])) for a in order]
        for order in orders
    ]


@dataclass(frozen=True)
class AmplifierPlan:
    """Strips of the operational amplifier, of the trim and of the columns' switches, from the south; both banks; x of
    the nets between them.
    """

    strips: tuple[Plan, ...]
    trim: tuple[Plan, ...]
    banks: tuple[BankPlan, BankPlan]
    at: Mapping[str, float]


def places() -> dict[str, float]:
    """Return x of the nets between strips."""
    at = {net: FIRST_TRUNK + TRUNK_PITCH * k for k, net in enumerate(WEST)}
    at |= {net: STRIP_LENGTH - FIRST_TRUNK - TRUNK_PITCH * k for k, net in enumerate(reversed(EAST))}
    west, east = ([f"ota.{net}" for net in side] for side in INNER)
    at |= {net: FIRST_OVER_STRIPS + OVER_STRIPS_PITCH * k for k, net in enumerate((*west, "ibias"))}
    at |= {net: STRIP_LENGTH - FIRST_OVER_STRIPS - OVER_STRIPS_PITCH * k for k, net in enumerate((*east, "off"))}
    return at | OVER_PICK | {net: STRIP_LENGTH / 2 + way * 1.5 for net, way in zip(INPUTS, (-1, 1), strict=True)}


def amplifier_plan(d: Mapping[str, Device], masks: AnalogMasks, sizes: AmplifierSizes) -> AmplifierPlan:
    """Plan an amplifier. Raises ParameterError where a row is too long."""
    at, axis = places(), STRIP_LENGTH / 2

    def plan(n: tuple[Placed, ...], p: tuple[Placed, ...]) -> Plan:
        present = {net for placed in (*n, *p) for net in placed.device.transistor.nodes}
        for row_end, first in ((placed_row[-1].high, placed_row[0].device.transistor.name) for placed_row in (n, p)):
            if row_end > STRIP_LENGTH:
                long = 2 * row_end - STRIP_LENGTH
                raise ParameterError(f"row of {first} = {long:.1f} um: must be {STRIP_LENGTH:g} um at the most")
        return Plan(n, p, 0.0, STRIP_LENGTH, {net: (x,) for net, x in at.items() if net in present})

    pairs = _order(PAIR_ORDER, "ota.in{side}_{k}", "ota.in{side}_steer_{k}")
    sinks = _order(SINK_ORDER, "ota.sink_{side}_{k}", "ota.diode_{side}")
    halves = []
    for k, (pair, sink) in enumerate(zip(pairs, sinks, strict=True)):
        n, p = ((f"{kind}{k}_west", *order, f"{kind}{k}_east") for kind, order in (("sink", sink), ("pair", pair)))
        halves.append(plan(row(d, n, axis), row(d, p, axis)))
    parts = [name for name in d if name.startswith(("ota.tail_", "ota.boost_")) and "_on" not in name]
    middle = len(parts) // 2
    tails = ("tails_west", *parts[:middle], "ota.bias_p", *parts[middle:], "tails_east")
    rest = ("ota.boost_on_0", "ota.boost_on_1", "ota.bias_to_n", "ota.off_p", "ota.cascode_p")
    biases = ("take", "off_n", "bias_n", "bias_to_p_0", "bias_to_p_1", "bias_to_pc", "off_cascode", "stack_n")
    biases = (*(f"ota.{name}" for name in biases), "ota.stack_low")
    load = ("load_west", "ota.down_p", "ota.top_p", "ota.top_n", "ota.down_n", "load_east")
    gates = ("on_n", "reset_n")
    switches = ("zero", "follow", "rest")
    above = ("diode_cascode_p", "up_p", "up_n", "diode_cascode_n")
    n = (*(f"ota.{name}" for name in above), *(f"{name}_n" for name in switches), *(f"{name}.n" for name in gates))
    p = (*load, *(f"{name}_p" for name in switches), *(f"{name}.p" for name in gates))
    strips = (
        halves[0],
        plan(row(d, biases, axis, BIAS_ROOM), row(d, (*tails, *rest), axis)),
        halves[1],
        plan(row(d, n, axis), row(d, p, axis)),
    )
    trim = []
    for bits in (range(5, TRIM_BITS), range(5)):
        columns = []
        for k in bits:
            columns += [(d[f"not{k}.n"], d[f"not{k}.p"]), (d[f"select{k}.n"], d[f"select{k}.p"])]
            columns.append((d[f"select{k}.r"], None))
        trim.append(columns)
    switches = [(d[f"pick.{name}_n"], d[f"pick.{name}_p"]) for name in ("whole", "first", "second", "trim")]
    rests = [(d[f"pick.{name}_r"], None) for name in ("whole", "half", "trim")]
    gates = [pair for name in (*(f"pick.{gate}" for gate in PICK_GATES), *WAKE_GATES) for pair in legs(d, name)]
    trim.append([switches[0], rests[0], switches[1], rests[1], *gates, switches[2], rests[2], switches[3]])
    for k, columns in enumerate(trim):
        room = (STRIP_LENGTH - in_columns(columns, 0.0)[2]) / len(columns) - 1e-3
        trim[k] = plan(*in_columns(columns, 0.0, min(room, 2.0))[:2])
    ends = {net: x - TRUNK / 2 for net, x in at.items()}
    length = masks.finger_um(sizes.unit)
    banks = tuple(BankPlan(length, bank_nets(side), f"x{side}", ends, BANK_WEST) for side in "mp")
    return AmplifierPlan(strips, tuple(trim), (banks[0], banks[1]), at)


def amplifier_cell(masks: AnalogMasks, sizes: AmplifierSizes, chip: bool = False) -> Cell:
    """Draw an amplifier; its south-west corner is at the origin but for the rails' ends. chip: see the circuit's."""
    d = devices(sizes, chip)
    plan, canvas = amplifier_plan(d, masks, sizes), new_canvas(masks, "adc_amplifier" if chip else "amplifier")
    banks = [draw_bank(canvas, plan.banks[0], masks.fringe, MARGIN)]
    y, strips = MARGIN + plan.banks[0].height_um + BANK_SPACE, []
    for strip_plan in plan.strips:
        strips.append(draw_strip(canvas, masks, strip_plan, y))
        y += strip_plan.height_um + BETWEEN_STRIPS
    inner = tuple(strips)
    y += BANK_SPACE - BETWEEN_STRIPS
    banks.append(draw_bank(canvas, plan.banks[1], masks.fringe, y, upright=False))
    y += plan.banks[1].height_um + BANK_SPACE
    for strip_plan in plan.trim:
        strips.append(draw_strip(canvas, masks, strip_plan, y))
        y += strip_plan.height_um + BETWEEN_STRIPS
    top = y - BETWEEN_STRIPS + MARGIN
    join_rails(canvas, strips)
    for strip in strips:
        for k, net in enumerate(strip.plan.rails):
            _thicker(canvas, strip.y + k * strip.plan.height_um, [x for other, x, _, _ in strip.drops if other == net])
    tracks = [track for part in (*strips, *banks) for track in part.tracks]
    for net, x in plan.at.items():
        if net in INPUTS:
            bank = banks[INPUTS.index(net)]
            end = bank.ends[1 - INPUTS.index(net)]
            _up(canvas, x, end)
            trunk(canvas, [track for part in inner for track in part.tracks], net, x, end)
            continue
        edge = [top if net in NORTH else 0.0] if net in PINS else []
        trunk(canvas, tracks, net, x, *edge)
        if edge:
            canvas.label(FOURTH, net, x, edge[0] - 0.3 if net in NORTH else 0.3)
    beyond = RAIL_ENDS + WELL_ENDS
    canvas.box(masks.base.outline, -beyond, 0, STRIP_LENGTH + beyond, top)
    ends = tuple(terminal for strip in strips for terminal in strip.terminals)
    return Cell(
        canvas.layout, canvas.cell, PINS, tuple(d.values()), terminals=ends, matched=matched_units(), unit=sizes.unit
    )


def _thicker(canvas: Canvas, y: float, drops: Sequence[float]) -> None:
    """A rail on two more metals, for its current. drops: x at which it has vias."""
    left, right = -RAIL_ENDS, STRIP_LENGTH + RAIL_ENDS
    for level in (SECOND, THIRD):
        canvas.wire(level, left, y - RAIL_HALF, right, y + RAIL_HALF)
    for k in range(RAIL_VIAS):
        x = snap(left + (k + 0.5) * (right - left) / RAIL_VIAS)
        if all(abs(x - drop) > RAIL_VIA_SPACE for drop in drops):
            canvas.stack(x, y, 1, THIRD)


def _up(canvas: Canvas, x: float, y: float) -> None:
    """Draw the vias from a common node's spine to the trunks' metal."""
    canvas.stack(x, y, SECOND, FOURTH)
    canvas.wire(THIRD, x - PATCH_HALF, y - 0.19, x + PATCH_HALF, y + 0.19)
