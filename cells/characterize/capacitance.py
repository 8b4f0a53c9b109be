"""Input capacitance, as static timing uses it: the charge over most of a ramp, over that part of the swing.

The whole charge of an edge counts what the cell's own outputs push back after the input has arrived. Up to 90 % of a
middle ramp, with the middle of the load axis on every output, the figures of SkyWater's four cells come out within 4 %;
up to 50 % or 100 %, with other slews or loads, within 6 % to 20 %.
"""

import numpy as np

from talbot.cells.characterize.bench import Bench, spread
from talbot.cells.netlist.states import Change

END = 0.9  # of the ramp, up to which charge counts


def capacitance(bench: Bench, pin: str) -> tuple[float, float]:
    """F of the input ``pin`` for a rising and a falling edge at the middle slew: the mean over states.

    At most Conditions.states of the states in which an output follows, of all states where there is none.
    """
    rise, fall = (float(np.mean([_one(bench, change) for change in _changes(bench, pin, level)])) for level in (1, 0))
    return rise, fall


def _changes(bench: Bench, pin: str, level: int) -> list[Change]:
    changes = bench.machine.toggles(pin, level)
    changes = [c for c in changes if c.before.outputs != c.after.outputs] or changes
    return spread(changes, bench.conditions.states)


def _one(bench: Bench, change: Change) -> float:
    ramp = bench.conditions.ramp(bench.conditions.middle_slew)
    edges = {change.pin: [(0.0, ramp, change.after.inputs[change.pin])]}
    wave, start = bench.run(change.before, edges, ramp, ramp / 50, bench.middle)
    return abs(wave.charge(bench.machine.inputs[change.pin], start, start + END * ramp)) / (END * bench.volts)
