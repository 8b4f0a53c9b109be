"""The drawn switch drivers with their parasitics, measured as the schematic is."""

from collections.abc import Iterator
from dataclasses import dataclass

from talbot.cells.corner import Corner
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.circuits.support import SupportSpec
from talbot.pixels.datasheet.deck import Setup
from talbot.pixels.datasheet.support import phases
from talbot.pixels.post_layout.pairs import Pair
from talbot.pixels.post_layout.row import Row


@dataclass(frozen=True)
class Gaps:
    """Time with both phases low, s."""

    shortest: float
    longest: float


def measure(setup: Setup, spec: SupportSpec, corner: Corner, circuit: Circuit | None = None) -> Gaps:
    """Return the gaps at a corner; circuit: instead of the schematic."""
    found, _ = phases(setup, spec, corner, circuit)
    return Gaps(min(found), max(found))


def rows(spec: SupportSpec, found: Pair[Gaps]) -> Iterator[Row]:
    """Return figures of layout and schematic, with the limits of `make analog`."""
    yield found.row("switch drivers: shortest gap", "ns", lambda one: 1e9 * one.shortest, least=1e9 * spec.gap)
    yield found.row("switch drivers: longest gap", "ns", lambda one: 1e9 * one.longest, 1e9 * spec.lost)
