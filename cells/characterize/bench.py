"""A test bench for a cell: inputs driven, outputs loaded, one change at a time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import NamedTuple, Self, TypeVar

import numpy as np

from talbot.cells.characterize.conditions import Conditions
from talbot.cells.netlist.function import Cell
from talbot.cells.netlist.states import Change, State, Vector
from talbot.cells.spice.circuit import circuit
from talbot.cells.spice.engine import Points, SimulationError, Simulator
from talbot.cells.spice.settings import Settings
from talbot.cells.spice.wave import Wave

REST = 0.2e-9  # s before the edge that is measured, in which nothing moves
QUICK = 0.05e-9  # s of the ramps that bring a cell into its state
DOUBLINGS = 6  # of the time given to an output before it counts as stuck
Ramps = Mapping[int, Sequence[tuple[float, float, int]]]  # input number -> (start s, length s, level)
T = TypeVar("T")


def spread(items: Sequence[T], most: int) -> list[T]:
    """Return at most ``most`` of ``items``, evenly spread."""
    return [items[round(i)] for i in np.linspace(0, len(items) - 1, min(len(items), most))]


class Tail(NamedTuple):
    """The slowest settling of an output: s without load, and s a farad."""

    base: float = 0.3e-9
    rate: float = 2e4


@dataclass(frozen=True)
class Edge:
    """An edge at one slew and load.

    delay, slew: s. energy: J from the supply less what the load takes. charge: C into the input.
    """

    delay: float
    slew: float
    energy: float
    charge: float


class Bench:
    """A context manager around one Simulator for ``cell``.

    process: a module like platforms.sky130.models; leakage: with its models for leakage. pressed, middle: F at each
    output while constraints and input capacitances are measured.
    """

    def __init__(self, cell: Cell, process: ModuleType, conditions: Conditions, leakage: bool = False) -> None:
        self.cell, self.conditions = cell, conditions
        self.machine = machine = cell.machine
        self.volts = conditions.corner.supply
        levels = {n: level for n, level in process.SUPPLIES.items() if n in machine.netlist.ports}
        self.supplies = [n for n, level in levels.items() if level]
        deck, corner = (
            circuit(machine.netlist, process, conditions.models, conditions.corner, leakage),
            conditions.corner,
        )
        rails, settings = {n: v * self.volts for n, v in levels.items()}, conditions.settings
        self.simulator = Simulator(deck, machine.inputs, machine.outputs, rails, corner.temperature, settings)
        self.pressed: dict[str, float] = {}
        self.middle: dict[str, float] = {}
        self._tail: dict[str, Tail] = {}
        self._edges: dict[tuple[Change, str, float, float], Edge] = {}
        self._stubborn: set[State] = set()  # states that the operating point does not find

    def __enter__(self) -> Self:
        self.simulator.__enter__()
        return self

    def __exit__(self, *error: object) -> None:
        self.simulator.__exit__(*error)

    @property
    def settling(self) -> float:
        """Seconds that a cell without load gets to settle: 2 ns at nominal supply, more at a low one."""
        return 2e-9 * max(1.0, (1.8 / self.volts) ** 6)

    def patience(self, output: str, load: float) -> float:
        """Seconds that ``output`` gets to arrive with ``load`` F on it, from the edges so far."""
        tail = self._tail.get(output, Tail())
        return tail.base + tail.rate * load

    def run(
        self,
        state: State,
        edges: Ramps,
        after: float,
        step: float,
        loads: Mapping[str, float],
        pause: float | None = None,
        settings: Settings | None = None,
    ) -> tuple[Wave, float]:
        """Bring the cell into ``state``, then drive it by ``edges``; returns the wave and the time at which they start.

        after: s simulated from then on. step: longest time step. loads: F at the outputs. pause: s between two input
        vectors. settings: see `Simulator.transient`.

        A cell with storage starts from the levels of its nodes in ``state``; where the operating point is another, and
        where an output floats, input vectors are applied one after another. So they are to a clock gate: its output
        does not show what its latch holds, whose operating point may be between the levels.
        """
        hidden = self.cell.storage is not None and self.cell.storage.kind == "gate"
        pause = pause or self.settling + QUICK
        if "Z" not in state.outputs and state not in self._stubborn and not hidden:
            nodes = [(n, v * self.volts) for n, v in state.nodes] if self.machine.sequential else ()
            points, start = self._stimulus((state.inputs,), pause, edges)
            wave = self.simulator.transient(points, loads, start + after, step, nodes, settings)
            levels = zip(self.machine.outputs, state.outputs, strict=True)
            if all(abs(wave.at(q, start) - int(level) * self.volts) < 0.1 * self.volts for q, level in levels):
                return wave, start
            self._stubborn.add(state)
        points, start = self._stimulus(state.path, pause, edges)
        return self.simulator.transient(points, loads, start + after, step, (), settings), start

    def _stimulus(self, vectors: Sequence[Vector], pause: float, edges: Ramps) -> tuple[dict[str, Points], float]:
        """The sources, and the time at which ``edges`` start. vectors: applied one after another, every ``pause`` s."""
        points: dict[str, Points] = {}
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

    def edge(self, change: Change, output: str, slew: float, load: float) -> Edge:
        """Edge of ``output`` when ``change`` happens with the input slew ``slew`` s and ``load`` F on it.

        Measured once and kept. Raises SimulationError when the output does not arrive.
        """
        key = change, output, slew, load
        if key not in self._edges:
            self._edges[key] = self._edge(*key)
        return self._edges[key]

    def _edge(self, change: Change, output: str, slew: float, load: float) -> Edge:
        ramp = self.conditions.ramp(slew)
        up = bool(change.after.outputs[self.machine.outputs.index(output)])
        tail = self.patience(output, load)
        edges = {change.pin: [(0.0, ramp, change.after.inputs[change.pin])]}
        for _ in range(DOUBLINGS):
            after, loads = ramp + tail, {output: load}
            step = after / self.conditions.settings.steps
            wave, start = self.run(change.before, edges, after, step, loads, pause=2 * tail + QUICK)
            if edge := self._measure(wave, change, output, up, start, start + ramp + tail, load):
                base, rate = self._tail.get(output, Tail())
                heavy = load > 1e-15
                rate, base = (max(rate, 3 * edge.slew / load), base) if heavy else (rate, max(base, 2 * edge.slew))
                self._tail[output] = Tail(base, rate)
                return edge
            tail *= 2
        why = f"{self.cell.name}: {output} does not reach its level after {self.machine.inputs[change.pin]} changes"
        raise SimulationError(why, self.simulator.last)

    def _measure(
        self, wave: Wave, change: Change, output: str, up: bool, start: float, stop: float, load: float
    ) -> Edge | None:
        """The Edge, None when the output has not arrived within 2 % of the supply."""
        c, volts, pin = self.conditions, self.volts, self.machine.inputs[change.pin]
        if abs(wave.at(output, stop) - up * volts) > 0.02 * volts:
            return None
        first, last = (c.lower, c.upper) if up else (c.upper, c.lower)
        middle, begin, end = (wave.cross(output, level * volts, up, start) for level in (c.middle, first, last))
        here = wave.cross(pin, c.middle * volts, bool(change.after.inputs[change.pin]), start)
        if middle is None or begin is None or end is None or here is None:
            return None
        charge = sum(self.moved(wave, rail, start, stop) for rail in self.supplies)
        energy = charge * volts - load * volts**2 / 2
        return Edge(middle - here, end - begin, energy, self.moved(wave, pin, start, stop))

    def moved(self, wave: Wave, source: str, start: float, stop: float) -> float:
        """Charge (C) through ``source`` beyond the leakage before and after."""
        before, after = (float(wave.current[source][i]) for i in (0, -1))
        if abs(after) > 1e-9:  # not at rest yet, no leakage
            after = before
        return wave.charge(source, start, stop) - (before + after) / 2 * (stop - start)
