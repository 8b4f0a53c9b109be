"""The points of a table's axes: the foundry's spacing, and more where the table bends.

The error of an interpolated value is measured halfway between two points, along two lines through the table for both
edges of an output. A point is added in the middle of the worst interval until none is worse than Conditions.bend or
Conditions.extra points have been added.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from talbot.cells.characterize.bench import Bench, Edge
from talbot.cells.netlist.states import Change

FLOOR = 5e-12  # s; smaller delays are compared as if they were this long
Axis = tuple[float, ...]
Line = Callable[[float], Edge]


def refined(bench: Bench, changes: Sequence[Change], output: str, loads: Sequence[float]) -> tuple[Axis, Axis, float]:
    """Slews and loads of ``output``, and the worst relative error halfway between two of them.

    changes: one for each edge of ``output``. loads: the axis to start from.
    """
    c = bench.conditions

    def along_slew(change: Change, load: float) -> Line:
        return lambda slew: bench.edge(change, output, slew, load)

    def along_load(change: Change, slew: float) -> Line:
        return lambda load: bench.edge(change, output, slew, load)

    slew_lines = [along_slew(change, load) for change in changes for load in (loads[1], loads[len(loads) // 2])]
    load_lines = [along_load(change, slew) for change in changes for slew in (c.slews[1], c.middle_slew)]
    slews, slew_error = _refine(c.slews, slew_lines, c.bend, c.extra)
    more_loads, load_error = _refine(loads, load_lines, c.bend, c.extra)
    return slews, more_loads, max(slew_error, load_error)


def _refine(start: Sequence[float], lines: Sequence[Line], bend: float, extra: int) -> tuple[Axis, float]:
    """The axis with up to ``extra`` more points, and the worst error left."""
    axis, errors = list(start), {}
    while True:
        for low, high in pairwise(axis):
            if (low, high) not in errors:
                errors[low, high] = max(_halfway_error(line, low, high) for line in lines)
        worst = max(pairwise(axis), key=errors.__getitem__)
        if errors[worst] <= bend or extra == 0:
            return tuple(axis), float(errors[worst])
        axis = sorted([*axis, float(np.sqrt(worst[0] * worst[1]))])
        extra -= 1


def _halfway_error(line: Line, low: float, high: float) -> float:
    """Relative error of delay or slew in the (geometric) middle of an interval, if interpolated."""
    half = float(np.sqrt(low * high))
    share = (half - low) / (high - low)
    first, exact, last = line(low), line(half), line(high)
    values = [[getattr(edge, name) for edge in (first, exact, last)] for name in ("delay", "slew")]
    return max(abs(a * (1 - share) + b * share - middle) / max(abs(middle), FLOOR) for a, middle, b in values)
