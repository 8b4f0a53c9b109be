"""A cell on the bench: inputs driven, outputs loaded, one change at a time."""

from dataclasses import dataclass

from cells.spice.circuit import circuit
from cells.spice.engine import SimulationError, Simulator

REST = 0.2e-9  # s before the edge that is measured, in which nothing moves
QUICK = 0.05e-9  # s of the ramps that bring a cell into its state
DOUBLINGS = 6  # of the time given to an output before it counts as stuck


@dataclass(frozen=True)
class Edge:
    """Measured at one slew and load. delay, slew: s; energy: J from the supply less what the load takes;

    charge: C into the input; inputs held the same.
    """

    delay: float
    slew: float
    energy: float
    charge: float


class Bench:
    """A context manager around one Simulator for ``cell`` (Cell) of ``process`` under ``conditions``.

    leakage: with the process's models for leakage.
    """

    def __init__(self, cell, process, conditions, leakage=False):
        self.cell, self.conditions = cell, conditions
        self.machine = machine = cell.machine
        self.volts = conditions.corner.supply
        levels = {n: level for n, level in process.SUPPLIES.items() if n in machine.netlist.ports}
        self.supplies = [n for n, level in levels.items() if level]
        self.simulator = Simulator(
            circuit(machine.netlist, process, conditions.models, conditions.corner, leakage),
            machine.inputs,
            machine.outputs,
            {n: v * self.volts for n, v in levels.items()},
            conditions.corner.temperature,
            conditions.settings,
        )
        self.tail = {}  # output -> [s, s a farad]: the slowest seen
        self.pressed = {}  # output -> F under which constraints are measured
        self.middle = {}  # output -> F in the middle of its load axis
        self.edges = {}  # what `edge` has measured
        self.stubborn = set()  # states that the operating point does not find

    def __enter__(self):
        self.simulator.__enter__()
        return self

    def __exit__(self, *error):
        self.simulator.__exit__(*error)

    @property
    def settling(self):
        """Seconds that a cell without load gets to settle: 2 ns at nominal supply, more at a low one or when cold."""
        return 2e-9 * max(1.0, (1.8 / self.volts) ** 6)

    def patience(self, output, load):
        """Seconds that ``output`` gets to arrive with ``load`` F on it, from what was seen so far."""
        base, rate = self.tail.setdefault(output, [0.3e-9, 2e4])
        return base + rate * load

    def run(self, state, edges, after, step, loads, pause=None, **how):
        """(Wave, time from which ``edges`` count): the cell in ``state``, then driven by ``edges``.

        edges: input number -> [(start, length, level)], s and 0 or 1: ramps. after: s simulated from then on. step:
        longest time step. loads: output -> F. how: further arguments of `Simulator.transient`.

        A cell with storage starts from the levels of its nodes in ``state``, as the search for the operating point
        is told; where that ends elsewhere, and where an output floats, inputs are applied one after another.
        """
        floats = "Z" in state.outputs
        for by_path in (True,) if floats or state in self.stubborn else (False, True):
            vectors = state.path if by_path else (state.inputs,)
            nodes = [(n, v * self.volts) for n, v in state.nodes] if self.machine.sequential and not by_path else ()
            points, start = self._stimulus(vectors, pause or self.settling + QUICK, edges)
            wave = self.simulator.transient(points, loads, start + after, step, nodes, **how)
            if by_path or all(
                abs(wave.at(output, start) - level * self.volts) < 0.1 * self.volts
                for output, level in zip(self.machine.outputs, state.outputs, strict=True)
            ):
                return wave, start
            self.stubborn.add(state)
        raise AssertionError("not reached")

    def _stimulus(self, vectors, pause, edges):
        """(input -> points, time from which edges count). vectors: applied one after another, every ``pause`` s."""
        points = {}
        start = REST + pause * (len(vectors) - 1)
        for i, pin in enumerate(self.machine.inputs):
            line, level = [(0.0, vectors[0][i] * self.volts)], vectors[0][i]
            for k, vector in enumerate(vectors[1:]):
                if vector[i] != level:
                    when = REST + k * pause
                    line += [(when, level * self.volts), (when + QUICK, vector[i] * self.volts)]
                    level = vector[i]
            for delay, ramp, value in edges.get(i, ()):
                line += [(start + delay, level * self.volts), (start + delay + ramp, value * self.volts)]
                level = value
            points[pin] = line
        return points, start

    def edge(self, change, output, slew, load):
        """Edge of ``output`` (a name) when ``change`` happens with the input slew ``slew`` s and ``load`` F on it.

        Measured once, then known. Raises SimulationError when the output does not arrive.
        """
        key = change, output, slew, load
        if key not in self.edges:
            self.edges[key] = self._edge(*key)
        return self.edges[key]

    def _edge(self, change, output, slew, load):
        ramp = self.conditions.ramp(slew)
        pin, rising = self.machine.inputs[change.pin], bool(change.after.inputs[change.pin])
        k = self.machine.outputs.index(output)
        up = bool(change.after.outputs[k])
        tail = self.patience(output, load)
        for _ in range(DOUBLINGS):
            step = (ramp + tail) / self.conditions.settings.steps
            wave, start = self.run(
                change.before,
                {change.pin: [(0.0, ramp, int(rising))]},
                ramp + tail,
                step,
                {output: load},
                pause=2 * tail + QUICK,
            )
            found = self._measure(wave, pin, rising, output, up, start, start + ramp + tail, load)
            if found:
                known = self.tail[output]
                known[0] = max(known[0], 2 * found.slew if load <= 1e-15 else 0)
                known[1] = max(known[1], 3 * found.slew / load if load > 1e-15 else 0)
                return found
            tail *= 2
        raise SimulationError(
            f"{self.cell.name}: {output} does not reach its level after {pin} changes", self.simulator.last
        )

    def _measure(self, wave, pin, rising, output, up, start, stop, load):
        """Edge, or None when the output has not arrived within 2 % of the supply."""
        c, volts = self.conditions, self.volts
        if abs(wave.at(output, stop) - up * volts) > 0.02 * volts:
            return None
        first, last = (c.lower, c.upper) if up else (c.upper, c.lower)
        times = [wave.cross(output, level * volts, up, start) for level in (c.middle, first, last)]
        here = wave.cross(pin, c.middle * volts, rising, start)
        if None in times:
            return None
        charge = sum(self.moved(wave, rail, start, stop) for rail in self.supplies)
        return Edge(
            times[0] - here,
            times[2] - times[1],
            charge * volts - load * volts**2 / 2,
            self.moved(wave, pin, start, stop),
        )

    def moved(self, wave, source, start, stop):
        """Charge through ``source`` beyond what leaks before and after."""
        before, after = (float(wave.current[source][i]) for i in (0, -1))
        if abs(after) > 1e-9:  # not at rest yet, no leakage
            after = before
        return wave.charge(source, start, stop) - (before + after) / 2 * (stop - start)
