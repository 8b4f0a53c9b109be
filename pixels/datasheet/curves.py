"""Curves of a column for the model: a diode's signal at its lane, and its weight in a sum.

In a sum the charge amplifiers have other loads than in a difference, the second diode's the larger one: it is not yet
at rest as the read ends, the first diode's is. In the reads of taps after the first the second diode's holder takes no
charge: there it has more.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from talbot.cells.corner import Corner
from talbot.models.parameters import ColumnCurves
from talbot.pixels.circuits import column as columns
from talbot.pixels.circuits.column_sizes import ColumnSizes, ColumnSpec
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.datasheet.column import FULL, QUIET, WELLS, bench, opened, sample, turn_of
from talbot.pixels.datasheet.deck import Setup

OF_TAP = "w", "f", "fn", "unasked"  # the lines that each tap has
FILLS = (*WELLS, 0.85, 0.9, 0.94, FULL)  # of a full well: a bend begins at 0.85
SOURCES = {
    "fills": "of a full well",
    **dict.fromkeys(("a", "b"), "charges of a column's diode in ngspice, the other empty"),
    **dict.fromkeys(("a_other", "b_other"), "charges of the other diode in ngspice"),
    **dict.fromkeys(("sum_a", "sum_b"), "charges of one diode in ngspice, in a sum, the other empty"),
    **dict.fromkeys(("later_a", "later_b"), "the same of a column's second tap"),
}
PROOF = 0.87, 0.47  # of a full well, of both diodes: between those of FILLS


@dataclass(frozen=True)
class ColumnFit:
    """Fitted curves. error, sum_error: LSB of the lane's converter by which ``curves`` are off at PROOF, in edge mode
    and of the sums of the first and of the second tap."""

    curves: ColumnCurves
    error: float
    sum_error: float


def later_bench(sizes: ColumnSizes, spec: ColumnSpec) -> Circuit:
    """Return the bench of a column whose second tap is driven as the first was, which is at rest."""
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
    """A column as `models.parameters.circuit_columns` has it. start: V, trimmed. drawn: instead of the circuit."""

    def given(made: Circuit) -> Circuit:
        return made.replaced(drawn) if drawn else made

    end, plain = turn_of(spec) + spec.cycle, given(bench(sizes, spec))
    alone = [(0.0, 0.0), *((fill, 0.0) for fill in FILLS[1:]), *((0.0, fill) for fill in FILLS[1:])]

    def lanes(circuit: Circuit, image: bool) -> npt.NDArray[np.float64]:
        """Return both lanes' voltages at each of ``alone`` and at PROOF, less those without light, V: (points, 2)."""
        with opened(setup, spec, sizes, corner, start, image, circuit=circuit) as spice:
            waves = [sample(spice, spec, corner, a * spec.fall, b * spec.fall, image) for a, b in (*alone, PROOF)]
        volts = np.array([[wave.at("far_a", end), wave.at("far_b", end)] for wave in waves])
        return volts[0] - volts

    def each(of: npt.NDArray[np.float64]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Rows of ``alone`` where a, and where b has light, each from none on."""
        count = len(FILLS)
        return of[:count], np.concatenate([of[:1], of[count:-1]])

    got = lanes(plain, False) / spec.swing  # of a full well
    firsts, laters = (lanes(one, True)[:, 0] / (spec.swing / 4) for one in (plain, given(later_bench(sizes, spec))))
    of_a, of_b = each(got)
    found = of_a[:, 0], of_b[:, 1], of_b[:, 0], of_a[:, 1], *each(firsts), *each(laters)
    rounded = [tuple(round(float(one), 6) for one in curve) for curve in found]
    a, b, a_other, b_other, sum_a, sum_b, later_a, later_b = rounded
    curves = ColumnCurves(FILLS, a, b, a_other, b_other, sum_a, sum_b, later_a, later_b)
    proof = np.array(PROOF)
    off = float(np.abs(curves.delivered(proof) - got[-1]).max()) * spec.swing
    sums_off = max(abs(curves.summed(proof, later).sum() - of[-1]) for later, of in ((False, firsts), (True, laters)))
    return ColumnFit(curves, round(off / spec.lsb, 4), round(float(sums_off) * spec.swing / 4 / spec.lsb, 4))
