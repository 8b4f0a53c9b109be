"""Functions, storage and timing arcs of a cell, found from its states."""

import re
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, NoReturn

from talbot.cells.netlist.boolean import expression
from talbot.cells.netlist.spice import Netlist
from talbot.cells.netlist.states import Change, Machine, Output, State
from talbot.models.parameters import ParameterError

EDGES = "fall", "rise"  # to level 0, to level 1
TypeOf = Callable[[str, str, Output, Output], str | None]  # (pin, its edge, output before, after) -> timing_type


class PinLevel(NamedTuple):
    """A pin and the level at which it is active."""

    pin: str
    level: int

    @property
    def active(self) -> str:
        """When it is active, in Liberty's notation: 'R' or '!R'."""
        return self.pin if self.level else f"!{self.pin}"


class Forcing(NamedTuple):
    """An input (its number) that at ``level`` forces the first output to ``value``."""

    pin: int
    level: int
    value: int


@dataclass(frozen=True)
class Storage:
    """The storage of a flip-flop, latch or clock gate.

    kind: 'ff', 'latch' or 'gate' (clock gating: a latch before an AND).
    clock: pin.
    active: level of the clock after the active edge (latch: while transparent).
    data: stored expression, of ``data_pins``.
    clear, preset: pin and active level.
    both: level of Q while clear and preset are active, None where they cannot be.
    """

    kind: str
    clock: str
    active: int
    data: str
    data_pins: tuple[str, ...]
    clear: PinLevel | None = None
    preset: PinLevel | None = None
    both: int | None = None

    @property
    def asynchronous(self) -> list[PinLevel]:
        """Clear and preset, those that it has."""
        return [pin for pin in (self.clear, self.preset) if pin]

    @property
    def clocked_on(self) -> str:
        """The clock's active edge or level in Liberty's notation: 'C' or '!C'."""
        return PinLevel(self.clock, self.active).active


@dataclass(frozen=True)
class Arc:
    """A timing arc: an edge of ``pin`` causes an edge of ``output``.

    edge: rise or fall of the output, from the other level or high impedance; for three_state_disable rise from low,
        fall from high.
    type: Liberty's timing_type.
    changes: every state change that causes it, shortest path first.
    """

    pin: str
    pin_edge: str
    output: str
    edge: str
    type: str
    changes: tuple[Change, ...]

    @property
    def sense(self) -> str:
        """Liberty's timing_sense of this edge alone; of tri-states it is that of the pin's edge."""
        if self.type in ("rising_edge", "falling_edge"):
            return "non_unate"
        if self.type.startswith("three_state"):
            return "positive_unate" if self.pin_edge == "rise" else "negative_unate"
        return "positive_unate" if self.pin_edge == self.edge else "negative_unate"


@dataclass(frozen=True)
class Cell:
    """A cell as Liberty describes it.

    functions: expression of every output; three_state: when it has high impedance, None where it never has.
    """

    machine: Machine
    functions: dict[str, str]
    three_state: dict[str, str | None]
    storage: Storage | None
    arcs: tuple[Arc, ...]

    @property
    def name(self) -> str:
        """The subcircuit's name."""
        return self.machine.netlist.name


def understand(netlist: Netlist, polarity: Mapping[str, str], rails: Mapping[str, int]) -> Cell:
    """The Cell of a netlist. Raises ParameterError when Liberty cannot describe it."""
    machine = Machine(netlist, polarity, rails)
    if not machine.sequential:
        functions, three_state = _combinational(machine)
        return Cell(machine, functions, three_state, None, tuple(_arcs(machine, _combinational_type)))
    storage = _storage(machine)
    functions = {q: _output_function(machine, storage, k) for k, q in enumerate(machine.outputs)}
    arcs = tuple(_arcs(machine, _sequential_type(storage)))
    return Cell(machine, functions, dict.fromkeys(machine.outputs), storage, arcs)


def _code(bits: Iterable[int | str]) -> int:
    return int("".join(map(str, bits)), 2) if bits else 0


def _combinational(machine: Machine) -> tuple[dict[str, str], dict[str, str | None]]:
    functions, three_state = {}, {}
    for k, output in enumerate(machine.outputs):
        ones = {_code(s.inputs) for s in machine.states if s.outputs[k] == 1}
        free = {_code(s.inputs) for s in machine.states if s.outputs[k] == "Z"}
        functions[output] = expression(machine.inputs, ones, free)
        three_state[output] = expression(machine.inputs, free) if free else None
    return functions, three_state


def _fail(machine: Machine, why: str) -> NoReturn:
    raise ParameterError(f"netlist = {machine.netlist.name}: {why}")


def _storage(machine: Machine) -> Storage:
    storage = _gating(machine)
    if storage:
        return storage
    forcings, states = [], machine.states
    while hit := _constant(machine, states, {forcing.pin for forcing in forcings}):
        forcings.append(hit)
        states = [s for s in states if s.inputs[hit.pin] != hit.level]
    idle = {forcing.pin: 1 - forcing.level for forcing in forcings}
    quiet = [c for c in machine.changes if all(s.inputs[p] == v for s in (c.before, c.after) for p, v in idle.items())]
    moving = [c for c in quiet if c.before.outputs[0] != c.after.outputs[0]]
    pins = {c.pin for c in moving}
    others = tuple(i for i in range(len(machine.inputs)) if i not in idle)
    named = {value: PinLevel(machine.inputs[pin], level) for pin, level, value in forcings}
    both = forcings[0].value if len(forcings) == 2 else None
    if len(forcings) > 2 or len(named) < len(forcings):
        _fail(machine, "has more than one set or reset pin")
    for clock in sorted(pins):
        edges = {c.after.inputs[clock] for c in moving if c.pin == clock}
        if len(edges) != 1:
            continue
        active = edges.pop()
        if all(c.pin == clock or c.after.inputs[clock] == active for c in moving):
            kind = "ff" if pins == {clock} else "latch"
            data = tuple(i for i in others if i != clock)
            if kind == "ff":
                samples = [(c.before, c.after) for c in quiet if c.pin == clock and c.after.inputs[clock] == active]
            else:
                samples = [(s, s) for s in states if s.inputs[clock] == active]
            text, used = _stored(machine, samples, data, with_state=kind == "ff")
            return Storage(kind, machine.inputs[clock], active, text, used, named.get(0), named.get(1), both)
    _fail(machine, "stores a value, but is neither flip-flop, latch nor clock gate")


def _gating(machine: Machine) -> Storage | None:
    """Storage of a clock gate: at one level of the clock the output rests, at the other only the clock moves it."""
    if len(machine.outputs) != 1:
        return None
    for clock in range(len(machine.inputs)):
        for active in (0, 1):
            idle_outputs = {s.outputs[0] for s in machine.states if s.inputs[clock] != active}
            others = [c for c in machine.changes if c.pin != clock and c.before.inputs[clock] == active]
            if idle_outputs == {1 - active} and all(c.before.outputs == c.after.outputs for c in others):
                data = tuple(i for i in range(len(machine.inputs)) if i != clock)
                edges = [c for c in machine.changes if c.pin == clock and c.after.inputs[clock] == active]
                samples = [(c.before, c.after) for c in edges]
                text, used = _stored(machine, samples, data, with_state=False)
                return Storage("gate", machine.inputs[clock], active, text, used)
    return None


def _constant(machine: Machine, states: Sequence[State], known: Container[int]) -> Forcing | None:
    """An input that forces the first output in ``states``, beyond the ``known`` ones."""
    for pin in range(len(machine.inputs)):
        for level in (0, 1):
            values = {s.outputs[0] for s in states if s.inputs[pin] == level}
            if pin not in known and len(values) == 1 and len({s.outputs[0] for s in states}) == 2:
                return Forcing(pin, level, int(values.pop()))
    return None


def _stored(
    machine: Machine, samples: Iterable[tuple[State, State]], data: Sequence[int], with_state: bool
) -> tuple[str, tuple[str, ...]]:
    """The value stored as an expression, and the pins in it, from pairs (state before, state after)."""
    names = [machine.inputs[i] for i in data] + ["IQ"] * with_state
    table: dict[tuple[Output, ...], set[Output]] = {}
    for before, after in samples:
        row = (*(before.inputs[i] for i in data), *before.outputs[: int(with_state)])
        table.setdefault(row, set()).add(after.outputs[0])
    if any(len(values) > 1 for values in table.values()):
        _fail(machine, "stores a value that its inputs before the clock edge do not decide")
    ones = {_code(row) for row, values in table.items() if values == {1}}
    free = set(range(1 << len(names))) - {_code(row) for row in table}
    text = expression(names, ones, free)
    words = set(re.findall(r"\w+", text))
    return text, tuple(name for name in names if name in words and name != "IQ")


def _output_function(machine: Machine, storage: Storage, k: int) -> str:
    """The function of output number ``k``: IQ, IQ_N, or of a clock gate the AND with its clock."""
    if storage.kind == "gate":
        return f"({storage.clock} & IQ)" if storage.active else f"(!{storage.clock} | !IQ)"
    if k == 0:
        return "IQ"
    pairs = {(s.outputs[0], s.outputs[k]) for s in machine.states if not _both_active(machine, storage, s)}
    if pairs == {(0, 1), (1, 0)}:
        return "IQ_N"
    if pairs == {(0, 0), (1, 1)}:
        return "IQ"
    _fail(machine, f"output {machine.outputs[k]} is neither the stored value nor its inverse")


def _both_active(machine: Machine, storage: Storage, state: State) -> bool:
    pins = storage.asynchronous
    return len(pins) == 2 and all(state.inputs[machine.inputs.index(pin)] == level for pin, level in pins)


def _combinational_type(pin: str, pin_edge: str, before: Output, after: Output) -> str:
    return "three_state_disable" if after == "Z" else "three_state_enable" if before == "Z" else "combinational"


def _sequential_type(storage: Storage) -> TypeOf:
    def kind(pin: str, pin_edge: str, before: Output, after: Output) -> str | None:
        if any(pin == hit.pin for hit in storage.asynchronous):
            return "preset" if after else "clear"  # Liberty's words for an output that rises, or falls
        if storage.kind == "gate":
            return "combinational" if pin == storage.clock else None
        if pin == storage.clock:
            return ("rising_edge" if storage.active else "falling_edge") if pin_edge == EDGES[storage.active] else None
        return "combinational" if storage.kind == "latch" else None

    return kind


def _arcs(machine: Machine, kind: TypeOf) -> list[Arc]:
    """Arcs by (pin, edge, output, edge), the changes of each with distinct inputs, shortest path first."""
    groups = {}
    for change in sorted(machine.changes, key=lambda c: len(c.before.path)):
        pin, pin_edge = machine.inputs[change.pin], EDGES[change.after.inputs[change.pin]]
        for k, output in enumerate(machine.outputs):
            before, after = change.before.outputs[k], change.after.outputs[k]
            if before == after:
                continue
            type_ = kind(pin, pin_edge, before, after)
            to = 1 - int(before) if after == "Z" else int(after)
            if type_ is None or change.before.kept[k] != 1 - to:
                continue
            same = groups.setdefault((pin, pin_edge, output, EDGES[to], type_), {})
            same.setdefault((change.before.inputs, change.before.outputs), change)
    return [
        Arc(pin, pin_edge, output, edge, type_, tuple(changes.values()))
        for (pin, pin_edge, output, edge, type_), changes in sorted(groups.items())
    ]
