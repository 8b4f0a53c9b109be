"""In which states a constraint is measured: found from the cell's states, not typed."""

from dataclasses import dataclass

from cells.netlist.states import State


@dataclass(frozen=True)
class Scenario:
    """``data`` and ``clock`` (input numbers) toggle in ``start``, in an order that the constraint says.

    data_to, clock_to: their levels afterwards. expected: level of the first output at the end, if the constraint is
    kept; moves: whether it differs from ``start``'s. early: kept while data comes early enough (else late enough).
    trigger: input number from which the output's delay counts.
    """

    start: State
    data: int
    data_to: int
    clock: int
    clock_to: int
    expected: int
    moves: bool
    early: bool
    trigger: int


class Scenarios:
    """Of ``cell`` (Cell with storage)."""

    def __init__(self, cell):
        self.machine, self.storage = cell.machine, cell.storage
        self.clock = self.machine.inputs.index(self.storage.clock)
        self.after = {(c.before, c.pin): c.after for c in self.machine.changes}
        self.idle = {
            self.machine.inputs.index(p): 1 - level
            for p, level in filter(None, (self.storage.clear, self.storage.preset))
        }
        self.states = sorted(self.machine.states, key=lambda s: len(s.path))

    def _quiet(self, clock_level, but=None):
        """States with the clock at a level and set and reset idle (all but input number ``but``)."""
        return [
            s
            for s in self.states
            if s.inputs[self.clock] == clock_level
            and all(s.inputs[p] == level for p, level in self.idle.items() if p != but)
        ]

    def setup(self, pin, to):
        """Scenarios of ``pin`` (name) going ``to`` 0 or 1 before the clock's edge: one for each level that it can bring

        (a scan enable either, data one).
        """
        return self._data(pin, to, early=True)

    def hold(self, pin, to):
        """Scenarios of ``pin`` going ``to`` 0 or 1 after the clock's edge: one for each level that must stay."""
        return self._data(pin, to, early=False)

    def _data(self, pin, to, early):
        data, active = self.machine.inputs.index(pin), self.storage.active
        latch = self.storage.kind == "latch"
        clock_to = 1 - active if latch else active
        found = {}
        for s in self._quiet(1 - clock_to):
            moved = self.after.get((s, data))
            if s.inputs[data] == to or moved is None:
                continue
            kept, taken = self.after.get((s, self.clock)), self.after.get((moved, self.clock))
            if kept is None or taken is None or kept.outputs[0] == taken.outputs[0]:
                continue
            expected = (taken if early else kept).outputs[0]
            trigger = data if latch else self.clock
            found.setdefault(expected, []).append(
                Scenario(s, data, to, self.clock, clock_to, expected, expected != s.outputs[0], early, trigger)
            )
        return [next((f for f in same if f.moves), same[0]) for _, same in sorted(found.items())]

    def release(self, pin, early):
        """Scenario of an asynchronous ``pin`` let go before (recovery) or after (removal) the clock's edge: a list of

        one, or none.
        """
        data, active = self.machine.inputs.index(pin), self.storage.active
        latch = self.storage.kind == "latch"
        clock_to = 1 - active if latch else active
        for s in self._quiet(1 - clock_to, but=data):
            moved = self.after.get((s, data))
            if s.inputs[data] == self.idle[data] or moved is None:
                continue
            kept, taken = self.after.get((s, self.clock)), self.after.get((moved, self.clock))
            if kept is None or taken is None:
                continue
            kept = self.after.get((kept, data), kept)
            if kept.outputs[0] == taken.outputs[0]:
                continue
            expected = (taken if early else kept).outputs[0]
            return [
                Scenario(
                    s,
                    data,
                    self.idle[data],
                    self.clock,
                    clock_to,
                    expected,
                    expected != s.outputs[0],
                    early,
                    data if latch else self.clock,
                )
            ]
        return []

    def pulses(self, pin, level):
        """[(state, expected output)], one for each level that a pulse to ``level`` on ``pin`` (clock, set or reset) can

        move the output to.
        """
        number = self.machine.inputs.index(pin)
        states = (
            self._quiet(1 - level)
            if number == self.clock
            else [s for s in self.states if all(s.inputs[p] == v for p, v in self.idle.items())]
        )
        found = {}
        for s in states:
            first = self.after.get((s, number))
            last = first and self.after.get((first, number))
            if s.inputs[number] == level or last is None:
                continue
            if last.outputs[0] != s.outputs[0]:
                found.setdefault(last.outputs[0], s)
        return [(state, expected) for expected, state in sorted(found.items())]
