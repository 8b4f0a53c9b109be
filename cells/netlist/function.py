"""What a cell is: its functions, its storage, and the arcs of its timing, all read off its states."""

from dataclasses import dataclass

from cells.netlist.boolean import expression
from cells.netlist.states import Machine
from models.parameters import ParameterError

LEVEL = {0: "fall", 1: "rise"}


@dataclass(frozen=True)
class Storage:
    """kind: ff, latch or gate (a latch before an AND: clock gating). clock: pin; active: its level after the active

    edge (latch: while transparent). data: expression stored; clear, preset: (pin, active level) or None;
    both: level of Q while both are active, None where it cannot be.
    """

    kind: str
    clock: str
    active: int
    data: str
    data_pins: tuple
    clear: tuple | None = None
    preset: tuple | None = None
    both: int | None = None


@dataclass(frozen=True)
class Arc:
    """``pin`` makes ``output`` go to ``edge`` (rise or fall), from the other level or high impedance; or lets it go,

    from low (rise) or high (fall). pin_edge: rise or fall. type: Liberty's timing_type. changes: every way in which it
    happens, shortest path first.
    """

    pin: str
    pin_edge: str
    output: str
    edge: str
    type: str
    changes: tuple

    @property
    def sense(self):
        """Liberty's timing_sense of this edge alone; of tri-states it tells which edge of the pin it is."""
        if self.type in ("rising_edge", "falling_edge"):
            return "non_unate"
        if self.type.startswith("three_state"):
            return "positive_unate" if self.pin_edge == "rise" else "negative_unate"
        return "positive_unate" if self.pin_edge == self.edge else "negative_unate"


@dataclass(frozen=True)
class Cell:
    """machine: Machine; functions: output -> expression; three_state: output -> expression or None; storage, arcs."""

    machine: Machine
    functions: dict
    three_state: dict
    storage: Storage | None
    arcs: tuple

    @property
    def name(self):
        return self.machine.netlist.name


def understand(netlist, polarity, rails):
    """Cell of a Netlist. Raises ParameterError when it is no cell that Liberty can describe."""
    machine = Machine(netlist, polarity, rails)
    if not machine.sequential:
        functions, three_state = _combinational(machine)
        return Cell(machine, functions, three_state, None, tuple(_arcs(machine, _combinational_type)))
    storage = _storage(machine)
    functions = {q: _output_function(machine, storage, k) for k, q in enumerate(machine.outputs)}
    return Cell(
        machine, functions, dict.fromkeys(machine.outputs), storage, tuple(_arcs(machine, _sequential_type(storage)))
    )


def _code(bits):
    return int("".join(map(str, bits)), 2) if bits else 0


def _combinational(machine):
    functions, three_state = {}, {}
    for k, output in enumerate(machine.outputs):
        ones = {_code(s.inputs) for s in machine.states if s.outputs[k] == 1}
        free = {_code(s.inputs) for s in machine.states if s.outputs[k] == "Z"}
        functions[output] = expression(machine.inputs, ones, free)
        three_state[output] = expression(machine.inputs, free) if free else None
    return functions, three_state


def _fail(machine, why):
    raise ParameterError(f"netlist = {machine.netlist.name}: {why}")


def _storage(machine):
    found = _gating(machine)
    if found:
        return found
    asyncs, states = [], machine.states
    while hit := _constant(machine, states, {pin for pin, _, _ in asyncs}):
        asyncs.append(hit)
        states = [s for s in states if s.inputs[hit[0]] != hit[1]]
    idle = {pin: 1 - level for pin, level, _ in asyncs}
    quiet = [c for c in machine.changes if all(s.inputs[p] == v for s in (c.before, c.after) for p, v in idle.items())]
    moving = [c for c in quiet if c.before.outputs[0] != c.after.outputs[0]]
    pins = {c.pin for c in moving}
    others = tuple(i for i in range(len(machine.inputs)) if i not in idle)
    named = {value: (machine.inputs[pin], level) for pin, level, value in asyncs}
    both = asyncs[0][2] if len(asyncs) == 2 else None
    if len(asyncs) > 2 or len(named) < len(asyncs):
        _fail(machine, "has more than one set or reset pin")
    common = dict(clear=named.get(0), preset=named.get(1), both=both)
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
            return Storage(kind, machine.inputs[clock], active, text, used, **common)
    return _fail(machine, "stores a value, but is neither flip-flop, latch nor clock gate")


def _gating(machine):
    """Storage of a clock gate: with the clock at one level the output rests, at the other only the clock moves it."""
    if len(machine.outputs) != 1:
        return None
    for clock in range(len(machine.inputs)):
        for active in (0, 1):
            rest = {s.outputs[0] for s in machine.states if s.inputs[clock] != active}
            free = [
                c
                for c in machine.changes
                if c.pin != clock and c.before.inputs[clock] == active and c.before.outputs != c.after.outputs
            ]
            if rest == {1 - active} and not free:
                data = tuple(i for i in range(len(machine.inputs)) if i != clock)
                samples = [
                    (c.before, c.after) for c in machine.changes if c.pin == clock and c.after.inputs[clock] == active
                ]
                text, used = _stored(machine, samples, data, with_state=False)
                return Storage("gate", machine.inputs[clock], active, text, used)
    return None


def _constant(machine, states, known):
    """(pin number, level, value) of an input that forces the first output, or None."""
    for pin in range(len(machine.inputs)):
        for level in (0, 1):
            values = {s.outputs[0] for s in states if s.inputs[pin] == level}
            if pin not in known and len(values) == 1 and len({s.outputs[0] for s in states}) == 2:
                return pin, level, values.pop()
    return None


def _stored(machine, samples, data, with_state):
    """(expression, pins it needs) of the value stored, from pairs (state before, state after)."""
    names = [machine.inputs[i] for i in data] + ["IQ"] * with_state
    table = {}
    for before, after in samples:
        row = tuple(before.inputs[i] for i in data) + ((before.outputs[0],) if with_state else ())
        table.setdefault(row, set()).add(after.outputs[0])
    if any(len(values) > 1 for values in table.values()):
        _fail(machine, "stores a value that its inputs before the clock edge do not decide")
    ones = {_code(row) for row, values in table.items() if values == {1}}
    free = set(range(1 << len(names))) - {_code(row) for row in table}
    text = expression(names, ones, free)
    words = set(text.replace("(", " ").replace(")", " ").replace("!", " ").split())
    return text, tuple(name for name in names if name in words and name != "IQ")


def _output_function(machine, storage, k):
    """IQ, IQ_N, or of a clock gate the AND with its clock."""
    if storage.kind == "gate":
        return f"({storage.clock} & IQ)" if storage.active else f"(!{storage.clock} | !IQ)"
    if k == 0:
        return "IQ"
    pairs = {(s.outputs[0], s.outputs[k]) for s in machine.states if not _both_active(machine, storage, s)}
    if pairs == {(0, 1), (1, 0)}:
        return "IQ_N"
    if pairs == {(0, 0), (1, 1)}:
        return "IQ"
    return _fail(machine, f"output {machine.outputs[k]} is neither the stored value nor its inverse")


def _both_active(machine, storage, state):
    pins = [p for p in (storage.clear, storage.preset) if p]
    return len(pins) == 2 and all(state.inputs[machine.inputs.index(pin)] == level for pin, level in pins)


def _combinational_type(pin, pin_edge, before, after):
    return "three_state_disable" if after == "Z" else "three_state_enable" if before == "Z" else "combinational"


def _sequential_type(storage):
    def kind(pin, pin_edge, before, after):
        if any(hit and pin == hit[0] for hit in (storage.clear, storage.preset)):
            return "preset" if after else "clear"  # Liberty's words for an output that rises, or falls
        if storage.kind == "gate":
            return "combinational" if pin == storage.clock else None
        if pin == storage.clock:
            return ("rising_edge" if storage.active else "falling_edge") if pin_edge == LEVEL[storage.active] else None
        return "combinational" if storage.kind == "latch" else None

    return kind


def _arcs(machine, kind):
    """Arcs by (pin, edge, output, edge), the changes of each with distinct inputs, shortest path first."""
    groups = {}
    for change in sorted(machine.changes, key=lambda c: len(c.before.path)):
        pin, pin_edge = machine.inputs[change.pin], LEVEL[change.after.inputs[change.pin]]
        for k, output in enumerate(machine.outputs):
            before, after = change.before.outputs[k], change.after.outputs[k]
            if before == after:
                continue
            type_ = kind(pin, pin_edge, before, after)
            to = 1 - before if after == "Z" else after
            if type_ is None or change.before.kept[k] != 1 - to:
                continue
            same = groups.setdefault((pin, pin_edge, output, LEVEL[to], type_), {})
            same.setdefault((change.before.inputs, change.before.outputs), change)
    return [Arc(*key, tuple(changes.values())) for key, changes in sorted(groups.items())]
