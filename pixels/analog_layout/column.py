"""A column, lying, 10 um high at any pitch: the array in the west, the converters in the east; n transistors at y = 0.

    column_a ---- Cf Cf | front strip |  Cin  Cin  Cin  | back strip | Chold Chold Chold Chold Chold
    column_b ----       |             |                 |            |

    rail vdd   ================
               p  transistors of both charge amplifiers; of the second stages, the taps, the decoder
    rail vss   ================

Capacitors are metal-insulator-metal, their lower plates at what is driven. Under them run lines of the second metal,
each at its track's height in the strip that it comes from. What crosses all columns is on the fourth metal over the
strips: a column has a via at its own of the lanes' lines, of the groups' and of the places'.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.array import LOWER_ENCLOSURE, VIA_INSET
from talbot.pixels.analog_layout.cells import Cell, new_canvas
from talbot.pixels.analog_layout.device import Device, snap
from talbot.pixels.analog_layout.flat import Plate, Tap
from talbot.pixels.analog_layout.strip import (
    FOURTH,
    RAIL_AT,
    RAIL_HALF,
    RAIL_TRUNK,
    SECOND,
    THIRD,
    TRACK,
    TRACK_PITCH,
    Plan,
    Strip,
    draw_rails,
    draw_rows,
    in_columns,
    join_rails,
    name_track,
)
from talbot.pixels.circuits.column import CONTROLS, OF_TAPS, PINS, TAPS, TWICE, column
from talbot.pixels.circuits.column_block import GROUPS, PLACES
from talbot.pixels.circuits.column_sizes import FINGER, ColumnSizes
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
HEIGHT = 10.0  # of a column: a larger pitch leaves room between columns
RAIL_GAP = 1.2  # between the centres of adjacent columns' rails
ROWS = 13  # tracks in a strip
ROW_IN = 0.2  # from a rail's centre to the first track
PLATE_WIDTH = 8.2  # of a plate across the column
HALF_PLATE_GAP = 1.48  # between two plates above each other
LINE_WIDTH = 0.4  # of lines that cross all columns
LANE_WIDTH = 0.6  # of the lanes' lines
NARROW_WIDTH = 0.3  # of lines that pass plates
LINE_STEP = 0.2  # grid of the crossing lines' places
LINE_SPACE = 0.4  # between crossing lines
ROOM = 0.6  # next to each pair of devices, for its drops
FIRST_PLATE = 1.5  # from the array to the first plate
PLATE_VIA_AT = 1.54  # from an upper plate to its vias
NEXT_PLATE_AT = 3.08  # from an upper plate to the next plate (capm.2b_a)
PATCH_INSET = 0.3  # of the metal over an upper plate from its edges
PLATE_VIA_PITCH = 1.0
PLATE_VIA_PAD = 0.19, 0.33  # half width and height of the third metal at those vias: its least area
UNDER_WIDTH = 0.28  # of the lines under the plates
STRIP_TO_VIA = 0.35  # from a strip's end to its lines' vias
STRIP_TO_PLATE = 3.7
STRIP_TO_JOG = 2.2, 3.0  # from a strip's end to lines that leave on the fourth metal
SHIELD = 0.3  # width of the line of vss at a column's edge
FIRST_TRACK_VIA_INSET = 0.1  # in the strip: the rails are joined next to it
EXIT_Y = {"column_a": 1.7, "column_b": 8.3, "cin_b": 4.0, "cin_a": 2.0}  # of lines that leave on the fourth metal
RAILS = 1  # the metal of the rails
LANES = 8  # at most, with two lines for each diode
LANE_LINES = tuple(f"{name}_{d}" for name in ("lane", "sense") for d in "ab")
GROUPED = "group", "k", *LANE_LINES  # nets of which a column is on one of several lines
SINGLE = (*CONTROLS, *OF_TAPS, "vbp", "vcp", "level", "start", *TWICE)


@dataclass(frozen=True)
class Piece:
    """A strip of the column.

    n, p: its transistors from the west.
    west, east: nets that leave it below the adjacent plates.
    fixed: row of each net that leaves it at a fixed height.
    shields: quiet nets whose tracks are as long as the strip.
    over: nets whose tracks span another net's, as a shield.
    """

    n: tuple[str, ...]
    p: tuple[str, ...]
    west: tuple[str, ...] = ()
    east: tuple[str, ...] = ()
    fixed: Mapping[str, int] = field(default_factory=dict)
    shields: tuple[str, ...] = ()
    over: Mapping[str, str] = field(default_factory=dict)


class Cap(NamedTuple):
    """A capacitor next to a strip.

    lower, upper: nets of the plates.
    from_east: the strip of its lines is in the east.
    beside: F between the lines of both nets, as extracted.
    low, high: y of the upper plate.
    above: it is over the preceding capacitor, not east of it.
    """

    name: str
    lower: str
    upper: str
    from_east: bool = False
    beside: float = 0.0
    low: float = (HEIGHT - PLATE_WIDTH) / 2
    high: float = (HEIGHT + PLATE_WIDTH) / 2
    above: bool = False


def _hold(d: str, t: int, from_east: bool = False) -> Cap:
    tap = f"back_{d}.tap{t}."
    return Cap(f"{tap}hold", f"{tap}outer", f"{tap}inner", from_east, 4e-15 if t else 6e-15)


def _kick(d: str, from_east: bool = False) -> Cap:
    return Cap(f"back_{d}.kick", f"back_{d}.kick", f"back_{d}.x", from_east)


def _tap_piece(t: int) -> Piece:
    """Return the strip of a tap of the first diode, with its part of the decoder."""
    tap, on = f"back_a.tap{t}.", f"on{t}."
    through = "back_a.x", "back_a.f", "seln", "start_a"
    nets = f"{tap}inner", f"{tap}outer"
    rows = {"back_a.x": 5, "start_a": 6, nets[0]: 7, "back_a.f": 8, nets[1]: 9, "seln": 2}
    return Piece(
        (f"{on}nb", f"{on}na", f"{tap}join", f"{tap}write", f"{tap}far_n"),
        (f"{on}pb", f"{on}pa", "", f"{tap}far_p", f"{tap}rest"),
        through,
        (*(through if t < TAPS - 1 else ()), *nets),
        rows,
    )


PIECES = (
    Piece(
        (
            "front_a.clear",
            "front_a.in",
            "front_a.cascode",
            "front_b.clear",
            "front_b.in",
            "front_b.cascode",
            "half_rest",
            "half_a_n",
            "quarter_a_n",
            "quarter_b_n",
        ),
        (
            "",
            "front_a.top",
            "front_a.cascode_p",
            "",
            "front_b.top",
            "front_b.cascode_p",
            "",
            "half_a_p",
            "quarter_a_p",
            "quarter_b_p",
        ),
        ("out_a", "out_b"),
        ("out_a", "out_b", "quarter", "half", "cn", "vbp", "vcp"),
        # An output that comes near the other diode's line would be its light in it: out_a passes the second diode's
        # transistors below all that its line has, its line passes those of the first above all that out_a has
        {
            "out_a": 0,
            "clear": 1,
            "cn": 2,
            "column_a": 3,
            "quarter": 4,
            "vbp": 5,
            "edgen": 6,
            "half": 7,
            "vcp": 9,
            "out_b": 10,
            "edge": 11,
            "column_b": 12,
        },
        ("cn", "edge", "edgen", "vcp", "vbp"),
        {"edgen": "column_a", "vbp": "column_a", "clear": "column_b"},
    ),
    Piece(
        (
            "back_b.enter",
            "back_b.cascode",
            "back_b.reset",
            "back_b.tap0.write",
            "back_b.tap0.far_n",
            "back_b.tie",
            "back_b.in",
            "back_b.low",
            "back_b.tap0.join",
            "on0.na",
            "back_b.own_n",
            "back_b.drive",
            "select_n.nb",
            "select_n.na",
            "on0.nb",
            "go_b",
            "back_b.onto_n",
            "stop_b",
            "back_a.enter",
            "go_a",
            "back_a.in",
            "stop_a",
            "back_a.drive",
            "back_a.tap0.join",
            "back_a.cascode",
            "back_a.reset",
            "back_a.own_n",
            "back_a.tap0.write",
            "back_a.tie",
            "select.n",
            "back_a.onto_n",
            "back_a.low",
            "back_a.tap0.far_n",
        ),
        (
            "back_b.top",
            "back_b.cascode_p",
            "",
            "back_b.tap0.far_p",
            "",
            "back_b.tap0.rest",
            "back_b.high",
            "",
            "",
            "back_b.own_p",
            "",
            "select_n.pb",
            "",
            "",
            "select_n.pa",
            "",
            "back_b.onto_p",
            "",
            "on0.pb",
            "on0.pa",
            "",
            "",
            "select.p",
            "back_a.top",
            "",
            "back_a.cascode_p",
            "back_a.own_p",
            "",
            "",
            "back_a.onto_p",
            "back_a.tap0.far_p",
            "back_a.high",
            "back_a.tap0.rest",
        ),
        ("back_b.tap0.inner", "back_b.tap0.outer", "back_b.x", "back_b.kick", "cn", "vbp", "vcp"),
        ("back_a.x", "back_a.f", "seln", "start_a", "back_a.tap0.inner", "back_a.tap0.outer", "back_a.kick"),
        # Between x and what its sample is not to depend on: kick, start_a. Beside cin_a: no node of the other diode's
        {
            "cn": 2,
            "vbp": 5,
            "vcp": 9,
            "seln": 2,
            "cin_a": 0,
            "reads": 1,
            "cin_b": 4,
            "back_b.x": 6,
            "back_b.kick": 7,
            "back_b.tap0.inner": 8,
            "back_b.tap0.outer": 10,
            "back_b.above": 12,
            "start": 12,
            "back_b.f": 9,
            "back_b.out": 11,
            "sense_b": 11,
            "back_a.kick": 3,
            "back_a.x": 5,
            "start_a": 6,
            "back_a.tap0.inner": 7,
            "back_a.f": 8,
            "back_a.tap0.outer": 9,
        },
        over={"back_b.kick": "back_b.tap0.inner", "start_a": "back_a.x"},
    ),
    *map(_tap_piece, range(1, TAPS)),
)
# Between the strips, and at both ends of the column
CAPS = (
    (
        Cap("front_a.f", "out_a", "column_a", True, 0.6e-15, high=(HEIGHT - HALF_PLATE_GAP) / 2),
        Cap("front_b.f", "out_b", "column_b", True, 0.6e-15, low=(HEIGHT + HALF_PLATE_GAP) / 2, above=True),
    ),
    (
        Cap("in_a", "out_a", "cin_a"),
        Cap("in_quarter", "quarter", "cin_a"),
        Cap("in_half", "half", "cin_a"),
        Cap("in_b", "out_b", "cin_b"),
        _kick("b", True),
        _hold("b", 0, True)._replace(lower="back_b.tap0.inner", upper="back_b.tap0.outer"),  # cin_a passes above
    ),
    (_kick("a"), _hold("a", 0)),
    *((_hold("a", t),) for t in range(1, TAPS)),
)


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
            length = length_um(farads[cap.name] - cap.beside, masks, cap.high - cap.low)
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


def draw_column(canvas: Canvas, masks: AnalogMasks, positions: ColumnPlan) -> list[Strip]:
    """A column, its south edge at y = 0, with its part of the supplies that cross all columns, and vias to lines."""
    y, strips = RAIL_GAP / 2, list[Strip]()
    for plan in positions.strips:
        strip = draw_rows(canvas, masks, plan, y)
        draw_rails(canvas, masks, plan, y)
        join_rails(canvas, [strip])
        strips.append(strip)
    ends = positions.strips[0].left, positions.strips[-1].right
    for rail in (y, HEIGHT - y):  # next to the plates from strip to strip
        canvas.wire(RAILS, ends[0], rail - RAIL_HALF, ends[1], rail + RAIL_HALF)
    for x in positions.joints["vss"] + positions.joints["vdd"]:
        canvas.wire(FOURTH, x - RAIL_TRUNK / 2, 0, x + RAIL_TRUNK / 2, HEIGHT)
    for net in SINGLE:
        for strip in strips:
            for track in strip.tracks:
                if track.net == net and track.left <= positions.lines[net] <= track.right:
                    canvas.stack(positions.lines[net], track.y, THIRD, FOURTH)
    for plate in positions.plates:
        _plate(canvas, masks, plate)
    for number, strip in enumerate(strips):
        _leave(canvas, positions, strips, number, strip)
    return strips


def draw_ground(canvas: Canvas, positions: ColumnPlan, y: float, vias: Sequence[float] = ()) -> None:
    """The ground's lines in the south of a column whose edge is at ``y``: the outputs of the one below would be light.

    vias: x of others' there, before which a line ends.
    """
    for plan in positions.strips[:2]:
        joint = plan.left - RAIL_AT - RAIL_TRUNK / 2
        ends = [
            x - PLATE_VIA_PAD[1] - LINE_SPACE for x in vias if joint < x < plan.right + PLATE_VIA_PAD[1] + LINE_SPACE
        ]
        canvas.wire(THIRD, joint, y, min((*ends, plan.right)), y + SHIELD)
        canvas.wire(THIRD, joint, y, joint + RAIL_TRUNK, y + RAIL_GAP / 2)


def _plate(canvas: Canvas, masks: AnalogMasks, plate: Drawn) -> None:
    """A capacitor without its lines."""
    low, high = plate.cap.low, plate.cap.high
    canvas.box(masks.mim, plate.left, low, plate.right, high)
    # No tab at the vias' end: lines of others pass above
    canvas.wire(
        THIRD,
        plate.left - LOWER_ENCLOSURE,
        low - LOWER_ENCLOSURE,
        plate.right + LOWER_ENCLOSURE,
        high + LOWER_ENCLOSURE,
    )
    low, high = _patch(plate)
    draw_patch(canvas, plate.left + PATCH_INSET, low, plate.right - PATCH_INSET, high)


def draw_patch(canvas: Canvas, left: float, low: float, right: float, high: float) -> None:
    """Metal over an upper plate, with vias to it."""
    canvas.wire(FOURTH, left, low, right, high)
    for x in steps(left, right):
        for y in steps(low, high):
            canvas.square(canvas.process.vias[THIRD].gds, x, y, 0.2)


def steps(low: float, high: float) -> Iterator[float]:
    """Places of vias in a piece of metal."""
    count = max(1, int((high - low - 0.4) / PLATE_VIA_PITCH) + 1)
    for k in range(count):
        yield snap((low + high) / 2 + (k - (count - 1) / 2) * PLATE_VIA_PITCH)


def _patch(plate: Drawn) -> tuple[float, float]:
    """Return y of the metal over an upper plate, next to the passing lines of other plates."""
    if plate.cap.upper in EXIT_Y:
        y = EXIT_Y[plate.cap.upper]
        return y - 0.5, y + 0.5
    return (4.8, 8.8) if plate.cap.from_east else (1.2, 8.8)


def _leave(canvas: Canvas, positions: ColumnPlan, strips: Sequence[Strip], number: int, strip: Strip) -> None:
    """Draw the lines that leave a strip: on the fourth metal in the west, or on the second under the plates."""
    plan, half = strip.plan, UNDER_WIDTH / 2
    tracks = {net: track.y for track in strip.tracks for net in [track.net]}
    for net, jog in zip(("column_a", "column_b") if number == 0 else ("cin_a", "cin_b"), STRIP_TO_JOG, strict=True):
        if number < 2:
            x, y, to = plan.left - jog, tracks[net], EXIT_Y[net]
            west_ends = [drawn.left for drawn in positions.plates if drawn.cap.upper == net]
            first = 0.0 if number == 0 else min(west_ends) + PATCH_INSET
            if _lowest(y):  # passes the rail's joint on the second track
                end, y = plan.left + FIRST_TRACK_VIA_INSET, snap(y + TRACK_PITCH)
                canvas.wire(THIRD, x - TRACK / 2, y - TRACK / 2, end + TRACK / 2, y + TRACK / 2)
                canvas.wire(THIRD, end - TRACK / 2, tracks[net], end + TRACK / 2, y)
            canvas.stack(x, y, THIRD, FOURTH)
            canvas.wire(
                FOURTH, x - LINE_WIDTH / 2, min(y, to) - LINE_WIDTH / 2, x + LINE_WIDTH / 2, max(y, to) + LINE_WIDTH / 2
            )
            canvas.wire(FOURTH, first, to - NARROW_WIDTH / 2, x + LINE_WIDTH / 2, to + NARROW_WIDTH / 2)
    for plate in positions.plates:
        beside = CAPS.index(next(group for group in CAPS if plate.cap in group)) - (not plate.cap.from_east)
        if beside != number:
            continue
        for net, at in ((plate.cap.lower, VIA_INSET), (plate.cap.upper, PLATE_VIA_AT)):
            if net in EXIT_Y:
                continue
            west = plan.left + (FIRST_TRACK_VIA_INSET if _lowest(tracks[net]) else -STRIP_TO_VIA)
            start = west if plate.cap.from_east else plan.right + STRIP_TO_VIA
            x, y = plate.near + plate.way * at, _way(canvas, tracks[net], start)
            canvas.wire(SECOND, min(x, start), y - half, max(x, start), y + half)
            canvas.stack(x, y, SECOND, THIRD if net == plate.cap.lower else FOURTH)
            if net == plate.cap.upper:
                canvas.wire(
                    THIRD, x - PLATE_VIA_PAD[0], y - PLATE_VIA_PAD[1], x + PLATE_VIA_PAD[0], y + PLATE_VIA_PAD[1]
                )
                ends = x, plate.near - plate.way * PATCH_INSET
                canvas.wire(FOURTH, min(ends), y - LINE_WIDTH / 2, max(ends), y + LINE_WIDTH / 2)
    if number + 1 < len(strips):
        after = strips[number + 1]
        for net in sorted(set(PIECES[number].east) & set(PIECES[number + 1].west)):
            y, x0, x1 = tracks[net], plan.right + STRIP_TO_VIA, after.plan.left - STRIP_TO_VIA
            canvas.wire(SECOND, x0, y - half, x1, y + half)
            for x in (x0, x1):
                canvas.stack(x, y, SECOND, THIRD)


def _lowest(track: float) -> bool:
    """Return whether a track is the first one, next to a rail's joint in the west."""
    return track < RAIL_GAP / 2 + ROW_IN + TRACK_PITCH / 2


def _way(canvas: Canvas, track: float, x: float) -> float:
    """Y at which a net of ``track`` leaves a strip under the plates: of the first track the second's, for the rail."""
    y = snap(track + TRACK_PITCH) if _lowest(track) else track
    canvas.stack(x, track, SECOND, THIRD)
    canvas.wire(SECOND, x - UNDER_WIDTH / 2, track, x + UNDER_WIDTH / 2, y + UNDER_WIDTH / 2)
    return y


def as_cell(canvas: Canvas, d: Mapping[str, Device], plan: ColumnPlan, strips: Sequence[Strip]) -> Cell:
    """Return the drawn column with its circuit's names."""
    plates, taps = list[Plate](), list[Tap]()
    for cap, left, right in plan.plates:
        edges = right - left, cap.high - cap.low
        plates.append(Plate(cap.name, cap.upper, cap.lower, edges[0] * edges[1], 2 * sum(edges)))
        taps.append(Tap(cap.name, 1, (left + right) / 2, (cap.low + cap.high) / 2))
    terminals = tuple(terminal for strip in strips for terminal in strip.terminals)
    tracks = tuple(track for strip in strips for track in strip.tracks)
    return Cell(canvas.layout, canvas.cell, PINS, tuple(d.values()), tuple(plates), terminals, tuple(taps), tracks)


def column_cell(masks: AnalogMasks, sizes: ColumnSizes) -> Cell:
    """Return a column alone, its pins named where its lines are: what is checked and extracted."""
    d, canvas = devices(sizes), new_canvas(masks, "column")
    plan = column_plan(d, sizes, masks)
    cell = as_cell(canvas, d, plan, draw_column(canvas, masks, plan))
    draw_ground(canvas, plan, 0.0)
    for net in PINS:
        if net in ("column_a", "column_b"):
            canvas.label(FOURTH, net, 0.2, EXIT_Y[net])
        elif net in SINGLE:
            canvas.wire(FOURTH, plan.lines[net] - LINE_WIDTH / 2, 0, plan.lines[net] + LINE_WIDTH / 2, HEIGHT)
            canvas.label(FOURTH, net, plan.lines[net], 0.2)
        elif net in GROUPED:
            name_track(canvas, next(track for track in cell.tracks if track.net == net))
    for net, y in (("vss", RAIL_GAP / 2), ("vdd", HEIGHT - RAIL_GAP / 2)):
        canvas.label(RAILS, net, plan.strips[0].left, y)
    canvas.box(masks.base.outline, 0, 0, plan.right, HEIGHT)
    return cell
