"""Rows of a datasheet in CACE's manner: figures over corners or draws, with limits."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """A characteristic. low, typical, high: over ``over``; None where there is no such value.

    least, most: limits, None for none. ``unit`` scales nothing: values are in it. error: half width of the 95 %
    interval of a statistic, which is inside ``high``.
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

    @property
    def passes(self) -> bool:
        """True if every value is inside the limits."""
        values = [value for value in (self.low, self.typical, self.high) if value is not None]
        return all(
            (self.least is None or value >= self.least) and (self.most is None or value <= self.most)
            for value in values
        )

    @property
    def texts(self) -> tuple[str, ...]:
        """The row's cells; numbers to three digits."""
        limits = (">=", self.least), ("<=", self.most)
        limit = " ".join(f"{sign} {_text(value)}" for sign, value in limits if value is not None)
        numbers = ("" if v is None else _text(v) for v in (self.low, self.typical, self.high))
        verdict = ("pass" if self.passes else "FAIL") if limit else ""
        return (f"{self.circuit}: {self.name}", verdict, *numbers, limit, self.unit, self.worst or self.over)


def _text(value: float) -> str:
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
