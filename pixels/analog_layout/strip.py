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
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import NamedTuple

from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout.device import IMPLANT, RAIL, STRAP, WELL_AROUND, Strap, draw_device
from talbot.pixels.analog_layout.strip_plan import CROSS, DROP_PITCH, TRUNK, Placed, Plan, on_grid
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
TRACK = 0.38  # width of a track
DROP = 0.37  # width of a drop
DROP_STEP = 0.02  # grid of the drops' places
DROP_ENDS = 0.55
RAIL_HALF = 0.245
TAP_HALF = 0.21
TAP_PITCH = 0.68
WELL_ENDS = 0.50  # of the well beyond its taps
RAIL_ENDS = 1.7  # of a rail beyond the tracks
RAIL_AT = 1.0  # from a strip's end to the metal that joins rails
RAIL_TRUNK = 1.0  # its width
FIRST, SECOND, THIRD, FOURTH = 1, 2, 3, 4
TRIES = 60
Place = tuple[float, float, float]  # x, low, high of a drop


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
    places = {on_grid(low + DROP_STEP * k) for k in range(int((high - low) / DROP_STEP + 1e-6) + 1)}
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
