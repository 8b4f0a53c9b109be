"""A tri-state output let go: how long it still drives, and its pin's capacitance then.

A capacitor as load does not show when an output is let go. Here a source holds the output at half the supply: the
output counts as let go when the source takes only LEFT of the current from the cell. So the time does not depend on the
load; its table has the same value for every one.
"""

from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Self

import numpy as np

from talbot.cells.characterize.bench import DOUBLINGS, REST, Bench
from talbot.cells.characterize.capacitance import END
from talbot.cells.characterize.measured import ArcTables, arc_tables
from talbot.cells.netlist.function import Arc
from talbot.cells.netlist.states import Change, Vector
from talbot.cells.spice.circuit import circuit
from talbot.cells.spice.engine import Points, SimulationError, Simulator
from talbot.cells.spice.wave import Wave

LEFT = 0.1  # of the current that the output drives at half the supply
HELD = 0.5  # of the supply, at which the output is held


class Held:
    """A context manager around the cell of ``bench`` with a source instead of a load at ``output``."""

    def __init__(self, bench: Bench, output: str, process: ModuleType) -> None:
        self.bench, self.output = bench, output
        c, machine = bench.conditions, bench.machine
        others = [o for o in machine.outputs if o != output]
        deck, inputs = circuit(machine.netlist, process, c.models, c.corner), (*machine.inputs, output)
        self.simulator = Simulator(deck, inputs, others, bench.simulator.rails, c.corner.temperature, c.settings)

    def __enter__(self) -> Self:
        self.simulator.__enter__()
        return self

    def __exit__(self, *error: object) -> None:
        self.simulator.__exit__(*error)

    def run(self, inputs: Vector, moves: Mapping[str, tuple[float, float, float]], after: float) -> Wave:
        """Wave of ``after`` s from REST on. inputs: levels; moves: ramp (s), V before and V after of pins."""
        pins, volts = zip(self.bench.machine.inputs, inputs, strict=True), self.bench.volts
        stimulus: dict[str, Points] = {pin: [(0.0, level * volts)] for pin, level in pins}
        for pin, (ramp, low, high) in moves.items():
            stimulus[pin] = [(0.0, low), (REST, low), (REST + ramp, high)]
        return self.simulator.transient(stimulus, {}, REST + after, after / self.bench.conditions.settings.steps)

    def let_go(self, change: Change, slew: float) -> float:
        """Seconds from the middle of the edge of ``change`` until the output's current is LEFT of what it was."""
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
        why = f"{bench.cell.name}: {self.output} drives on after {pin} has changed"
        raise SimulationError(why, self.simulator.last)

    def capacitance(self) -> tuple[float, float]:
        """F of the floating output for a rising and a falling ramp: the mean over the states in which it floats."""
        bench, c = self.bench, self.bench.conditions
        number, ramp = bench.machine.outputs.index(self.output), c.ramp(c.middle_slew)
        states = sorted({s.inputs for s in bench.machine.states if s.outputs[number] == "Z"})[: c.states]

        def one(inputs: Vector, low: float, high: float) -> float:
            wave = self.run(inputs, {self.output: (ramp, low, high)}, ramp)
            return abs(wave.charge(self.output, REST, REST + END * ramp)) / (END * bench.volts)

        farads = [[one(inputs, low, bench.volts - low) for inputs in states] for low in (0.0, bench.volts)]
        return float(np.mean(farads[0])), float(np.mean(farads[1]))


def disable(held: Held, arc: Arc, slews: Sequence[float], loads: Sequence[float]) -> ArcTables:
    """The tables of an arc that lets an output go, in the slowest of its states.

    No edge of the output ends it: its slew is 0 (OpenSTA warns where there is none).
    """
    few, middle = arc.changes[: held.bench.conditions.states], slews[len(slews) // 2]
    change = few[0] if len(few) == 1 else max(few, key=lambda change: held.let_go(change, middle))
    delays = [[held.let_go(change, slew)] * len(loads) for slew in slews]
    return arc_tables(arc, slews, loads, change.before, delays, [[0.0] * len(loads) for _ in slews])
