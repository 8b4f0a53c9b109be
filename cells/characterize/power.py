"""Energy of an input's edge that moves no output."""

import numpy as np

from cells.characterize.bench import QUICK, REST


def quiet_energy(bench, pin):
    """{'rise': (slews,) J, 'fall': ...} from the supply when ``pin`` toggles and every output stays, or None.

    The mean over the states in which that happens, at most Conditions.states of them for each direction.
    """
    machine, found = bench.machine, {}
    for level, name in ((1, "rise"), (0, "fall")):
        changes = {}
        for change in sorted(machine.changes, key=lambda c: len(c.before.path)):
            if (machine.inputs[change.pin] == pin and change.after.inputs[change.pin] == level
                    and change.before.outputs == change.after.outputs):
                changes.setdefault((change.before.inputs, change.before.outputs), change)
        changes = list(changes.values())
        if not changes:
            return None
        few = min(len(changes), bench.conditions.states)
        chosen = [changes[round(i)] for i in np.linspace(0, len(changes) - 1, few)]
        found[name] = np.array([np.mean([_energy(bench, change, slew) for change in chosen])
                                for slew in bench.conditions.slews])
    return found


def _energy(bench, change, slew):
    ramp = bench.conditions.ramp(slew)
    points, start = bench.stimulus(bench.path(change.before), bench.settling + QUICK,
                                   {change.pin: [(0.0, ramp, change.after.inputs[change.pin])]})
    stop = start + ramp + bench.settling
    loads = dict.fromkeys(bench.machine.outputs, bench.conditions.least_load)
    wave = bench.simulator.transient(points, loads, stop, (stop - start) / bench.conditions.settings.steps)
    return bench.volts * sum(bench.moved(wave, rail, start - REST / 4, stop) for rail in bench.supplies)
