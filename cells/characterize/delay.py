"""Delay, slew and energy tables of an arc, and the load that an output may drive."""

import numpy as np

from cells.characterize.table import Table

FIELDS = ("delay", "slew", "energy")


def slowest(bench, arc, load):
    """The change of ``arc`` with the longest delay at the middle slew and ``load`` F.

    Liberty without conditions has one table for an arc: the slowest state stands for all. At most
    ``Conditions.states`` states are tried, spread over those there are.
    """
    changes = arc.changes
    if len(changes) == 1:
        return changes[0]
    few = [changes[round(i)] for i in np.linspace(0, len(changes) - 1, min(len(changes), bench.conditions.states))]
    slew = bench.conditions.slews[len(bench.conditions.slews) // 2]
    return max(few, key=lambda change: bench.edge(change, arc.output, slew, load).delay)


def table(bench, change, output, loads, slews=None):
    """Table of delay, slew and energy of ``output`` when ``change`` happens."""
    slews = slews or bench.conditions.slews
    edges = [[bench.edge(change, output, slew, load) for load in loads] for slew in slews]
    values = {f: np.array([[getattr(e, f) for e in row] for row in edges]) for f in FIELDS}
    return Table(tuple(slews), tuple(loads), values)


def largest_load(bench, changes, output):
    """F at which the slew of ``output`` reaches Conditions.longest_slew, for the slower of ``changes``.

    Secant steps on an almost straight line, to 0.1 %.
    """
    c = bench.conditions
    return min(_largest(bench, change, output, c.slews[-1], c.longest_slew) for change in changes)


def _largest(bench, change, output, slew, wanted):
    loads = [50e-15, 100e-15]
    slews = [bench.edge(change, output, slew, load).slew for load in loads]
    for _ in range(8):
        rate = (slews[-1] - slews[-2]) / (loads[-1] - loads[-2])
        load = max(loads[-1] + (wanted - slews[-1]) / rate, loads[-1] / 10, 1e-15)
        if abs(load - loads[-1]) < 1e-3 * load:
            return load
        loads.append(load)
        slews.append(bench.edge(change, output, slew, load).slew)
    return loads[-1]


def load_axis(conditions, largest):
    """Loads from the least to ``largest`` F, each the same factor above the one before."""
    return tuple(float(x) for x in np.geomspace(conditions.least_load, largest, conditions.loads))
