"""The states in which a constraint is measured, found from the cell's states."""

from collections.abc import Mapping
from dataclasses import dataclass

from talbot.cells.netlist.function import Cell
from talbot.cells.netlist.states import Output, State


@dataclass(frozen=True)
class Scenario:
    """Inputs ``data`` and ``clock`` (numbers) toggle in ``start``, in an order that the constraint sets.

    data_to, clock_to: their levels afterwards.
    expected: level of the first output at the end where the constraint is kept.
    moves: whether ``expected`` differs from the level in ``start``.
    early: the constraint is kept while data comes early enough, else late enough.
    trigger: number of the input from which the output's delay counts.
    """

    start: State
    data: int
    data_to: int
    clock: int
    clock_to: int
    expected: Output
    moves: bool
    early: bool
    trigger: int


class Scenarios:
    """The scenarios of a cell with storage."""

    def __init__(self, cell: Cell) -> None:
        if cell.storage is None:
            raise ValueError(f"cell = {cell.name}: must have storage")
        self.machine, self.storage = cell.machine, cell.storage
        self.clock = self.machine.inputs.index(self.storage.clock)
        self.after = {(c.before, c.pin): c.after for c in self.machine.changes}
        self.idle = {self.machine.inputs.index(pin): 1 - level for pin, level in self.storage.asynchronous}
        self.states = sorted(self.machine.states, key=lambda s: len(s.path))

    def _quiet(self, clock_level: int, but: int | None = None) -> list[State]:
        """States with the clock at a level, and set and reset idle (all but input number ``but``)."""
        levels = {self.clock: clock_level} | {p: level for p, level in self.idle.items() if p != but}
        return self._at(levels)

    def _at(self, levels: Mapping[int, int]) -> list[State]:
        """States with inputs, by number, at ``levels``."""
        return [s for s in self.states if all(s.inputs[p] == level for p, level in levels.items())]

    def setup(self, pin: str, to: int) -> list[Scenario]:
        """Scenarios of ``pin`` going ``to`` 0 or 1 before the clock's edge, one for each level that it can bring.

        A scan enable can bring either, data one.
        """
        return self._data(pin, to, early=True)

    def hold(self, pin: str, to: int) -> list[Scenario]:
        """Scenarios of ``pin`` going ``to`` 0 or 1 after the clock's edge: one for each level that must stay."""
        return self._data(pin, to, early=False)

    def _data(self, pin: str, to: int, early: bool) -> list[Scenario]:
        by_output: dict[Output, list[Scenario]] = {}
        for scenario in self._scenarios(self.machine.inputs.index(pin), to, early):
            by_output.setdefault(scenario.expected, []).append(scenario)
        return [next((f for f in same if f.moves), same[0]) for _, same in sorted(by_output.items())]

    def release(self, pin: str, early: bool) -> list[Scenario]:
        """The first scenario of set or reset ``pin`` let go before (recovery) or after (removal) the clock's edge."""
        data = self.machine.inputs.index(pin)
        return self._scenarios(data, self.idle[data], early)[:1]

    def _scenarios(self, data: int, to: int, early: bool) -> list[Scenario]:
        """Scenarios of input number ``data`` going ``to`` a level, of every state in which the order counts."""
        active, latch, asynchronous = self.storage.active, self.storage.kind == "latch", data in self.idle
        clock_to, scenarios = 1 - active if latch else active, []
        for s in self._quiet(1 - clock_to, but=data):
            moved = self.after.get((s, data))
            if s.inputs[data] == to or moved is None:
                continue
            kept, taken = self.after.get((s, self.clock)), self.after.get((moved, self.clock))
            if kept is None or taken is None:
                continue
            if asynchronous:
                kept = self.after.get((kept, data), kept)
            if kept.outputs[0] != taken.outputs[0]:
                expected = (taken if early else kept).outputs[0]
                moves, trigger = expected != s.outputs[0], data if latch else self.clock
                scenarios.append(Scenario(s, data, to, self.clock, clock_to, expected, moves, early, trigger))
        return scenarios

    def pulses(self, pin: str, level: int) -> list[tuple[State, Output]]:
        """States and expected outputs, one for each level that a pulse to ``level`` on ``pin`` can move the output to.

        pin: clock, set or reset.
        """
        number = self.machine.inputs.index(pin)
        states = self._quiet(1 - level) if number == self.clock else self._at(self.idle)
        by_output: dict[Output, State] = {}
        for s in states:
            first = self.after.get((s, number))
            last = first and self.after.get((first, number))
            if s.inputs[number] != level and last and last.outputs[0] != s.outputs[0]:
                by_output.setdefault(last.outputs[0], s)
        return [(state, expected) for expected, state in sorted(by_output.items())]
