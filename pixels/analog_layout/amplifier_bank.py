"""A bank of fringe capacitors, combs of the two lowest metals between a common node and others, in common centroid.

    bottoms   ======= ======= =======    a spine of each comb, or of each part of one; a stub to its track
               | | |   | | |   | | |     a finger of a bottom net between two of the common node: a unit
    common    =======================    shared with the row below, which is upside down

Rows are in pairs whose spines face a channel. Its tracks, on the third metal, leave in the west; the common node's
spines are joined in the east, so that no track passes it. Every comb has its partner of the same capacitor on the other
side of the bank's middle. Both inputs of the amplifier have the same bank: what is bit 9 in one is `a` in the other.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from talbot.pixels.analog_layout.device import Strap, snap
from talbot.pixels.analog_layout.strip import FIRST, SECOND, THIRD, TRACK
from talbot.pixels.analog_layout.strip_plan import TRACK_PITCH
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.layers import GdsLayer

FINGERS = 8  # units of a comb
COLUMNS = 13  # combs of a row
CHANNELS = 6  # pairs of rows
# Combs by channel from the south, to the middle; the others are their mirror images about the middle
COUNTS: tuple[Mapping[str, int], ...] = (
    {"b9": 11, "b8": 5, "b7": 4, "b5": 2, "b4": 1, "rest": 3},
    {"b9": 11, "b8": 5, "b7": 4, "b6": 4, "rest": 2},
    {"b9": 10, "b8": 6, "b3": 1, "rest": 8, "part": 1},
)
MIRRORED = {"b3": "low", "part": "spare"}  # what is in their places on the other side
# Units of a comb that is shared, from the west
PARTS = {"low": (("b2", 4), ("b1", 2), ("b0", 1), ("unit", 1)), "part": (("rest", 5), ("odd", 3))}
# um
FINGER = 0.14  # width of a finger
PITCH = 0.28  # of fingers
TIP = 0.20  # from a finger's end to the other spine
COMMON = 0.42  # height of the common spine
SPINE = 0.34  # height of the other spines
MARK = 0.06, 0.04  # of a unit's marker: beyond its finger, from the common spine
FIRST_TRACK = 0.45  # from the spines to a channel's first track
JOIN = 0.42  # width of the metal that joins the common spines
JOIN_AWAY = 0.60  # from the last finger to its centre

Names = tuple[tuple[str, ...], ...]


def pattern() -> Names:
    """Names of the combs, row by row from the south."""
    lower: list[list[str]] = []
    for counts in COUNTS:
        places = sorted(((k + 0.5) / n, name) for name, n in counts.items() for k in range(n))
        names = [name for _, name in places]
        lower += [names[0::2], names[1::2]]
    upper = [[MIRRORED.get(name, name) for name in row[::-1]] for row in lower[::-1]]
    return tuple(tuple(row) for row in (*lower, *upper))


def parts(name: str) -> tuple[tuple[str, int], ...]:
    """(capacitor, units) of a comb, from the west."""
    return PARTS.get(name, ((name, FINGERS),))


def units() -> dict[str, int]:
    """Units of every capacitor."""
    counts: dict[str, int] = {}
    for row in pattern():
        for comb in row:
            for name, count in parts(comb):
                counts[name] = counts.get(name, 0) + count
    return counts


@dataclass(frozen=True)
class BankPlan:
    """A bank before it is drawn.

    length_um: of a finger next to its neighbours.
    nets: net of each capacitor, by name.
    common: net of the common node.
    ends: x of the tracks' west ends, by net.
    west: x of the first finger's centre.
    """

    length_um: float
    nets: Mapping[str, str]
    common: str
    ends: Mapping[str, float]
    west: float

    @property
    def east_um(self) -> float:
        """Return x of the bank's east end."""
        return self.west + 2 * PITCH * FINGERS * COLUMNS + JOIN_AWAY + JOIN / 2

    @property
    def height_um(self) -> float:
        """Return the height from the lowest common spine's edge to the uppermost's."""
        return self._common(CHANNELS) + COMMON / 2

    def _row(self) -> float:
        return COMMON / 2 + self.length_um + 2 * TIP + SPINE

    def _channel(self, number: int) -> float:
        return 2 * FIRST_TRACK + TRACK_PITCH * (len(tracks(number)) - 1)

    def _common(self, number: int) -> float:
        """Middle of a common spine over the bank's lower edge."""
        return COMMON / 2 + sum(2 * self._row() + self._channel(k) for k in range(number))

    def common_um(self, number: int) -> float:
        """Middle of a common spine over the bank's lower edge: 0 the southern one, CHANNELS the northern one."""
        return self._common(number)


def tracks(channel: int) -> list[str]:
    """Return the capacitors with a track in a channel, from the south.

    The outermost two are next to the common fingers' ends: the remainder, and bits 9 and 8 as they have units.
    """
    names = {part: None for row in pattern()[2 * channel : 2 * channel + 2] for comb in row for part, _ in parts(comb)}
    last = "b8" if channel in (CHANNELS // 2 - 1, CHANNELS // 2) else "b9"
    return ["rest", *sorted(names.keys() - {"rest", last}), last]


@dataclass
class Bank:
    """A drawn bank. tracks: of the channels, by net. ends: y of the middles of the outermost common spines."""

    plan: BankPlan
    tracks: list[Strap] = field(default_factory=list)
    ends: tuple[float, float] = (0.0, 0.0)


def draw_bank(canvas: Canvas, plan: BankPlan, mark: GdsLayer, y: float, upright: bool = True) -> Bank:
    """Draw a bank, its lower edge at ``y``; upside down it is the mirror image. mark: of its units, for LVS."""
    return _Drawing(canvas, plan, mark, y if upright else y + plan.height_um, 1 if upright else -1).draw()


@dataclass
class _Drawing:
    canvas: Canvas
    plan: BankPlan
    mark: GdsLayer
    origin: float
    way: int

    def y(self, v: float) -> float:
        return self.origin + self.way * v

    def metal(self, level: int, left: float, low: float, right: float, high: float) -> None:
        a, b = self.y(low), self.y(high)
        self.canvas.wire(level, left, min(a, b), right, max(a, b))

    def both(self, left: float, low: float, right: float, high: float) -> None:
        """Draw a box on both metals of the capacitors."""
        for level in (FIRST, SECOND):
            self.metal(level, left, low, right, high)

    def draw(self) -> Bank:
        plan, bank, names = self.plan, Bank(self.plan), pattern()
        for number in range(CHANNELS + 1):
            self._spine(plan.common_um(number))
        for channel in range(CHANNELS):
            low, high = plan.common_um(channel), plan.common_um(channel + 1)
            spines = low + COMMON / 2 + plan.length_um + 2 * TIP, high - COMMON / 2 - plan.length_um - 2 * TIP
            rows = tracks(channel)
            heights = {name: spines[0] + SPINE + FIRST_TRACK + TRACK_PITCH * k for k, name in enumerate(rows)}
            reach = dict.fromkeys(rows, plan.west)
            self._row(names[2 * channel], low, 1, spines[0], heights, reach)
            self._row(names[2 * channel + 1], high, -1, spines[1], heights, reach)
            for name, v in heights.items():
                left = plan.ends[plan.nets[name]]
                self.metal(THIRD, left, v - TRACK / 2, reach[name], v + TRACK / 2)
                bank.tracks.append(Strap(plan.nets[name], left, reach[name], self.y(v)))
        ends = self.y(plan.common_um(0)), self.y(plan.common_um(CHANNELS))
        bank.ends = min(ends), max(ends)
        x = plan.east_um - JOIN / 2
        self.both(x - JOIN / 2, plan.common_um(0) - COMMON / 2, x + JOIN / 2, plan.height_um)
        return bank

    def _spine(self, v: float) -> None:
        """A spine of the common node."""
        count = FINGERS * COLUMNS
        self.both(self.plan.west - FINGER / 2, v - COMMON / 2, self.plan.east_um, v + COMMON / 2)
        for k in range(0, count + 1, 2):
            self.canvas.stack(self.plan.west + 2 * PITCH * k, self.y(v), FIRST, SECOND)

    def _unit(self, x: float, tip: float, up: int) -> None:
        """The mark of a capacitor, for LVS, where a finger's tip is before the common spine."""
        over, away = MARK
        ends = self.y(tip + up * over), self.y(tip - up * (TIP - away))
        self.canvas.box(self.mark, x - FINGER / 2, min(ends), x + FINGER / 2, max(ends))

    def _row(
        self,
        names: Sequence[str],
        common: float,
        up: int,
        spine: float,
        heights: Mapping[str, float],
        reach: dict[str, float],
    ) -> None:
        """Fingers and spines of a row. common: middle of its common spine. up: towards its channel. spine: near edge of
        the bottoms' spines."""
        p = self.plan
        first, last = sorted((common, common + up * (COMMON / 2 + p.length_um + TIP)))
        for k in range(FINGERS * COLUMNS + 1):
            x = p.west + 2 * PITCH * k
            self.both(x - FINGER / 2, first, x + FINGER / 2, last)
        number = 0
        for comb in names:
            for name, count in parts(comb):
                xs = [p.west + PITCH * (2 * (number + k) + 1) for k in range(count)]
                number += count
                inner = common + up * (COMMON / 2 + TIP)
                for x in xs:
                    self.both(x - FINGER / 2, min(inner, spine), x + FINGER / 2, max(inner, spine))
                    self._unit(x, inner, up)
                far = spine + up * SPINE
                self.both(xs[0] - FINGER / 2, min(spine, far), xs[-1] + FINGER / 2, max(spine, far))
                for x in xs[:: 2 if count > 2 else 1]:
                    self.canvas.stack(x, self.y((spine + far) / 2), FIRST, SECOND)
                # Adjacent stubs of facing combs
                aside = -2 * up if count == FINGERS else 3 if 2 * count > FINGERS else 0
                x = snap((xs[0] + xs[-1]) / 2 + PITCH * aside)
                v = heights[name]
                self.metal(SECOND, x - 0.16, min(v, spine + up * SPINE / 2), x + 0.16, max(v, spine + up * SPINE / 2))
                self.canvas.stack(x, self.y(v), SECOND, THIRD)
                reach[name] = max(reach[name], x + 0.19)
