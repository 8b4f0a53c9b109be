"""A column's gain for taps after the first, in whose reads the second diode's holder takes no charge."""

from dataclasses import replace

from talbot.cells.corner import Corner
from talbot.pixels.circuits import column as columns
from talbot.pixels.circuits.column_sizes import ColumnSizes, ColumnSpec
from talbot.pixels.circuits.netlist import Circuit

from .column import QUIET, ColumnResult, bench, mean_of, opened
from .deck import Setup

OF_TAP = "w", "f", "fn", "unasked"  # the lines that each tap has


def later_bench(sizes: ColumnSizes, spec: ColumnSpec) -> Circuit:
    """The bench of a column whose second tap is driven as the first was, which is at rest."""
    made = bench(sizes, spec)
    nodes = {f"{name}1": f"{name}0" for name in OF_TAP}
    nodes |= {f"{name}0": "vdd" if QUIET[f"{name}1"] else "vss" for name in OF_TAP}
    parts = list(made.instances)
    at = [part.name for part in parts].index("column")
    pins = zip(map(columns.line, columns.PINS), parts[at].nodes, strict=True)
    parts[at] = parts[at]._replace(nodes=tuple(nodes.get(pin, node) for pin, node in pins))
    return replace(made, instances=tuple(parts))


def later_mean(
    setup: Setup,
    spec: ColumnSpec,
    sizes: ColumnSizes,
    corner: Corner,
    start: tuple[float, float],
    drawn: Circuit | None = None,
) -> float:
    """`ColumnResult.mean` of a tap after the first. start: V, of the trimmed column. drawn: in place of the circuit."""
    made = later_bench(sizes, spec)
    circuit = made.replaced(drawn) if drawn else made
    with opened(setup, spec, sizes, corner, start, True, circuit=circuit) as spice:
        return mean_of(spice, spec, corner)[0]


def gains(found: ColumnResult, later: float) -> dict[str, float]:
    """What `models.parameters.circuit_columns` reads. later: `later_mean`."""
    return {"diode": round(found.slope, 5), "sum": round(found.mean, 5), "later_sum": round(later, 5)}
