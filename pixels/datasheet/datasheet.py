"""Rows of a datasheet in CACE's manner: figures over corners or draws, with limits."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil

RELATIVE = 1.96  # half of a 95 % interval of an RMS, times sqrt(2 (draws - 1)), relative


@dataclass(frozen=True)
class Row:
    """A characteristic. low, typical, high: over ``over``; None where there is no such value.

    least, most: limits, None for none. ``unit`` scales nothing: values are in it. draws: of a statistic, whose low and
    high are the ends of its 95 % interval.
    """

    circuit: str
    name: str
    unit: str
    typical: float | None
    low: float | None
    high: float | None
    least: float | None = None
    most: float | None = None
    over: str = "corners"
    worst: str = ""
    draws: int | None = None

    @property
    def verdict(self) -> str:
        """'pass', 'FAIL', 'open' of a statistic whose interval has the limit inside, '' without a limit."""
        if self.most is None and self.least is None:
            return ""
        inside = self.draws and self.most is not None and self.low is not None and self.low <= self.most
        return "pass" if self.passes else "open" if inside else "FAIL"

    @property
    def draws_needed(self) -> int | None:
        """Draws whose interval would be below ``most`` if the RMS stayed as it is; None where it is not below."""
        if self.most is None or not self.typical or self.typical >= self.most:
            return None
        return 1 + ceil((RELATIVE / (self.most / self.typical - 1)) ** 2 / 2)

    @property
    def passes(self) -> bool:
        """True if every value is inside the limits."""
        values = [v for v in (self.typical if self.draws else self.low, self.typical, self.high) if v is not None]
        return all(
            (self.least is None or value >= self.least) and (self.most is None or value <= self.most)
            for value in values
        )

    @property
    def texts(self) -> tuple[str, ...]:
        """The row's cells; numbers to three digits."""
        limits = (">=", self.least), ("<=", self.most)
        limit = " ".join(f"{sign} {shown(value)}" for sign, value in limits if value is not None)
        numbers = ("" if v is None else shown(v) for v in (self.low, self.typical, self.high))
        return (f"{self.circuit}: {self.name}", self.verdict, *numbers, limit, self.unit, self.worst or self.over)


def shown(value: float) -> str:
    """Return a value to three digits, and to whole ones: a level in mV that is trimmed to an LSB of 1.95 has four."""
    return f"{value:.0f}" if abs(value) >= 999.5 else f"{value:.3g}"


HEAD = ("characteristic", "", "min", "typ", "max", "limit", "unit", "worst at, or over")


def over_corners(
    circuit: str,
    name: str,
    unit: str,
    values: Iterable[tuple[str, float]],
    typical: str,
    least: float | None = None,
    most: float | None = None,
) -> Row:
    """Return a row of (corner, value) pairs; the worst corner is named. typical: the corner of the typical value."""
    found: Sequence[tuple[str, float]] = list(values)
    numbers = dict(found)
    far = max(found, key=lambda pair: pair[1]) if least is None else min(found, key=lambda pair: pair[1])
    low, high = min(numbers.values()), max(numbers.values())
    return Row(circuit, name, unit, numbers.get(typical), low, high, least, most, worst=far[0])
