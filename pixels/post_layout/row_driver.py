"""The datasheet's lines of the drawn row's driver."""

from collections.abc import Iterator

from talbot.pixels.circuits.row_driver import RowDriverSpec
from talbot.pixels.datasheet.row_driver import RowDriverResult
from talbot.pixels.post_layout.pairs import Pair
from talbot.pixels.post_layout.row import Row


def rows(spec: RowDriverSpec, found: Pair[RowDriverResult]) -> Iterator[Row]:
    """Return figures of layout and schematic, with the limits of `make analog`."""
    row = found.row
    yield row("row driver: wrong levels", "", lambda one: not one.right, 0.0)
    yield row("row driver: far end within 1 %", "ns", lambda one: 1e9 * one.settling, 1e9 * spec.settle)
    yield row("row driver: far end from 10 to 90 %", "ns", lambda one: 1e9 * one.slew, 1e9 * spec.slew)
    yield row("row driver: energy of a pulse", "pJ", lambda one: 1e12 * one.energy)
    yield row("row driver: current of a row at rest", "uA", lambda one: 1e6 * one.idle, 1e6 * spec.idle)
