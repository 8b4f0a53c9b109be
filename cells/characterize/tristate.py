"""A tri-state output let go: how long it still drives, and what its pin then weighs.

A capacitor as load does not show when an output is let go. Here a source holds the output at half the supply and the
current that it takes from the cell is watched: the output counts as let go when LEFT of that current is left. So the
time does not depend on the load; its table has the same value for every one.
"""

import numpy as np

from cells.characterize.bench import DOUBLINGS, REST
from cells.spice.circuit import circuit
from cells.spice.engine import SimulationError, Simulator

LEFT = 0.1  # of the current that the output drives at half the supply
HELD = 0.5  # of the supply, at which the output is held
END = 0.9  # of a ramp at the output, over which charge counts as for inputs


class Held:
    """A context manager: the cell of ``bench`` with a source at ``output`` (a name) in place of a load."""

    def __init__(self, bench, output, process):
        self.bench, self.output = bench, output
        c, machine = bench.conditions, bench.machine
        others = [o for o in machine.outputs if o != output]
        self.simulator = Simulator(
            circuit(machine.netlist, process, c.models, c.corner),
            (*machine.inputs, output),
            others,
            bench.simulator.rails,
            c.corner.temperature,
            c.settings,
        )

    def __enter__(self):
        self.simulator.__enter__()
        return self

    def __exit__(self, *error):
        self.simulator.__exit__(*error)

    def run(self, inputs, moves, after):
        """Wave of ``after`` s from REST on. inputs: levels; moves: pin -> (ramp in s, V from, V to), the output too."""
        volts = self.bench.volts
        stimulus = {pin: [(0.0, level * volts)] for pin, level in zip(self.bench.machine.inputs, inputs, strict=True)}
        for pin, (ramp, low, high) in moves.items():
            stimulus[pin] = [(0.0, low), (REST, low), (REST + ramp, high)]
        return self.simulator.transient(stimulus, {}, REST + after, after / self.bench.conditions.settings.steps)

    def let_go(self, change, slew):
        """Seconds from the middle of the edge of ``change`` until LEFT of the output's current is left."""
        bench, c = self.bench, self.bench.conditions
        ramp, level, pin = c.ramp(slew), HELD * bench.volts, bench.machine.inputs[change.pin]
        first, last = (state.inputs[change.pin] * bench.volts for state in (change.before, change.after))
        after = ramp + bench.settling
        for _ in range(DOUBLINGS):
            wave = self.run(change.before.inputs, {self.output: (ramp, level, level), pin: (ramp, first, last)}, after)
            share = wave.current[self.output] / float(np.interp(REST, wave.time, wave.current[self.output]))
            if abs(share[-1]) < LEFT / 2:
                k = int(np.nonzero(np.abs(share) >= LEFT)[0][-1])
                here, there = abs(share[k]), abs(share[k + 1])
                when = wave.time[k] + (wave.time[k + 1] - wave.time[k]) * (here - LEFT) / (here - there)
                return float(when - REST - c.middle * ramp)
            after *= 2
        raise SimulationError(
            f"{bench.cell.name}: {self.output} drives on after {pin} has changed", self.simulator.last
        )

    def capacitance(self):
        """(rise, fall) in F of the output while nothing drives it: the mean over the states in which that is so."""
        bench, c = self.bench, self.bench.conditions
        number, ramp = bench.machine.outputs.index(self.output), c.ramp(c.slews[len(c.slews) // 2])
        states = sorted({s.inputs for s in bench.machine.states if s.outputs[number] == "Z"})[: c.states]

        def one(inputs, low, high):
            wave = self.run(inputs, {self.output: (ramp, low, high)}, ramp)
            return abs(wave.charge(self.output, REST, REST + END * ramp)) / (END * bench.volts)

        return tuple(
            float(np.mean([one(inputs, *ends) for inputs in states]))
            for ends in ((0.0, bench.volts), (bench.volts, 0.0))
        )


def disable(held, arc, slews, loads):
    """Tables of an arc that lets an output go, as `cell._arc` gives others': of the slowest of its states; it ends in

    no edge of the output, so that the slew is 0 (OpenSTA warns where there is none).
    """
    middle = slews[len(slews) // 2]
    few = arc.changes[: held.bench.conditions.states]
    change = few[0] if len(few) == 1 else max(few, key=lambda change: held.let_go(change, middle))
    return {
        "slews": slews,
        "loads": loads,
        "state": list(change.before.inputs),
        "delay": [[held.let_go(change, slew)] * len(loads) for slew in slews],
        "slew": np.zeros((len(slews), len(loads))).tolist(),
    }
