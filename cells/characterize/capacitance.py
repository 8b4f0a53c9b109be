"""Input capacitance, as static timing uses it: the charge up to the switching point, over that part of the swing.

The whole charge of an edge counts the Miller charge of a stage that has switched by then; over the first half of the
ramp the reference's figures come out within 5 % (SkyWater's own, four cells, make cells-report).
"""

import numpy as np

LOAD = 10e-15          # F on every output


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
    loads = dict.fromkeys(bench.machine.outputs, LOAD)
    wave, start = bench.run(change.before, edges, c.middle * ramp, ramp / 20, loads)
    stop = start + c.middle * ramp
    return abs(wave.charge(bench.machine.inputs[change.pin], start, stop)) / (c.middle * bench.volts)
