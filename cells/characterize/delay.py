"""Delay, slew and energy tables of an arc, and the load that an output may drive."""

from collections.abc import Iterable, Sequence

import numpy as np

from talbot.cells.characterize.bench import Bench, spread
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.table import Table
from talbot.cells.netlist.function import Arc
from talbot.cells.netlist.states import Change

FIELDS = ("delay", "slew", "energy")
MOST = 32  # states of an arc that are tried


def chosen(bench: Bench, arc: Arc, load: float) -> Change:
    """The change of ``arc`` with the longest delay at the middle slew and ``load`` F; the shortest: Conditions.fastest.

    Liberty without conditions has one table for an arc: that of one state. At most MOST states are tried, spread over
    all.
    """
    few, slew = spread(arc.changes, MOST), bench.conditions.middle_slew
    choose = min if bench.conditions.fastest else max
    return few[0] if len(few) == 1 else choose(few, key=lambda c: bench.edge(c, arc.output, slew, load).delay)


def table(
    bench: Bench, change: Change, output: str, loads: Sequence[float], slews: Sequence[float] | None = None
) -> Table:
    """Table of delay, slew and energy of ``output`` when ``change`` happens."""
    slews = slews or bench.conditions.slews
    edges = [[bench.edge(change, output, slew, load) for load in loads] for slew in slews]
    values = {f: np.array([[getattr(e, f) for e in row] for row in edges]) for f in FIELDS}
    return Table(tuple(slews), tuple(loads), values)


def largest_load(bench: Bench, changes: Iterable[Change], output: str, longest: float) -> float:
    """F at which the slew of ``output`` reaches ``longest`` s, as the input's has, for the slower of ``changes``.

    Secant steps on an almost straight line, to 0.1 %.
    """
    return min(_largest(bench, change, output, longest) for change in changes)


def _largest(bench: Bench, change: Change, output: str, longest: float) -> float:
    loads = [50e-15, 100e-15]
    slews = [bench.edge(change, output, longest, load).slew for load in loads]
    for _ in range(8):
        rate = (slews[-1] - slews[-2]) / (loads[-1] - loads[-2])
        load = max(loads[-1] + (longest - slews[-1]) / rate, loads[-1] / 10, 1e-15)
        if abs(load - loads[-1]) < 1e-3 * load:
            return load
        loads.append(load)
        slews.append(bench.edge(change, output, longest, load).slew)
    return loads[-1]


def load_axis(conditions: Conditions, largest: float) -> tuple[float, ...]:
    """Loads from the least to ``largest`` F, each the same factor above the one before."""
    return tuple(float(x) for x in np.geomspace(conditions.least_load, largest, conditions.loads))
