"""Circuits measured as their schematics and as they are drawn, corner by corner."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from talbot.base.jobs import Job, run
from talbot.base.paths import BUILD
from talbot.base.records import from_json
from talbot.cells.corner import Corner
from talbot.pixels.post_layout.extract import Extracted
from talbot.pixels.post_layout.row import Row

STORE = BUILD / "analog-layout" / "measured"
T = TypeVar("T")
Part = TypeVar("Part")


@dataclass(frozen=True)
class Pair(Generic[T]):
    """Measurements at a corner, of the schematic and of the layout."""

    corner: str
    schematic: T
    layout: T

    def of(self, part: Callable[[T], Part]) -> "Pair[Part]":
        """Return a part of both."""
        return Pair(self.corner, part(self.schematic), part(self.layout))

    def row(
        self, name: str, unit: str, value: Callable[[T], float], most: float | None = None, least: float | None = None
    ) -> Row:
        """Return a characteristic of both."""
        return Row(name, unit, float(value(self.schematic)), float(value(self.layout)), self.corner, most, least)


def pairs(
    what: str,
    measure: Callable[..., T],
    record: type[T],
    arguments: Sequence[Any],
    drawn: Mapping[str, Sequence[Extracted]],
    workers: int,
) -> Iterator[Pair[T]]:
    """Measure at every corner; what an earlier run measured of the same circuits is read.

    measure: called with ``arguments`` and the corner, then for the layout with its circuits, too. drawn: these by
    corner. record: what it returns.
    """
    jobs = []
    for corner, circuits in drawn.items():
        given = *arguments, Corner.parse(corner)
        text = [repr((one.transistors, one.capacitors, one.resistors, sorted(one.drawn.items()))) for one in circuits]
        jobs.append(Job(f"schematic-{corner}", measure, given, (repr(given),)))
        jobs.append(Job(f"layout-{corner}", measure, (*given, *circuits), (repr(given), *text)))
    results = [from_json(record, one) for one in run(jobs, STORE / what.replace(" ", "-"), what, workers)]
    for corner, schematic, layout in zip(drawn, results[::2], results[1::2], strict=True):
        yield Pair(corner, schematic, layout)
