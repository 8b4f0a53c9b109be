"""A strip: a row of n transistors below a row of p transistors, or one of them, between the rails, and its nets.

    rail vdd  =========================   taps of the n well under it
              p transistors                every net has a track along the strip on the third metal; from each strap of
              - - tracks - - - - - -       a transistor a drop on the second metal goes to its net's track
              n transistors
    rail vss  =========================   taps of the substrate under it

In a strip with an axis every device has its mirror image, and so have drops and tracks: two nets of one side each
(``split``) have the halves of one track; two nets that are on both sides (``twisted``) have halves of two tracks and
change places on the axis. What is not symmetric is that crossing alone.
"""

from bisect import bisect_left, bisect_right, insort
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import NamedTuple

from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout.device import IMPLANT, RAIL, STRAP, WELL_AROUND, Device, Strap, draw_device
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
GAP = 0.40  # between adjacent diffusions
ROW_SPACE = 1.5  # between the diffusions of the two rows
TRACK = 0.38  # width of a track
TRACK_PITCH = 0.70
TRACK_IN = 0.85  # from a rail's centre to the first track
DROP = 0.37  # width of a drop
DROP_PITCH = 0.52
DROP_STEP = 0.02  # grid of the drops' places
DROP_ENDS = 0.55
RAIL_HALF = 0.245
TAP_HALF = 0.21
TAP_PITCH = 0.68
OPEN_ENDS = 0.72  # beyond a single row's gates
WELL_ENDS = 0.50  # of the well beyond its taps
RAIL_ENDS = 1.7  # of a rail beyond the tracks
RAIL_AT = 1.0  # from a strip's end to the metal that joins rails
RAIL_TRUNK = 1.0  # its width
TRUNK = 0.5  # um, width of a net from strip to strip
SPLIT = 0.2  # from the axis to the halves of tracks
CROSS = 0.9  # from the axis to their crossing
FIRST, SECOND, THIRD, FOURTH = 1, 2, 3, 4
TRIES = 60
Place = tuple[float, float, float]  # x, low, high of a drop


@dataclass(frozen=True)
class Placed:
    """A device whose diffusion begins at ``x`` (um); its straps may be from ``low`` to ``high``."""

    device: Device
    x: float
    low: float
    high: float


@dataclass(frozen=True)
class Plan:
    """A strip before it is drawn.

    n, p: its rows.
    left, right: its ends, um.
    through: by net, x to which the tracks of nets that meet other strips reach.
    split, twisted: pairs of nets that are mirror images, the western one first.
    axis: of its symmetry, or None.
    rails: nets without tracks, the lower rail's first.
    quiet: nets whose tracks are grouped, away from the others.
    least_um: smallest height.
    fixed: rows of nets that continue in other strips at the same height.
    least_rows: smallest number of tracks.
    track_in: um from a rail's centre to the first track.
    """

    n: tuple[Placed, ...]
    p: tuple[Placed, ...]
    left: float
    right: float
    through: Mapping[str, Sequence[float]]
    split: tuple[tuple[str, str], ...] = ()
    twisted: tuple[tuple[str, str], ...] = ()
    axis: float | None = None
    rails: tuple[str, ...] = ("vss", "vdd")
    quiet: frozenset[str] = frozenset()
    least_um: float = 0.0
    fixed: Mapping[str, int] = field(default_factory=dict)
    least_rows: int = 0
    track_in: float = TRACK_IN

    @property
    def height_um(self) -> float:
        """Return the distance between the rails' centres."""
        heights = [max((placed.device.finger_um for placed in row), default=0.0) for row in (self.n, self.p)]
        between = ROW_SPACE if self.n and self.p else OPEN_ENDS
        devices = 2 * RAIL + sum(heights) + between
        return max(devices, 2 * self.track_in + TRACK_PITCH * (len(self._rows()) - 1), self.least_um)

    def placed(self) -> tuple[Placed, ...]:
        """All devices."""
        return (*self.n, *self.p)

    def spans(self) -> dict[str, tuple[float, float]]:
        """(left, right) of every net's track that there may be a drop on, um."""
        by_net: dict[str, tuple[float, float]] = {}
        for placed in self.placed():
            t = placed.device.transistor
            for net in [net for net in dict.fromkeys((t.drain, t.gate, t.source)) if net not in self.rails]:
                left, right = by_net.get(net, (placed.low, placed.high))
                by_net[net] = min(left, placed.low), max(right, placed.high)
        for net, reached in self.through.items():
            ends = [x + side * TRUNK / 2 for x in reached for side in (-1, 1)]
            by_net[net] = min([*by_net[net][:1], *ends]), max([*by_net[net][1:], *ends])
        if self.axis is not None:
            by_net = {net: (min(a, 2 * self.axis - b), max(b, 2 * self.axis - a)) for net, (a, b) in by_net.items()}
        return by_net

    def _rows(self) -> list[list[tuple[str, float, float]]]:
        """(net, left, right) of what is on each track, from the first track on."""
        spans, rows = self.spans(), list[list[tuple[str, float, float]]]()
        for pair in (*self.split, *self.twisted):
            left, right = min(spans[net][0] for net in pair), max(spans[net][1] for net in pair)
            away, axis = SPLIT if pair in self.split else CROSS, self.axis or 0.0
            ends = (left, axis - away), (axis + away, right)
            for nets in (pair, pair[::-1])[: 1 if pair in self.split else 2]:
                rows.append([(net, *end) for net, end in zip(nets, ends, strict=True)])
        paired = {net for pair in (*self.split, *self.twisted) for net in pair}
        rows += [[] for _ in range(self.least_rows - len(rows))]
        for net in sorted(self.fixed.keys() & spans.keys()):
            rows[self.fixed[net]].append((net, *spans[net]))
        paired |= self.fixed.keys()
        for kind in (spans.keys() & self.quiet - paired, spans.keys() - self.quiet - paired):
            fixed = 0 if self.least_rows else len(rows)
            for net in sorted(kind, key=lambda net: (spans[net][0] - spans[net][1], net)):
                a, b = spans[net]
                fitting = (row for row in rows[fixed:] if all(b + 1 < c or d + 1 < a for _, c, d in row))
                row = next(fitting, None)
                if row is None:
                    row = []
                    rows.append(row)
                row.append((net, a, b))
        return rows

    def tracks(self) -> list[Strap]:
        """Tracks by their height over the lower rail, um: spread about the middle."""
        rows = self._rows()
        first = self.height_um / 2 - TRACK_PITCH * (len(rows) - 1) / 2
        return [Strap(net, a, b, first + TRACK_PITCH * k) for k, row in enumerate(rows) for net, a, b in row]


class Terminal(NamedTuple):
    """The point where a transistor meets the first metal."""

    device: str
    strap: Strap


@dataclass
class Strip:
    """A drawn strip.

    y: of its lower rail's centre.
    tracks: segments of the nets' tracks.
    drops: (net, x, low, high).
    terminals: of its transistors.
    """

    plan: Plan
    y: float
    tracks: list[Strap] = field(default_factory=list)
    drops: list[tuple[str, float, float, float]] = field(default_factory=list)
    terminals: list[Terminal] = field(default_factory=list)


def draw_strip(canvas: Canvas, masks: AnalogMasks, plan: Plan, y: float) -> Strip:
    """Draw a strip, the middle of its lower rail at ``y``. Raises ParameterError where a drop has no room."""
    strip = draw_rows(canvas, masks, plan, y)
    draw_rails(canvas, masks, plan, y)
    return strip


def draw_rows(canvas: Canvas, masks: AnalogMasks, plan: Plan, y: float) -> Strip:
    """Return a strip's transistors and nets, without rails and well."""
    strip, top = Strip(plan, y), y + plan.height_um
    strip.tracks = [track._replace(y=y + track.y) for track in plan.tracks()]
    straps: list[tuple[Strap, Placed]] = []
    for row, rail_y, upright in ((plan.n, y, True), (plan.p, top, False)):
        for placed in row:
            drawn = draw_device(canvas, masks, placed.device, placed.x, rail_y, upright, (placed.low, placed.high))
            strip.terminals += [Terminal(placed.device.transistor.name, s) for s in drawn]
            straps += [(s, placed) for s in drawn if not s.railed]
    _drops(canvas, strip, straps)
    for track in strip.tracks:
        canvas.wire(THIRD, track.left, track.y - TRACK / 2, track.right, track.y + TRACK / 2)
    for pair in plan.twisted:
        _cross(canvas, strip, pair, plan.axis or 0.0)
    return strip


def name_track(canvas: Canvas, track: Strap) -> None:
    """The net's name on its track, for LVS."""
    canvas.label(THIRD, track.net, track.left + 0.3, track.y)


def draw_rails(canvas: Canvas, masks: AnalogMasks, plan: Plan, y: float) -> None:
    """A strip's rails with their taps, and its well."""
    base, top = masks.base, y + plan.height_um
    if plan.n:
        _rail(canvas, plan, y, base.pplus)
    if plan.p:
        low = min(top - RAIL - placed.device.finger_um for placed in plan.p) - WELL_AROUND
        beyond = RAIL_ENDS + WELL_ENDS
        canvas.box(base.well, plan.left - beyond, low, plan.right + beyond, top + TAP_HALF + WELL_AROUND)
        _rail(canvas, plan, top, base.nplus)


def _rail(canvas: Canvas, plan: Plan, y: float, implant: tuple[int, int]) -> None:
    """A rail with a tap along it."""
    base, left, right = canvas.process, plan.left - RAIL_ENDS, plan.right + RAIL_ENDS
    canvas.wire(1, left, y - RAIL_HALF, right, y + RAIL_HALF)
    canvas.wire(0, left, y - 0.085, right, y + 0.085)
    canvas.box(base.tap, left, y - TAP_HALF, right, y + TAP_HALF)
    canvas.box(implant, left - IMPLANT, y - TAP_HALF - IMPLANT, right + IMPLANT, y + TAP_HALF + IMPLANT)
    count = int((right - left - 0.5) / TAP_PITCH) + 1
    first = (left + right) / 2 - (count - 1) * TAP_PITCH / 2
    for k in range(count):
        canvas.square(base.contact, first + k * TAP_PITCH, y, 0.17)
        canvas.square(base.vias[0].gds, first + k * TAP_PITCH, y, 0.17)


def _drops(canvas: Canvas, strip: Strip, straps: Sequence[tuple[Strap, Placed]]) -> None:
    """A drop from every strap to its track; the least free straps first, and what found no room before those."""
    groups = _groups(sorted(straps, key=lambda pair: (_freedom(*pair), pair[0].right - pair[0].left)), strip.plan.axis)
    for _ in range(TRIES):
        drops, lacking = _assigned(strip, groups)
        if lacking is None:
            for strap, x, low, high in drops:
                strip.drops.append((strap.net, x, low, high))
                _drop(canvas, strip, strap, x, (low, high))
            return
        groups.insert(0, groups.pop(lacking))
    strap = groups[0][0][0]
    raise ParameterError(f"net {strap.net} at x = {strap.left:.2f} um: must have room for a drop")


def _groups(straps: Sequence[tuple[Strap, Placed]], axis: float | None) -> list[list[tuple[Strap, Placed]]]:
    """Straps and their mirror images about ``axis`` together."""
    groups: list[list[tuple[Strap, Placed]]] = []
    for strap, placed in straps:
        for group in groups if axis is not None else ():
            other, beside = group[0]
            turned = axis is not None and (abs(beside.low + placed.high - 2 * axis) < 1e-6)
            turned = turned and axis is not None and abs(other.left + strap.right - 2 * axis) < 1e-6
            if len(group) == 1 and other.y == strap.y and turned and beside is not placed:
                group.append((strap, placed))
                break
        else:
            groups.append([(strap, placed)])
    return groups


def _assigned(
    strip: Strip, groups: Sequence[Sequence[tuple[Strap, Placed]]]
) -> tuple[list[tuple[Strap, float, float, float]], int | None]:
    """Drops (strap, x, low, high) of groups in this order; the first group without room, or None."""
    axis, kept, taken = strip.plan.axis, list[tuple[Strap, float, float, float]](), list[Place]()
    reaches = [[_reach(strip, strap) for strap, _ in group] for group in groups]
    for index, (group, ends) in enumerate(zip(groups, reaches, strict=True)):
        central = axis is not None and len(group) == 1 and abs(group[0][0].left + group[0][0].right - 2 * axis) < 1e-6
        track = piece(strip.tracks, group[0][0].net, (group[0][0].left + group[0][0].right) / 2)
        for x in _places(*group[0]):
            if track and not track.left + TRACK / 2 <= x + 1e-9 <= track.right - TRACK / 2 + 2e-9:
                continue
            pairs = [(group[0][0], x, *ends[0])]
            if central and axis is not None and abs(x - axis) > 1e-6:
                pairs.append(
                    (group[0][0], 2 * axis - x, *ends[0])
                )  # a strap across the axis has two drops, or one on it
            elif len(group) == 2 and axis is not None:
                pairs.append((group[1][0], 2 * axis - x, *ends[1]))
            places = [pair[1:] for pair in pairs]
            if all(_free(place, taken) for place in places) and _free(places[-1], places[:-1]):
                kept += pairs
                for place in places:
                    insort(taken, place)
                break
        else:
            return kept, index
    return kept, None


def piece(tracks: Iterable[Strap], net: str, x: float) -> Strap | None:
    """Return the piece of a net's track that reaches to ``x``, or the nearest one; None where it has none."""
    segments = [track for track in tracks if track.net == net]
    return min(segments, key=lambda track: max(track.left - x, x - track.right, 0.0), default=None)


def _reach(strip: Strip, strap: Strap) -> tuple[float, float]:
    """Ends of a drop: the strap and its track, or its rail."""
    if track := piece(strip.tracks, strap.net, (strap.left + strap.right) / 2):
        end = track.y
    else:
        end = strip.y if strap.net == strip.plan.rails[0] else strip.y + strip.plan.height_um
    return min(strap.y, end), max(strap.y, end)


def _cross(canvas: Canvas, strip: Strip, pair: tuple[str, str], axis: float) -> None:
    """Both nets of ``pair`` change tracks: one on the tracks' metal, the other on the metal above."""
    low, high = (piece(strip.tracks, net, axis - 2 * CROSS) for net in pair)
    if low is None or high is None:
        raise ParameterError(f"nets {pair}: must have tracks to cross")
    half = TRACK / 2
    canvas.wire(THIRD, axis - CROSS, low.y - half, axis + half, low.y + half)
    canvas.wire(THIRD, axis - half, low.y - half, axis + half, high.y + half)
    canvas.wire(THIRD, axis - half, high.y - half, axis + CROSS, high.y + half)
    out = CROSS + half
    canvas.stack(axis - out, high.y, THIRD, FOURTH)
    canvas.stack(axis + out, low.y, THIRD, FOURTH)
    canvas.wire(FOURTH, axis - out - half, high.y - half, axis + out + half, high.y + half)
    canvas.wire(FOURTH, axis + out - half, low.y - half, axis + out + half, high.y + half)


def _free(place: Place, others: Sequence[Place]) -> bool:
    """Return whether a drop is clear of ``others``, which are in ascending order."""
    x, low, high = place
    near = others[bisect_left(others, (x - DROP_PITCH, -inf, -inf)) : bisect_right(others, (x + DROP_PITCH, inf, inf))]
    return all(
        abs(x - at) >= DROP_PITCH - 1e-9 or high + DROP_ENDS <= bottom or top + DROP_ENDS <= low
        for at, bottom, top in near
    )


def _places(strap: Strap, placed: Placed) -> Iterator[float]:
    """Yield x of a drop: over the strap from its centre, then next to it within the device's room."""
    middle = (strap.left + strap.right) / 2
    inner = strap.right - strap.left - STRAP
    low, high = _ends(strap, placed)
    low, high = low + STRAP / 2, high - STRAP / 2
    yield middle
    places = {_grid(low + DROP_STEP * k) for k in range(int((high - low) / DROP_STEP + 1e-6) + 1)}
    yield from sorted(places, key=lambda x: (abs(x - middle) > inner / 2 + 1e-9, abs(x - middle)))


def _ends(strap: Strap, placed: Placed) -> tuple[float, float]:
    """Return the ends to which a strap may extend."""
    return (strap.left, strap.right) if strap.fixed else (placed.low, placed.high)


def _freedom(strap: Strap, placed: Placed) -> float:
    left, right = _ends(strap, placed)
    return right - left


def _drop(canvas: Canvas, strip: Strip, strap: Strap, x: float, ends: tuple[float, float]) -> None:
    half = STRAP / 2
    canvas.wire(1, min(x - half, strap.left), strap.y - half, max(x + half, strap.right), strap.y + half)
    canvas.stack(x, strap.y, 1, SECOND)
    canvas.wire(SECOND, x - DROP / 2, ends[0] - DROP / 2, x + DROP / 2, ends[1] + DROP / 2)
    track = piece(strip.tracks, strap.net, x)
    if track:
        canvas.stack(x, track.y, SECOND, THIRD)
    else:
        canvas.stack(x, strip.y if strap.net == strip.plan.rails[0] else strip.y + strip.plan.height_um, 1, SECOND)


def trunk(canvas: Canvas, tracks: Iterable[Strap], net: str, x: float, *beyond: float) -> None:
    """Join the tracks of ``net``, on the fourth metal at ``x``; beyond: y up to which it goes, too."""
    ys = [track.y for track in tracks if track.net == net and track.left <= x <= track.right]
    for y in ys:
        canvas.stack(x, y, THIRD, FOURTH)
    ends = [*(y - TRACK / 2 for y in ys), *(y + TRACK / 2 for y in ys), *beyond]
    canvas.wire(FOURTH, x - TRUNK / 2, min(ends), x + TRUNK / 2, max(ends))


def join_rails(canvas: Canvas, strips: Sequence[Strip]) -> None:
    """Join the lower rails of all strips in the west, the upper ones in the east, with their names as labels."""
    for k, way in enumerate((-1, 1)):
        ys = [strip.y + (strip.plan.height_um if k else 0.0) for strip in strips]
        plan = strips[0].plan
        x = plan.right + RAIL_AT if k else plan.left - RAIL_AT
        half = RAIL_TRUNK / 2
        canvas.wire(FOURTH, x - half, min(ys) - half, x + half, max(ys) + half)
        for y in ys:
            for level in (SECOND, THIRD):
                canvas.wire(level, x - half, y - RAIL_HALF, x + half, y + RAIL_HALF)
            for side in (-0.25, 0.25):
                canvas.stack(x + way * side, y, 1, FOURTH)
        canvas.label(FOURTH, plan.rails[k], x, ys[0])


def in_columns(
    columns: Sequence[tuple[Device | None, Device | None]], left: float, room: float = 0.0
) -> tuple[tuple[Placed, ...], tuple[Placed, ...], float]:
    """Rows of (n, p) above each other from ``left`` on; room: more between them. Returns the rows and the east end."""
    n, p, x = list[Placed](), list[Placed](), left
    for pair in columns:
        present = [device for device in pair if device]
        straps = sum(3 - (d.transistor.source == d.transistor.bulk) for d in present)
        width = max(*(d.width_um + GAP for d in present), straps * DROP_PITCH + room, 0.0)
        for device, row in zip(pair, (n, p), strict=True):
            if device:
                row.append(Placed(device, _grid(x + (width - device.width_um) / 2), x, x + width))
        x = _grid(x + width)
    return tuple(n), tuple(p), x


def mirrored(
    middle: Device | None, outward: Sequence[tuple[Device, Device]], axis: float, room: float = 0.0
) -> tuple[Placed, ...]:
    """Return a row about ``axis``: a device on it, and pairs (west, east) from there outwards."""
    placed, x = list[Placed](), 0.0
    if middle:
        x = _grid(max(middle.width_um + GAP, 3 * DROP_PITCH) / 2)
        placed.append(Placed(middle, axis - middle.width_um / 2, axis - x, axis + x))
    for west, east in outward:
        width = max(west.width_um + GAP, 3 * DROP_PITCH) + room
        width, inner = _grid(width), _grid((width - west.width_um) / 2)
        placed.append(Placed(east, axis + x + inner, axis + x, axis + x + width))
        placed.append(Placed(west, axis - x - inner - west.width_um, axis - x - width, axis - x))
        x += width
    return tuple(placed)


def _grid(um: float) -> float:
    return round(um / 0.005) * 0.005
