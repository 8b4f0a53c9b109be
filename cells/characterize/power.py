"""Energy of an input's edge that moves no output."""

import numpy as np

from cells.characterize.bench import REST

MOST = 8  # states that are tried


def quiet_energy(bench, pin):
    """{'rise': (slews,) J, 'fall': ...} from the supply when ``pin`` toggles and every output stays, or None.

    Of the states in which that happens the one that takes least at the middle slew: what moves inside the cell in
    the others belongs to the edge that brings it to an output. SkyWater's figures are of that state, too.
    """
    slews, found = bench.conditions.slews, {}
    for level, name in ((1, "rise"), (0, "fall")):
        changes = _quiet_changes(bench.machine, pin, level)
        if not changes:
            return None
        few = min(len(changes), MOST)
        chosen = [changes[round(i)] for i in np.linspace(0, len(changes) - 1, few)]
        least = min(chosen, key=lambda change: _energy(bench, change, slews[len(slews) // 2]))
        found[name] = np.array([_energy(bench, least, slew) for slew in slews])
    return found


def _quiet_changes(machine, pin, level):
    """Changes of ``pin`` to ``level`` that move no output, driven or not, one for every pair of inputs and outputs."""
    found = {}
    for change in sorted(machine.changes, key=lambda c: len(c.before.path)):
        if (
            machine.inputs[change.pin] == pin
            and change.after.inputs[change.pin] == level
            and change.before.kept == change.after.kept
        ):
            found.setdefault((change.before.inputs, change.before.outputs), change)
    return list(found.values())


def _energy(bench, change, slew):
    ramp = bench.conditions.ramp(slew)
    after = ramp + bench.settling
    loads = dict.fromkeys(bench.machine.outputs, bench.conditions.least_load)
    wave, start = bench.run(
        change.before,
        {change.pin: [(0.0, ramp, change.after.inputs[change.pin])]},
        after,
        after / bench.conditions.settings.steps,
        loads,
    )
    return bench.volts * sum(bench.moved(wave, rail, start - REST / 4, start + after) for rail in bench.supplies)
