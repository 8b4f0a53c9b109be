"""The drawn column in the bench of `make analog`, and its lines of the datasheet."""

from collections.abc import Iterator

from talbot.cells.corner import Corner
from talbot.pixels.circuits.column_sizes import ColumnSizes, ColumnSpec
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.datasheet import column
from talbot.pixels.datasheet.column import ColumnResult
from talbot.pixels.datasheet.deck import Setup
from talbot.pixels.datasheet.turn import TurnResult
from talbot.pixels.post_layout.pairs import Pair
from talbot.pixels.post_layout.row import Row


def measure(
    setup: Setup, spec: ColumnSpec, sizes: ColumnSizes, corner: Corner, drawn: Circuit | None = None
) -> ColumnResult:
    """Measure a column; drawn: instead of the circuit."""
    bench = column.bench(sizes, spec).replaced(drawn) if drawn else None
    return column.measure(setup, spec, sizes, corner, bench)


def rows(spec: ColumnSpec, found: Pair[ColumnResult]) -> Iterator[Row]:
    """Return figures of layout and schematic, with the limits of `make analog`."""
    row = found.row
    yield row("column: slope, off by", "%", lambda one: 100 * abs(one.slope - 1), 100 * spec.slope)
    yield row("column: slope of both diodes' mean, off by", "%", lambda one: 100 * abs(one.mean - 1), 100 * spec.slope)
    yield row("column: INL", "LSB", lambda one: one.inl, spec.inl)
    yield row("column: by the other diode's light", "LSB", lambda one: one.other, spec.settling)
    yield row("column: settling to half an LSB", "ns", lambda one: 1e9 * one.settling, 1e9 * spec.cycle)
    yield row("column: droop until the last column's turn", "LSB", lambda one: one.droop, spec.droop)
    yield row("column: energy of a pixel", "pJ", lambda one: 1e12 * one.energy, 1e12 * spec.energy)


def turn_rows(spec: ColumnSpec, found: Pair[TurnResult]) -> Iterator[Row]:
    """Column, lane's line and amplifier, both drawn."""
    yield found.row("turn: left at the lane after one cycle", "LSB", lambda one: one.left, spec.settling)
    yield found.row("turn: at the lane to half an LSB", "ns", lambda one: 1e9 * one.settling)
