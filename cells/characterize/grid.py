"""Where the points of a table lie: the foundry's spacing, and more where the table bends.

A slew or load between two points is interpolated; how wrong that is, is measured halfway, along two lines through the
table for both edges of an output, and a point is added in the middle of the worst interval until none is worse than
Conditions.bend or Conditions.extra points have been added.
"""

import numpy as np

FLOOR = 5e-12  # s; smaller delays are compared as if they were this long


def refined(bench, changes, output, loads):
    """(slews, loads, worst share by which a halfway value is wrong): axes of ``output`` as tuples.

    changes: one for each edge of ``output``. loads: the axis to start from.
    """
    c = bench.conditions
    middle = len(loads) // 2

    def along_slew(change, fixed):
        return lambda slew: bench.edge(change, output, slew, fixed)

    def along_load(change, fixed):
        return lambda load: bench.edge(change, output, fixed, load)

    slew_lines = [along_slew(change, load) for change in changes for load in (loads[1], loads[middle])]
    load_lines = [along_load(change, slew) for change in changes for slew in (c.slews[1], c.slews[len(c.slews) // 2])]
    slews, slew_error = _refine(c.slews, slew_lines, c.bend, c.extra)
    more_loads, load_error = _refine(loads, load_lines, c.bend, c.extra)
    return slews, more_loads, max(slew_error, load_error)


def _refine(axis, lines, bend, extra):
    """(axis with up to ``extra`` more points, the worst error left)."""
    axis, errors = list(axis), {}
    while True:
        for pair in zip(axis, axis[1:], strict=False):
            if pair not in errors:
                errors[pair] = max(_halfway_error(line, *pair) for line in lines)
        worst = max(zip(axis, axis[1:], strict=False), key=errors.get)
        if errors[worst] <= bend or extra == 0:
            return tuple(axis), float(errors[worst])
        axis = sorted([*axis, float(np.sqrt(worst[0] * worst[1]))])
        extra -= 1


def _halfway_error(line, low, high):
    """Share by which delay or slew is wrong in the (geometric) middle of an interval, if interpolated."""
    half = float(np.sqrt(low * high))
    share = (half - low) / (high - low)
    first, exact, last = line(low), line(half), line(high)
    return max(
        abs(getattr(first, name) * (1 - share) + getattr(last, name) * share - getattr(exact, name))
        / max(abs(getattr(exact, name)), FLOOR)
        for name in ("delay", "slew")
    )
