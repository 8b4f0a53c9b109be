"""Energy of an input's edge that moves no output."""

from talbot.cells.characterize.bench import REST, Bench, spread
from talbot.cells.netlist.states import Change

MOST = 8  # states that are tried


def quiet_energy(bench: Bench, pin: str) -> dict[str, list[float]] | None:
    """J from the supply for each slew when ``pin`` has an edge ('rise', 'fall') and every output stays.

    None where no state has such an edge. Of these states the one that takes least at the middle slew counts: what moves
    inside the cell in the others belongs to the edge that brings it to an output. SkyWater's figures are of that state,
    too.
    """
    energies = {}
    for level, name in ((1, "rise"), (0, "fall")):
        changes = bench.machine.toggles(pin, level, lambda change: change.before.kept == change.after.kept)
        if not changes:
            return None
        chosen = spread(changes, MOST)
        least = min(chosen, key=lambda change: _energy(bench, change, bench.conditions.middle_slew))
        energies[name] = [_energy(bench, least, slew) for slew in bench.conditions.slews]
    return energies


def _energy(bench: Bench, change: Change, slew: float) -> float:
    ramp = bench.conditions.ramp(slew)
    after = ramp + bench.settling
    loads = dict.fromkeys(bench.machine.outputs, bench.conditions.least_load)
    edges = {change.pin: [(0.0, ramp, change.after.inputs[change.pin])]}
    wave, start = bench.run(change.before, edges, after, after / bench.conditions.settings.steps, loads)
    return bench.volts * sum(bench.moved(wave, rail, start - REST / 4, start + after) for rail in bench.supplies)
