"""Input capacitance, as static timing uses it: the charge over most of a ramp, over that part of the swing.

The whole charge of an edge counts what the cell's own outputs push back after the input has arrived. Up to 90 % of a
middle ramp, with the middle of the load axis on every output, the figures of SkyWater's four cells come out within 4 %;
up to 50 % or 100 %, with other slews or loads, within 6 % to 20 %.
"""

import numpy as np

END = 0.9  # of the ramp, up to which charge counts


def capacitance(bench, pin):
    """(rise, fall) in F of the input ``pin`` at the middle slew: the mean over states.

    States in which an output follows, where there are any, at most Conditions.states of them for each direction.
    """
    return tuple(float(np.mean([_one(bench, change) for change in _changes(bench, pin, level)])) for level in (1, 0))


def _changes(bench, pin, level):
    machine, found = bench.machine, {}
    for change in sorted(machine.changes, key=lambda c: len(c.before.path)):
        if machine.inputs[change.pin] == pin and change.after.inputs[change.pin] == level:
            found.setdefault((change.before.inputs, change.before.outputs), change)
    changes = list(found.values())
    changes = [c for c in changes if c.before.outputs != c.after.outputs] or changes
    few = min(len(changes), bench.conditions.states)
    return [changes[round(i)] for i in np.linspace(0, len(changes) - 1, few)]


def _one(bench, change):
    c = bench.conditions
    ramp = c.ramp(c.slews[len(c.slews) // 2])
    edges = {change.pin: [(0.0, ramp, change.after.inputs[change.pin])]}
    wave, start = bench.run(change.before, edges, ramp, ramp / 50, bench.middle)
    return abs(wave.charge(bench.machine.inputs[change.pin], start, start + END * ramp)) / (END * bench.volts)
