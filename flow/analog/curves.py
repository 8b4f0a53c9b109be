"""What the model takes of a column: what of a diode's charge reaches its lane, and how much more sums have.

In the reads of taps after the first the second diode's holder takes no charge: their sums are somewhat larger.
"""

from dataclasses import dataclass, replace

import numpy as np

from talbot.cells.corner import Corner
from talbot.models.parameters import ColumnCurves
from talbot.pixels.circuits import column as columns
from talbot.pixels.circuits.column_sizes import ColumnSizes, ColumnSpec
from talbot.pixels.circuits.netlist import Circuit

from .column import BOTH, FULL, QUIET, WELLS, bench, mean_of, opened, sample, turn_of
from .deck import Setup

OF_TAP = "w", "f", "fn", "unasked"  # the lines that each tap has
FILLS = (*WELLS, 0.85, 0.9, 0.94, FULL)  # of a full well: a bend begins at 0.85
SOURCES = {
    "fills": "of a full well",
    **dict.fromkeys(("a", "b"), "charges of a column's diode in ngspice, the other empty"),
    **dict.fromkeys(("a_other", "b_other"), "charges of the other diode in ngspice"),
    "sum": "of both diodes' charges, the first tap of a column in ngspice",
    "later_sum": "of the second tap",
}
PROOF = 0.87, 0.47  # of a full well, of both diodes: between those of FILLS


@dataclass(frozen=True)
class ColumnFit:
    """What was fitted. error: LSB of the lane's converter in edge mode by which ``curves`` are off at PROOF."""

    curves: ColumnCurves
    error: float


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


def fitted(
    setup: Setup,
    spec: ColumnSpec,
    sizes: ColumnSizes,
    corner: Corner,
    start: tuple[float, float],
    drawn: Circuit | None = None,
) -> ColumnFit:
    """A column as `models.parameters.circuit_columns` has it. start: V, trimmed. drawn: in place of the circuit."""

    def given(made: Circuit) -> Circuit:
        return made.replaced(drawn) if drawn else made

    end, plain = turn_of(spec) + spec.cycle, given(bench(sizes, spec))
    with opened(setup, spec, sizes, corner, start, circuit=plain) as spice:

        def lanes(a: float, b: float) -> tuple[float, float]:
            wave = sample(spice, spec, corner, a * spec.fall, b * spec.fall)
            return wave.at("far_a", end), wave.at("far_b", end)

        volts = [lanes(0.0, 0.0)]
        volts += [lanes(fill, 0.0) for fill in FILLS[1:]] + [lanes(0.0, fill) for fill in FILLS[1:]]
        proof = lanes(*PROOF)
    got = (volts[0] - np.array(volts)) / spec.swing  # of a full well
    of_a, of_b = got[: len(FILLS)], np.vstack([got[:1], got[len(FILLS) :]])
    own, other = (of_a[:, 0], of_b[:, 1]), (of_b[:, 0], of_a[:, 1])
    sums = []
    for circuit in (plain, given(later_bench(sizes, spec))):
        with opened(setup, spec, sizes, corner, start, True, circuit=circuit) as spice:
            sums.append(mean_of(spice, spec, corner)[0])
    a, b, a_other, b_other = (tuple(round(float(one), 6) for one in row) for row in (*own, *other))
    curves = ColumnCurves(FILLS, a, b, a_other, b_other, 1.0, 1.0)
    mean = curves.delivered(np.array(BOTH)).sum() / sum(BOTH)
    curves = replace(curves, sum=round(sums[0] / mean, 5), later_sum=round(sums[1] / mean, 5))
    off = curves.delivered(np.array(PROOF)) - (np.array(volts[0]) - proof) / spec.swing
    return ColumnFit(curves, round(float(np.abs(off).max()) * spec.swing / spec.lsb, 4))
