"""Lines of a grating on the manufacturing grid, in any direction.

A line has its long sides along a whole-number direction (p, q) of the grid and its ends along (-q, p): an exact
rectangle on the grid, of which no width is lost to rounding and no corner is below 90 degrees, so that rules of widths
and spaces hold in every direction. Its width is a whole number of |(p, q)|. Lengths are in steps of the grid.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from math import atan2, ceil, cos, floor, gcd, hypot, inf, pi, sin

from talbot.models.parameters import ParameterError

LARGEST = 24  # of a direction's two whole numbers
NEAR = pi / 720  # rad, of a direction to the wanted one: a quarter of a degree
WIDER = 1.05  # most that a period may grow
OBLIQUE = 12, 5  # the direction that octilinear lines may have, and its mirror images
ENDS, RETURN, STEEP = 15, 12, 5  # lengths of it in an end of such a line; steeper steps there, their straight run
ROUGH = 5  # more width, for the corners of the steps
Point = tuple[int, int]
Box = tuple[int, int, int, int]  # left, bottom, right, top


@dataclass(frozen=True)
class Lines:
    """A drawn grating.

    normal: direction of modulation, rad.
    direction: (p, q) along its lines, p >= 0.
    upright: lines repeat along y, else along x.
    pitch: along that axis.
    width: of a line, in lengths of (p, q).
    """

    normal: float
    direction: Point
    upright: bool
    pitch: int
    width: int

    @property
    def across(self) -> float:
        """Length across the lines of one step along the axis."""
        p, q = self.direction
        return abs(p if self.upright else q) / hypot(p, q)

    @property
    def side(self) -> Point:
        """Return the vector from one long side of a line to the other."""
        p, q = self.direction
        return -q * self.width, p * self.width

    @property
    def line(self) -> float:
        """Width of a line."""
        return self.width * hypot(*self.direction)

    @property
    def period(self) -> float:
        """Period across the lines."""
        return self.pitch * self.across

    @property
    def fill(self) -> float:
        """Share of metal."""
        return self.line / self.period

    @property
    def off(self) -> float:
        """Angle between the lines and those wanted, rad."""
        along = atan2(self.direction[1], self.direction[0]) - self.normal - pi / 2
        return along - pi * round(along / pi)

    def along_axis(self, shift: float) -> float:
        """Steps along the axis that are ``shift`` periods along the normal."""
        return shift * self.pitch * (1 if (sin if self.upright else cos)(self.normal) > 0 else -1)


@lru_cache(maxsize=64)
def nearest_direction(angle: float) -> Point:
    """Smallest whole numbers (p, q), p >= 0, whose direction is within `NEAR` of ``angle`` in rad."""
    pairs = [(p, q) for p in range(LARGEST + 1) for q in range(-LARGEST, LARGEST + 1) if gcd(p, abs(q)) == 1]
    for p, q in sorted(pairs, key=lambda pair: hypot(*pair)):
        off = atan2(q, p) - angle
        if abs(off - pi * round(off / pi)) < NEAR:
            return p, q
    raise ParameterError(f"angle = {angle:g}: must be a finite angle in rad")


def lines(normal: float, period: float, fill: float, least_width: float, least_space: float) -> Lines:
    """Return the lines nearest to a grating that keep the least width and space.

    normal: direction in which it modulates, rad. fill: share of metal. Raises ParameterError where the period has no
    room for both.
    """
    p, q = nearest_direction(normal + pi / 2)
    unit = hypot(p, q)
    width = max(round(fill * period / unit), ceil(least_width / unit - 1e-9))
    grating = Lines(normal, (p, q), abs(p) >= abs(q), 1, width)
    pitch = max(round(period / grating.across), ceil((grating.line + least_space) / grating.across - 1e-9))
    if pitch * grating.across > WIDER * period:
        raise ParameterError(
            f"period = {period:g} steps of the grid: must have room for a line of {least_width:g} and a space of "
            f"{least_space:g} at {normal:.3f} rad"
        )
    return replace(grating, pitch=pitch)


def polygons(grating: Lines, window: Box, shift: float, origin: Point | None = None) -> Iterator[list[Point]]:
    """Corners of every line in ``window``, a rectangle each, of at least three widths.

    shift: of the middle of a line from ``origin``, in periods along the normal. origin: None: the window's middle.
    """
    left, bottom, right, top = window
    (p, q), (side_x, side_y) = grating.direction, grating.side
    centre_x, centre_y = ((left + right) / 2, (bottom + top) / 2) if origin is None else origin
    middle_x, middle_y = centre_x - side_x / 2, centre_y - side_y / 2
    at = grating.along_axis(shift)
    x0, y0 = round(middle_x + (0 if grating.upright else at)), round(middle_y + (at if grating.upright else 0))
    away = abs(centre_x - left) + abs(centre_x - right) + abs(centre_y - bottom) + abs(centre_y - top)
    reach = ceil(away / grating.pitch) + 2
    for k in range(-reach, reach + 1):
        x, y = (x0, y0 + k * grating.pitch) if grating.upright else (x0 + k * grating.pitch, y0)
        spans = [_span(x, p, left - min(side_x, 0), right - max(side_x, 0))]
        spans.append(_span(y, q, bottom - min(side_y, 0), top - max(side_y, 0)))
        first, last = max(span[0] for span in spans), min(span[1] for span in spans)
        if (last - first) * hypot(p, q) >= 3 * grating.line:
            (x1, y1), (x2, y2) = ((x + t * p, y + t * q) for t in (floor(first + 1), floor(last)))
            yield [(x1, y1), (x2, y2), (x2 + side_x, y2 + side_y), (x1 + side_x, y1 + side_y)]


def octilinear(corners: list[Point], grating: Lines) -> list[Point]:
    """Return a line of `polygons` with edges at multiples of 45 degrees alone; one that has no others is as it was.

    The long sides become steps, a straight run and a diagonal for each (p, q). Both have the same steps, as far apart
    along the axis on which lines repeat as the line is wide. A line ends in a straight run of its width, so that no
    corner is acute, and steeper steps return from there to the line. A line without room for its ends is left out: it
    has no corners. Lines keep the least width; spaces between the ends of two are for the design rules to check. Raises
    ParameterError for a direction that is neither a multiple of 45 degrees nor like `OBLIQUE`.
    """
    p, q = grating.direction
    if not p * q or abs(p) == abs(q):
        return corners
    if {abs(p), abs(q)} != {*OBLIQUE}:
        raise ParameterError(f"direction = {p}, {q}: must be a multiple of 45 degrees, or {OBLIQUE} mirrored")
    (run, rise), swap, turn = OBLIQUE, abs(q) > abs(p), 1 if q > 0 else -1

    def flat(x: int, y: int) -> Point:
        """Turn into axes in which lines rise by less than 45 degrees."""
        return (turn * y, x) if swap else (x, turn * y)

    def back(x: int, y: int) -> Point:
        return (y, turn * x) if swap else (x, turn * y)

    (x, y), (end, _), _, (side_x, side_y) = (flat(*corner) for corner in corners)
    left = (end - x) // run - 2 * ENDS
    if left < 0:
        return []
    if side_y < y:
        x, y = side_x, side_y
    height = ceil(grating.line) + ROUGH
    y += (round(grating.width * hypot(p, q) ** 2 / run) - height) // 2 + rise * (ENDS - RETURN)
    level, last = ENDS * run - RETURN * (rise + STEEP), run - rise - STEEP
    inner = [STEEP + last, *[run - rise] * (left - 1), 2 * STEEP] if left else [2 * STEEP]
    lower = [(x, y)]
    for straight in (level, *[STEEP] * (RETURN - 1), *inner, *[STEEP] * (RETURN - 1)):
        x, y = x + straight + rise, y + rise
        lower += [(x - rise, y - rise), (x, y)]
    lower.append((x + level, y))
    return [back(*point) for point in (*lower, *((x, y + height) for x, y in reversed(lower)))]


def _span(start: int, step: int, low: float, high: float) -> tuple[float, float]:
    """Return the range of t in which start + t step is between low and high: above the first, up to the second."""
    if not step:
        return (-inf, inf) if low <= start <= high else (inf, -inf)
    ends = sorted(((low - start) / step, (high - start) / step))
    return ceil(ends[0] - 1e-9) - 1, floor(ends[1] + 1e-9)
