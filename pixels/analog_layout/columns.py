"""All columns, lying: crossing lines, and each column's vias to the lines of its lane, group and place.

What goes on to the south is on the second metal between two columns, at a multiple of their pitch: a `way`.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from talbot.base.gds import db
from talbot.models.parameters import ArrayParameters, ParameterError, check_int
from talbot.pixels.analog_layout.cells import Cell
from talbot.pixels.analog_layout.column import PLATE_VIA_PAD, as_cell, draw_column, draw_ground
from talbot.pixels.analog_layout.column_parts import HEIGHT
from talbot.pixels.analog_layout.column_plan import (
    EXIT_Y,
    GROUPED,
    LANES,
    SINGLE,
    ColumnPlan,
    column_plan,
    devices,
    line_um,
    names,
)
from talbot.pixels.analog_layout.strip import FOURTH, RAIL_TRUNK, SECOND, THIRD, name_track
from talbot.pixels.circuits.column import PINS, SUPPLIES, block_line
from talbot.pixels.circuits.column_block import GROUPS, LINES, PLACES, taken
from talbot.pixels.circuits.column_sizes import ColumnSizes
from talbot.pixels.drawn import check_pitch
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

WAY_WIDTH = 0.2  # um, of a line to the south
WAY_END = 1.0  # um, beyond the columns, where it goes up


@dataclass(frozen=True)
class Columns:
    """The drawn columns.

    cell: all of them; column k begins at y = k pitch.
    column: a single one.
    count: their number.
    pitch: um.
    """

    cell: "db.Cell"
    column: Cell
    plan: ColumnPlan
    count: int
    pitch: float

    def lines(self, net: str) -> list[float]:
        """Return x of a block net's lines; a lane has two, to the columns and back."""
        if net.startswith("lane"):
            kind, lane = net[:-1].split("[")
            return [self.plan.lines[f"{name}{lane}"] for name in (kind, kind.replace("lane", "sense"))]
        pin = net.replace("_", "") if net in LINES else net
        return [x for name, x in self.plan.lines.items() if block_line(name) == pin]


def column_nets(number: int, lanes: int) -> tuple[str, ...]:
    """Return the block's nets at the ports of a column."""
    lane, code = taken(number, lanes)
    nets = {f"column_{d}": f"column_{d}[{number}]" for d in "ab"}
    nets |= {f"{kind}_{d}": f"lane_{d}[{lane}]" for kind in ("lane", "sense") for d in "ab"}
    nets |= {name: f"{name}_{value}" for name, value in code.items()} | dict(
        zip(SUPPLIES, ("vddc", "vssa"), strict=True)
    )
    return tuple(nets.get(pin, pin) for pin in map(block_line, PINS))


def check_columns(array: ArrayParameters, lanes: int) -> None:
    """Raise ParameterError for a pitch at which no column is drawn, or for too few lines."""
    check_pitch(array.pitch_um)
    check_int("chip.lanes", lanes, 1, LANES)
    if (most := lanes * GROUPS * PLACES) < array.cols:
        raise ParameterError(f"array.cols = {array.cols}: must be at most {most}, the lines of {lanes} lanes")


def draw_columns(
    layout: "db.Layout",
    masks: AnalogMasks,
    sizes: ColumnSizes,
    array: ArrayParameters,
    lanes: int,
    extra: Iterable[str] = (),
) -> Columns:
    """Draw them, and the names of a column's ports. extra: nets that have a line across, and no column.

    Raises ParameterError for a pitch at which nothing is drawn, or for too many lines.
    """
    check_columns(array, lanes)
    d, count, pitch = devices(sizes), array.cols, array.pitch_um
    plan = column_plan(d, sizes, masks, extra, lanes)
    canvas = Canvas(layout, "column", masks.base)
    column = as_cell(canvas, d, plan, draw_column(canvas, masks, plan))
    for net in column.ports:
        if net in EXIT_Y:
            canvas.label(FOURTH, net, 0.2, EXIT_Y[net])
        elif net not in plan.joints:
            name_track(canvas, next(track for track in column.tracks if track.net == net))
    whole = Canvas(layout, "columns", masks.base)
    step = db.Vector(0, whole.snap(pitch))
    whole.cell.insert(db.CellInstArray(column.cell.cell_index(), db.Trans(), step, db.Vector(1, 0), count, 1))
    for net in (*GROUPED, *SINGLE, *plan.free):
        half = line_um(net) / 2
        for name in names(net, lanes):
            x = plan.lines[name]
            whole.wire(FOURTH, x - half, 0, x + half, count * pitch)
    if pitch > HEIGHT:
        for x in plan.joints["vss"] + plan.joints["vdd"]:
            whole.wire(FOURTH, x - RAIL_TRUNK / 2, 0, x + RAIL_TRUNK / 2, count * pitch)
    via = Canvas(layout, "column_code", masks.base)
    via.stack(0, 0, THIRD, FOURTH)
    tracks = {track.net: track.y for track in column.tracks if track.net in GROUPED}
    for number in range(count):
        lane, code = taken(number, lanes)
        codes = {net: code.get(net, lane) for net in GROUPED}
        for net, k in codes.items():
            x, y = plan.lines[f"{net}{k}"], number * pitch + tracks[net]
            whole.cell.insert(db.CellInstArray(via.cell.cell_index(), db.Trans(whole.snap(x), whole.snap(y))))
    return Columns(whole.cell, column, plan, count, pitch)


def draw_way(canvas: Canvas, columns: Columns, net: str, number: int, only: int | None = None) -> list[float]:
    """Draw lines from a net's lines, or from one, to WAY_END beyond the columns, south of column ``number``.

    Returns x of its vias.
    """
    lines, y, half = columns.lines(net), number * columns.pitch, WAY_WIDTH / 2
    lines = lines if only is None else lines[only : only + 1]
    end = columns.plan.right + WAY_END
    canvas.wire(SECOND, min(lines) - half, y - half, end + half, y + half)
    for x in (*lines, end):
        canvas.stack(x, y, SECOND, FOURTH)
        canvas.wire(THIRD, x - PLATE_VIA_PAD[1], y - PLATE_VIA_PAD[0], x + PLATE_VIA_PAD[1], y + PLATE_VIA_PAD[0])
    return [*lines, end]


def draw_grounds(canvas: Canvas, columns: Columns, vias: Mapping[int, Sequence[float]]) -> None:
    """The ground's lines in the south of each column, up to the first of the ways' vias there. vias: x, by column."""
    for number in range(columns.count):
        draw_ground(canvas, columns.plan, number * columns.pitch, vias.get(number, ()))
