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

from collections.abc import Iterator, Mapping, Sequence

from talbot.pixels.analog_layout.array import LOWER_ENCLOSURE, VIA_INSET
from talbot.pixels.analog_layout.cells import Cell, new_canvas
from talbot.pixels.analog_layout.column_parts import CAPS, HEIGHT, PIECES
from talbot.pixels.analog_layout.column_plan import (
    EXIT_Y,
    FIRST_TRACK_VIA_INSET,
    GROUPED,
    LINE_SPACE,
    LINE_WIDTH,
    PLATE_VIA_AT,
    RAIL_GAP,
    ROW_IN,
    SINGLE,
    STRIP_TO_JOG,
    STRIP_TO_VIA,
    ColumnPlan,
    Drawn,
    column_plan,
    devices,
)
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
    Strip,
    draw_rails,
    draw_rows,
    join_rails,
    name_track,
)
from talbot.pixels.analog_layout.strip_plan import TRACK_PITCH
from talbot.pixels.circuits.column import PINS
from talbot.pixels.circuits.column_sizes import ColumnSizes
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
NARROW_WIDTH = 0.3  # of lines that pass plates
PATCH_INSET = 0.3  # of the metal over an upper plate from its edges
PLATE_VIA_PITCH = 1.0
PLATE_VIA_PAD = 0.19, 0.33  # half width and height of the third metal at those vias: its least area
UNDER_WIDTH = 0.28  # of the lines under the plates
SHIELD = 0.3  # width of the line of vss at a column's edge
RAILS = 1  # the metal of the rails


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
