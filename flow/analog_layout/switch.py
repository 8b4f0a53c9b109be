"""The drawn switch drivers with their parasitics, measured as the schematic is, at each corner."""

from collections.abc import Iterator, Mapping

from talbot.base.jobs import Job, run
from talbot.base.paths import BUILD
from talbot.cells.corner import Corner
from talbot.flow.analog.deck import Setup
from talbot.flow.analog.support import phases
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.circuits.support import SupportSpec

from .extract import Extracted
from .row import Row

STORE = BUILD / "analog-layout" / "switches"


def gaps(setup: Setup, spec: SupportSpec, corner: Corner, circuit: Circuit | None = None) -> list[float]:
    """S with both phases low, the shortest and the longest."""
    found, _ = phases(setup, spec, corner, circuit)
    return [min(found), max(found)]


def rows(setup: Setup, found: Mapping[str, Extracted], workers: int) -> Iterator[Row]:
    """Both gaps; found: the extracted drivers by corner."""
    spec, jobs = SupportSpec(), list[Job]()
    for name, drawn in found.items():
        given = setup, spec, Corner.parse(name)
        text = repr((drawn.transistors, drawn.capacitors, drawn.resistors, sorted(drawn.drawn.items())))
        jobs.append(Job(f"schematic-{name}", gaps, given, (repr(given),)))
        jobs.append(Job(f"layout-{name}", gaps, (*given, drawn), (repr(given), text)))
    results = run(jobs, STORE, "switch drivers", workers)
    for name, (short, long), (drawn_short, drawn_long) in zip(found, results[::2], results[1::2], strict=True):
        yield Row("switch drivers: shortest gap", "ns", 1e9 * short, 1e9 * drawn_short, name, least=1e9 * spec.gap)
        yield Row("switch drivers: longest gap", "ns", 1e9 * long, 1e9 * drawn_long, name, 1e9 * spec.lost)
