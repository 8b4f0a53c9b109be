"""Places of a column's parts, and of the lines that cross all columns."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.column_parts import CAPS, HEIGHT, PIECES, PLATE_WIDTH, Cap, Piece
from talbot.pixels.analog_layout.device import Device, snap
from talbot.pixels.analog_layout.strip import RAIL_AT
from talbot.pixels.analog_layout.strip_plan import Plan, in_columns
from talbot.pixels.circuits.column import CONTROLS, OF_TAPS, TWICE, column
from talbot.pixels.circuits.column_block import GROUPS, PLACES
from talbot.pixels.circuits.column_sizes import FINGER, ColumnSizes
from talbot.platforms.analog import AnalogMasks

# um
RAIL_GAP = 1.2  # between the centres of adjacent columns' rails
ROWS = 13  # tracks in a strip
ROW_IN = 0.2  # from a rail's centre to the first track
LINE_WIDTH = 0.4  # of lines that cross all columns
LANE_WIDTH = 0.6  # of the lanes' lines
LINE_STEP = 0.2  # grid of the crossing lines' places
LINE_SPACE = 0.4  # between crossing lines
ROOM = 0.6  # next to each pair of devices, for its drops
FIRST_PLATE = 1.5  # from the array to the first plate
PLATE_VIA_AT = 1.54  # from an upper plate to its vias
NEXT_PLATE_AT = 3.08  # from an upper plate to the next plate (capm.2b_a)
STRIP_TO_VIA = 0.35  # from a strip's end to its lines' vias
STRIP_TO_PLATE = 3.7
STRIP_TO_JOG = 2.2, 3.0  # from a strip's end to lines that leave on the fourth metal
FIRST_TRACK_VIA_INSET = 0.1  # in the strip: the rails are joined next to it
EXIT_Y = {"column_a": 1.7, "column_b": 8.3, "cin_b": 4.0, "cin_a": 2.0}  # of lines that leave on the fourth metal
LANES = 8  # at most, with two lines for each diode
LANE_LINES = tuple(f"{name}_{d}" for name in ("lane", "sense") for d in "ab")
GROUPED = "group", "k", *LANE_LINES  # nets of which a column is on one of several lines
SINGLE = (*CONTROLS, *OF_TAPS, "vbp", "vcp", "level", "start", *TWICE)


class Drawn(NamedTuple):
    """A plate that is to be drawn: x of its ends."""

    cap: Cap
    left: float
    right: float

    @property
    def near(self) -> float:
        """Return x of the end at which its lines arrive."""
        return self.right if self.cap.from_east else self.left

    @property
    def way(self) -> int:
        """Return the direction from there away from the plate."""
        return 1 if self.cap.from_east else -1


@dataclass(frozen=True)
class ColumnPlan:
    """Positions of a column's parts, um.

    lines: x of the lines that cross all columns.
    joints: x of the supplies that cross all columns.
    plates: of the capacitors.
    right: its east end.
    free: names of additional lines that cross all columns.
    lanes: converters, of each of which two lines a diode cross all columns.
    """

    strips: tuple[Plan, ...]
    lines: Mapping[str, float]
    joints: Mapping[str, tuple[float, ...]]
    plates: tuple[Drawn, ...]
    right: float
    free: tuple[str, ...] = ()
    lanes: int = LANES


def line_um(net: str) -> float:
    """Width of the lines of a net that cross all columns."""
    return LANE_WIDTH if net.startswith(("lane", "sense")) else LINE_WIDTH


def length_um(farad: float, masks: AnalogMasks, wide: float = PLATE_WIDTH) -> float:
    """Return the length of a plate ``wide`` um across. Raises ParameterError below 1 um."""
    area, edge = masks.mim_area, masks.mim_edge
    length = snap((farad * 1e15 - 2 * edge * wide) / (area * wide + 2 * edge))
    if length < 1:
        raise ParameterError(f"capacitor = {farad:g} F: must be 1 um long at the least, {wide:g} um wide")
    return length


def devices(sizes: ColumnSizes) -> dict[str, Device]:
    """All transistors of a column, in fingers that fit its pitch."""
    return {t.name: Device.of(t, FINGER) for t in flat.transistors(column(sizes))}


def names(net: str, lanes: int = LANES) -> tuple[str, ...]:
    """Lines that cross all columns, of a pin of a column."""
    count = {"group": GROUPS, "k": PLACES, **dict.fromkeys(LANE_LINES, lanes)}.get(net)
    return (net,) if count is None else tuple(f"{net}{k}" for k in range(count))


def column_plan(
    d: Mapping[str, Device], sizes: ColumnSizes, masks: AnalogMasks, extra: Iterable[str] = (), lanes: int = LANES
) -> ColumnPlan:
    """Plan a column. extra: names of additional lines across. lanes: converters, 1..LANES.

    Raises ParameterError where a strip has more nets than tracks, or a line no place.
    """
    farads = {c.name: c.value for c in flat.capacitors(column(sizes))}
    x, plates, strips = FIRST_PLATE, list[Drawn](), list[Plan]()
    lines, joints = dict[str, float](), dict[str, tuple[float, ...]]()
    for number, group in enumerate(CAPS):
        for k, cap in enumerate(group):
            left = plates[-1].left if cap.above else snap(x + NEXT_PLATE_AT * (k > 0))
            length = length_um(farads[cap.name] - cap.between_lines, masks, cap.high - cap.low)
            plates.append(Drawn(cap, left, snap(left + length)))
            x = max(x, plates[-1].right) if cap.above else plates[-1].right
        if number == len(PIECES):
            break
        piece = PIECES[number]
        left = snap(
            x
            + STRIP_TO_PLATE
            + (STRIP_TO_JOG[1] - STRIP_TO_JOG[0] + PLATE_VIA_AT if group[-1].upper in EXIT_Y or number == 1 else 0.0)
        )
        strip, strip_lines = _strip(piece, d, left, number, lines, lanes)
        strips.append(strip)
        lines |= strip_lines
        joints |= {"vss": (*joints.get("vss", ()), strip.left - RAIL_AT)}
        joints |= {"vdd": (*joints.get("vdd", ()), strip.right + RAIL_AT)}
        x = strip.right + STRIP_TO_PLATE
    if lacking := {line for net in (*GROUPED, *SINGLE) for line in names(net, lanes)} - lines.keys():
        raise ParameterError(f"column: line {min(lacking)} must have a place")
    for name in extra:
        taken = [(at, (line_um(name_of_line) + LINE_WIDTH) / 2 + LINE_SPACE) for name_of_line, at in lines.items()]
        places = (
            snap(s.left + LINE_STEP * k) for s in strips for k in range(2, int((s.right - s.left) / LINE_STEP) - 1)
        )
        free = (place for place in places if all(abs(place - at) >= apart - 1e-9 for at, apart in taken))
        lines[name] = next(free, -1.0)
        if lines[name] < 0:
            raise ParameterError(f"column strips: must have room for line {name}")
    return ColumnPlan(tuple(strips), lines, joints, tuple(plates), snap(x + PLATE_VIA_AT), tuple(extra), lanes)


def _strip(
    piece: Piece, d: Mapping[str, Device], left: float, number: int, known: Collection[str], lanes: int
) -> tuple[Plan, dict[str, float]]:
    """Return a strip, and the lines over it that are not ``known``."""
    count = max(len(piece.n), len(piece.p))
    n, p = ([d.get(name) for name in row] + [None] * (count - len(row)) for row in (piece.n, piece.p))
    ways = (("column_a", "column_b"), ("cin_a", "cin_b"))[number] if number < 2 else ()
    lowest = [net for net in (*piece.west, *ways) if piece.fixed.get(net) == 0]
    row_n, row_p, right = in_columns(list(zip(n, p, strict=True)), left + ROOM * len(lowest), ROOM)
    ends: dict[str, tuple[float, ...]] = {
        net: (left + (FIRST_TRACK_VIA_INSET if net in lowest else -STRIP_TO_VIA),) for net in piece.west
    }
    ends |= {net: (*ends.get(net, ()), right + STRIP_TO_VIA) for net in piece.east}
    ends |= {net: (*ends.get(net, ()), left + 0.5, right - 0.5) for net in piece.shields}
    present = {net for placed in (*row_n, *row_p) for net in placed.device.transistor.nodes}
    ends |= {
        net: (left + FIRST_TRACK_VIA_INSET if net in lowest else left - jog,)
        for net, jog in zip(ways, STRIP_TO_JOG, strict=False)
    }
    plain = Plan(row_n, row_p, left, right, ends)
    for net, other in piece.over.items():
        ends[net] = (*ends.get(net, ()), *plain.spans()[other])
    lines = _lines(plain, {net for net in present if names(net)[0] not in known}, left, right, number, lanes)
    for net in sorted(present & {*GROUPED, *SINGLE}):
        if names(net)[0] in lines:
            ends[net] = (*ends.get(net, ()), lines[names(net)[0]], lines[names(net, lanes)[-1]])
    plan = Plan(
        row_n, row_p, left, right, ends, least_um=HEIGHT - RAIL_GAP, fixed=piece.fixed, least_rows=ROWS, track_in=ROW_IN
    )
    if plan.height_um > HEIGHT - RAIL_GAP + 1e-9:
        rows = round((plan.height_um - (HEIGHT - RAIL_GAP)) / 0.7) + ROWS
        raise ParameterError(f"column strip {number} = {rows} tracks: must be {ROWS} at most")
    return plan, lines


def _lines(plan: Plan, present: set[str], left: float, right: float, number: int, lanes: int) -> dict[str, float]:
    """Return x of the lines over a strip: a group's lines together, each as near as possible to its gates."""
    spans, taken, lines = plan.spans(), list[tuple[float, float]](), dict[str, float]()
    crossing = sorted((set(GROUPED) | set(SINGLE)) & present)
    crossing.sort(key=lambda net: (-len(names(net, lanes)), spans[net][1] - spans[net][0]))
    places = [snap(left + LINE_STEP * k) for k in range(2, int((right - left) / LINE_STEP) - 1)]
    for net in crossing:
        half = line_um(net) / 2
        pitch, count = 2 * half + LINE_SPACE, len(names(net, lanes))
        low, high = spans[net]
        middle = (low + high) / 2 - pitch * (count - 1) / 2

        def free(x: float, half: float = half, pitch: float = pitch, count: int = count) -> bool:
            ends = x - half, x + pitch * (count - 1) + half
            return ends[1] <= right - 0.2 and all(
                ends[1] + LINE_SPACE <= a + 1e-9 or b + LINE_SPACE <= ends[0] + 1e-9 for a, b in taken
            )

        place = min(filter(free, places), key=lambda x: abs(x - middle), default=None)
        if place is None:
            raise ParameterError(f"column strip {number} = {right - left:.0f} um: must have room for line {net}")
        taken.append((place - half, place + pitch * (count - 1) + half))
        lines |= {line: snap(place + pitch * k) for k, line in enumerate(names(net, lanes))}
    return lines
