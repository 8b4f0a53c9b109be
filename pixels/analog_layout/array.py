"""An array of metal-insulator-metal capacitors: 16 x 16 units and half a one, dummies, a bus to the lower plates.

The upper plates are the common node: over the lower plates, which stand between it and the lines under them. Lines on
the second metal run along a column below the plates, one for each capacitor that has units in it, to the bus beyond
the dummies. The common node's strips are between the columns, where no line is: a strip over the lines adds as much
to a bit of 16 units as to one of 128, which is 0.4 LSB at mid-scale. It leaves opposite the bus, in the middle. Lower
plates of different nets are 1.2 um apart (capm.2b): a unit takes more room than its plate and the space of two upper
plates.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import floor, sqrt

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout.device import GRID, Strap, snap
from talbot.pixels.analog_layout.flat import Plate, Tap
from talbot.pixels.analog_layout.pattern import SIDE
from talbot.pixels.analog_layout.strip import FOURTH, SECOND, THIRD, TRACK
from talbot.pixels.analog_layout.strip_plan import TRACK_PITCH
from talbot.pixels.circuits.dac import DacSizes
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
LOWER_ENCLOSURE = 0.14  # of the upper plate by the lower one
LOWER_TAB = 0.45  # the same on the side of the lower plate's via
LOWER_SPACE = 1.2  # between lower plates
VIA_INSET = 0.24  # from the upper plate to that via's centre
LINE_WIDTH = 0.14
LINE_PITCH = 0.64  # of the lines below a column; less where vias would leave the plate
LINES = 6  # below a column
VIA_PAD_HALF = 0.185  # half width of a via's metal
COMMON_WIDTH = 0.4  # of the common node's metal
BUS_SPACE = 1.0  # from the dummies to the bus's first track
HALF_UNIT = "half"
HALF_COLUMN = SIDE // 2 - 1


@dataclass(frozen=True)
class ArrayPlan:
    """A capacitor array before it is drawn.

    names: capacitor of each unit, [row, column] from the side of the bus; the half unit is outside.
    nets: net of each lower plate, by name, and of `half`.
    common: net of the upper plates.
    edge_um, half_um: side of a unit and of the half unit.
    left, right: ends of the bus, um.
    ground: net of the dummies.
    """

    names: npt.NDArray[np.str_]
    nets: Mapping[str, str]
    common: str
    edge_um: float
    half_um: float
    left: float
    right: float
    ground: str = "vss"

    @property
    def pitch_um(self) -> tuple[float, float]:
        """Return the pitch of columns and of rows."""
        plate = self.edge_um + 2 * LOWER_ENCLOSURE
        return plate + LOWER_SPACE, plate - LOWER_ENCLOSURE + LOWER_TAB + LOWER_SPACE

    @property
    def size_um(self) -> tuple[float, float]:
        """Width of the capacitors with their dummies; height of these and the bus."""
        (across, along), tracks = self.pitch_um, len(self.buses())
        return (SIDE + 2) * across - LOWER_SPACE, (SIDE + 2) * along - LOWER_SPACE + BUS_SPACE + TRACK_PITCH * tracks

    def buses(self) -> list[str]:
        """Nets of the bus, from its far side on."""
        return list(dict.fromkeys([self.ground, *self.nets.values()]))

    def plates(self) -> list[Plate]:
        """Every capacitor; the dummies, too."""
        drawn = []
        for name, net in self.nets.items():
            count, side = (1, self.half_um) if name == HALF_UNIT else (int((self.names == name).sum()), self.edge_um)
            drawn.append(Plate(name, self.common, net, count * side**2, count * 4 * side))
        count = (SIDE + 2) ** 2 - SIDE**2 - 1
        drawn.append(Plate("dummies", self.ground, self.ground, count * self.edge_um**2, count * 4 * self.edge_um))
        return drawn


@dataclass
class Array:
    """A drawn array.

    tracks: of the bus.
    exit: (x, y) at which the common node leaves on the fourth metal.
    taps: of each capacitor in each column, on the third metal.
    """

    plan: ArrayPlan
    tracks: list[Strap] = field(default_factory=list)
    exit: tuple[float, float] = (0.0, 0.0)
    taps: list[Tap] = field(default_factory=list)


def edges(sizes: DacSizes, masks: AnalogMasks) -> tuple[float, float]:
    """Sides (um) of a unit and of half a one. Raises ParameterError where ``sizes`` has another kind of cell."""
    if sizes.kind != "mim" or not sizes.source.startswith("cap_mim"):
        raise ParameterError(f"unit = {sizes.source}: must be one cap_mim for a drawn array")

    def side(farad: float) -> float:
        a, b = masks.mim_area, 4 * masks.mim_edge
        return snap((sqrt(b * b + 4 * a * farad * 1e15) - b) / (2 * a))

    return side(sizes.unit), side(sizes.unit / 2)


def draw_array(canvas: Canvas, masks: AnalogMasks, plan: ArrayPlan, y: float, bus_south: bool = True) -> Array:
    """Draw an array in the middle of its bus, its southern edge at ``y``, or in the north with the bus there."""
    width, height = plan.size_um
    west = snap((plan.left + plan.right - width) / 2)
    return _Drawing(canvas, masks, plan, west, y if bus_south else y + height, 1 if bus_south else -1).draw()


@dataclass
class _Drawing:
    canvas: Canvas
    masks: AnalogMasks
    plan: ArrayPlan
    west: float
    origin: float
    way: int

    def y(self, v: float) -> float:
        """Return y of a distance from the bus's far side."""
        return self.origin + self.way * v

    def box(self, mask: tuple[int, int], left: float, low: float, right: float, high: float) -> None:
        a, b = self.y(low), self.y(high)
        self.canvas.box(mask, left, min(a, b), right, max(a, b))

    def metal(self, level: int, left: float, low: float, right: float, high: float) -> None:
        self.box(self.masks.base.metals[level].gds, left, low, right, high)

    def middle(self, row: int, column: int) -> tuple[float, float]:
        """Return the centre of a unit's upper plate; rows and columns from -1 (dummies) to SIDE."""
        across, along = self.plan.pitch_um
        first = TRACK_PITCH * len(self.plan.buses()) + BUS_SPACE + LOWER_TAB + self.plan.edge_um / 2
        return (self.west + LOWER_ENCLOSURE + self.plan.edge_um / 2 + (column + 1) * across, first + (row + 1) * along)

    def draw(self) -> Array:
        array = Array(self.plan)
        for k, net in enumerate(self.plan.buses()):
            v = TRACK_PITCH * (k + 0.5)
            array.tracks.append(Strap(net, self.plan.left, self.plan.right, self.y(v)))
            self.metal(THIRD, self.plan.left, v - TRACK / 2, self.plan.right, v + TRACK / 2)
        for column in range(SIDE):
            self._column(column, array)
        self._ring(array)
        self._common(array)
        return array

    def _plate(self, row: int, column: int, edge: float) -> None:
        """The upper plate with its via, in the middle of a place."""
        x, v = self.middle(row, column)
        self.box(self.masks.mim, x - edge / 2, v - edge / 2, x + edge / 2, v + edge / 2)
        self.canvas.square(self.masks.base.vias[THIRD].gds, x, self.y(v), 0.2)

    def _lower(self, row: int, column: int, edge: float) -> None:
        x, v = self.middle(row, column)
        half = edge / 2
        self.metal(
            THIRD,
            x - half - LOWER_ENCLOSURE,
            v - half - LOWER_TAB,
            x + half + LOWER_ENCLOSURE,
            v + half + LOWER_ENCLOSURE,
        )

    def _line(self, net: str, x: float, end: float, array: Array) -> None:
        """Draw a line from the bus to ``end``, a distance from its far side."""
        track = next(row.y for row in array.tracks if row.net == net)
        start = (track - self.origin) * self.way
        self.metal(SECOND, x - LINE_WIDTH / 2, start, x + LINE_WIDTH / 2, end)
        self.canvas.stack(x, track, SECOND, THIRD)

    def _column(self, column: int, array: Array) -> None:
        """The units of a column and their lines."""
        capacitors = self.plan.names[:, column]
        kinds = [name for name in self.plan.nets if name in set(capacitors.tolist())]
        if column == HALF_COLUMN:
            kinds.append(HALF_UNIT)
        units = {name: int((self.plan.names == name).sum()) for name in kinds}
        kinds.sort(key=lambda name: units[name])
        kinds = kinds[1::2][::-1] + kinds[::2]  # those with many units outside, next to the common node's strips
        if len(kinds) > LINES:
            raise ParameterError(f"column {column} = {len(kinds)} capacitors: must be {LINES} at most")
        x0, _ = self.middle(0, column)
        room = (self.plan.edge_um + 2 * (LOWER_ENCLOSURE - VIA_PAD_HALF)) / max(len(kinds) - 1, 1)
        pitch = min(LINE_PITCH, floor(room / (4 * GRID)) * 4 * GRID)
        places = {name: x0 + (k - (len(kinds) - 1) / 2) * pitch for k, name in enumerate(kinds)}
        beyond = self.plan.edge_um / 2 + VIA_INSET - LINE_WIDTH
        if column == HALF_COLUMN:
            self._half(places.pop(HALF_UNIT), array)
        for name, x in places.items():
            last = int((capacitors == name).nonzero()[0][-1])
            self._line(self.plan.nets[name], x, self.middle(last, column)[1] - beyond, array)
        for row in range(SIDE):
            self._plate(row, column, self.plan.edge_um)
            self._lower(row, column, self.plan.edge_um)
            v = self.middle(row, column)[1] - self.plan.edge_um / 2 - VIA_INSET
            self.canvas.stack(places[str(capacitors[row])], self.y(v), SECOND, THIRD)
        for name, x in places.items():
            rows = [int(row) for row in (capacitors == name).nonzero()[0]]
            v = self.middle(rows[len(rows) // 2], column)[1] - self.plan.edge_um / 2 - VIA_INSET
            array.taps.append(Tap(name, len(rows), x, self.y(v)))

    def _half(self, line: float, array: Array) -> None:
        """Draw half a unit instead of a dummy next to the bus, on a whole lower plate; ``line``: x of its line."""
        self._plate(-1, HALF_COLUMN, self.plan.half_um)
        self._lower(-1, HALF_COLUMN, self.plan.edge_um)
        at = self.middle(-1, HALF_COLUMN)[1] - self.plan.edge_um / 2 - VIA_INSET
        self._line(self.plan.nets[HALF_UNIT], line, at + LINE_WIDTH / 2, array)
        self.canvas.stack(line, self.y(at), SECOND, THIRD)
        array.taps.append(Tap(HALF_UNIT, 0.5, line, self.y(at)))

    def _ring(self, array: Array) -> None:
        """The dummies: lower plates in one piece but for the half's place, upper ones joined, both on the ground."""
        p, half = self.plan, self.plan.edge_um / 2
        inner, hole = range(SIDE), HALF_COLUMN
        (west, low), (east, high) = self.middle(-1, -1), self.middle(SIDE, SIDE)
        bottom, top = low - half - LOWER_TAB, high + half + LOWER_ENCLOSURE
        for x in (west, east):
            self.metal(THIRD, x - half - LOWER_ENCLOSURE, bottom, x + half + LOWER_ENCLOSURE, top)
            self.metal(FOURTH, x - COMMON_WIDTH / 2, bottom, x + COMMON_WIDTH / 2, high + COMMON_WIDTH / 2)
            self._line(p.ground, x, low - half - VIA_INSET + LINE_WIDTH, array)
            for side in (-0.4, 0.4):
                self.canvas.stack(x + side, self.y(low - half - VIA_INSET), SECOND, THIRD)
            self.metal(SECOND, x - 0.6, low - half - VIA_INSET - 0.185, x + 0.6, low - half - VIA_INSET + 0.185)
            self.canvas.square(self.masks.base.vias[THIRD].gds, x, self.y(low - half - VIA_INSET), 0.2)
            for row in range(-1, SIDE + 1):
                self._plate(row, -1 if x == west else SIDE, p.edge_um)
        for column in inner:
            self._plate(SIDE, column, p.edge_um)
            if column != hole:
                self._plate(-1, column, p.edge_um)
        rows = [(low, west, self.middle(0, hole - 1)[0]), (low, self.middle(0, hole + 1)[0], east)]
        rows += [(high, west, self.middle(0, hole)[0]), (high, self.middle(0, hole + 1)[0], east)]
        for v, left, right in rows:
            self.metal(
                FOURTH, left - COMMON_WIDTH / 2, v - COMMON_WIDTH / 2, right + COMMON_WIDTH / 2, v + COMMON_WIDTH / 2
            )
            if v == high:
                left, right = west, east
            self.metal(
                THIRD,
                left - half - LOWER_ENCLOSURE,
                v - half - LOWER_TAB,
                right + half + LOWER_ENCLOSURE,
                v + half + LOWER_ENCLOSURE,
            )

    def _common(self, array: Array) -> None:
        """Draw the upper plates' metal: strips next to the columns, tabs to the plates, bars at both ends, the exit."""
        half, across = self.plan.edge_um / 2, self.plan.pitch_um[0]
        first, last = self.middle(0, 0), self.middle(SIDE - 1, SIDE - 1)
        bars = first[1] - half - LOWER_TAB - LOWER_SPACE / 2, last[1] + half + LOWER_ENCLOSURE + LOWER_SPACE / 2
        strips = [first[0] + (k - 0.5) * across for k in range(SIDE + 1)]
        for x in strips:
            self.metal(FOURTH, x - COMMON_WIDTH / 2, bars[0], x + COMMON_WIDTH / 2, bars[1])
        places = [(row, column) for row in range(SIDE) for column in range(SIDE)]
        for row, column in [*places, (-1, HALF_COLUMN)]:
            x, v = self.middle(row, column)
            self.metal(FOURTH, x - across / 2, v - COMMON_WIDTH / 2, x + COMMON_WIDTH / 2, v + COMMON_WIDTH / 2)
        x, v = self.middle(-1, HALF_COLUMN)
        beside = x - across / 2
        self.metal(FOURTH, beside - COMMON_WIDTH / 2, v - COMMON_WIDTH / 2, beside + COMMON_WIDTH / 2, bars[0])
        for v in bars:
            self.metal(
                FOURTH,
                strips[0] - COMMON_WIDTH / 2,
                v - COMMON_WIDTH / 2,
                strips[-1] + COMMON_WIDTH / 2,
                v + COMMON_WIDTH / 2,
            )
        x = strips[HALF_COLUMN + 1]
        end = self.middle(SIDE, 0)[1] + half + LOWER_ENCLOSURE
        self.metal(FOURTH, x - COMMON_WIDTH / 2, bars[1], x + COMMON_WIDTH / 2, end)
        array.exit = (x, self.y(end))
