"""The drawn row's driver with its parasitics, measured as the schematic is, at each corner."""

from collections.abc import Callable, Iterator, Mapping

from talbot.base.jobs import Job, run
from talbot.base.paths import BUILD
from talbot.base.records import from_json
from talbot.cells.corner import Corner
from talbot.flow.analog.deck import Setup
from talbot.flow.analog.row_driver import RowDriverResult, measure
from talbot.pixels.circuits.row_driver import RowDriverSpec

from .extract import Extracted
from .row import Row

STORE = BUILD / "analog-layout" / "rows"


def rows(setup: Setup, found: Mapping[str, Extracted], workers: int) -> Iterator[Row]:
    """Every characteristic; found: the extracted row by corner."""
    spec, jobs = RowDriverSpec.of(), list[Job]()
    for name, drawn in found.items():
        given = setup, spec, Corner.parse(name)
        text = repr((drawn.transistors, drawn.capacitors, drawn.resistors, sorted(drawn.drawn.items())))
        jobs.append(Job(f"schematic-{name}", measure, given, (repr(given),)))
        jobs.append(Job(f"layout-{name}", measure, (*given, drawn), (repr(given), text)))
    results = [from_json(RowDriverResult, one) for one in run(jobs, STORE, "row driver", workers)]
    for name, schematic, layout in zip(found, results[::2], results[1::2], strict=True):

        def row(
            what: str,
            unit: str,
            value: Callable[[RowDriverResult], float],
            most: float | None,
            corner: str = name,
            one: RowDriverResult = schematic,
            other: RowDriverResult = layout,
        ) -> Row:
            return Row(f"row driver: {what}", unit, float(value(one)), float(value(other)), corner, most)

        yield row("wrong levels", "", lambda one: not one.right, 0.0)
        yield row("far end within 1 %", "ns", lambda one: 1e9 * one.settling, 1e9 * spec.settle)
        yield row("far end from 10 to 90 %", "ns", lambda one: 1e9 * one.slew, 1e9 * spec.slew)
        yield row("energy of a pulse", "pJ", lambda one: 1e12 * one.energy, None)
        yield row("current of a row at rest", "uA", lambda one: 1e6 * one.idle, 1e6 * spec.idle)
