"""Every settled state of a cell, the inputs that lead to it, and what toggling an input does."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Literal

from talbot.cells.netlist.spice import Netlist
from talbot.cells.netlist.switch import Levels, Switches, floating, joined
from talbot.models.parameters import ParameterError

Vector = tuple[int, ...]  # levels of the inputs
Output = int | Literal["Z"]
LIMIT = 20000  # states, more than any cell of a library has


@dataclass(frozen=True)
class State:
    """A settled state.

    inputs, outputs: levels in the order of the machine's pins ('Z' for high impedance).
    kept: levels of the outputs' nodes, for one that floats its charge.
    nodes: (node, level) of every inner node with a known level.
    path: input vectors from an unknown state to this one, this state's last.
    """

    inputs: Vector
    outputs: tuple[Output, ...]
    kept: tuple[int | None, ...]
    nodes: tuple[tuple[str, int], ...]
    path: tuple[Vector, ...]


@dataclass(frozen=True)
class Change:
    """Input number ``pin`` toggles in ``before``, and the cell settles in ``after``."""

    before: State
    pin: int
    after: State


class Machine:
    """A cell as its settled states and the changes between them.

    inputs, outputs: signal ports. sequential: the inputs alone do not decide the outputs. Raises ParameterError when an
    output stays unknown.
    """

    def __init__(self, netlist: Netlist, polarity: Mapping[str, str], rails: Mapping[str, int]) -> None:
        self.netlist = netlist
        self.switches = Switches(netlist, polarity, rails)
        self.inputs, self.outputs = directions(netlist, rails)
        if not self.outputs:
            raise ParameterError(f"netlist = {netlist.name}: has no output, a port that it drives to both levels")
        self._explore()
        seen = {(state.inputs, state.outputs) for state in self.states}
        self.sequential = len(seen) > len({inputs for inputs, _ in seen})

    def _explore(self) -> None:
        """Find every state by its shortest path: breadth first from the unknown state."""
        n = len(self.inputs)
        vectors = list(product((0, 1), repeat=n))
        queue = [(self._settled(self.switches.unknown(), vector), vector, (vector,)) for vector in vectors]
        states: dict[tuple, State] = {}
        blind, raw_changes = set(), []
        while queue:
            later = []
            for nodes, vector, path in queue:
                key = (vector, tuple(nodes[node] for node in self.switches.inner))
                known = self._outputs(nodes)
                if key in states or key in blind:
                    continue
                if known is None:
                    blind.add(key)
                else:
                    kept = tuple(nodes[self.switches.root[pin]] for pin in self.outputs)
                    inner = ((n, nodes[n]) for n in self.switches.inner if n not in self.netlist.ports)
                    inside = tuple((node, level) for node, level in inner if level is not None)
                    states[key] = State(vector, known, kept, inside, path)
                for pin in range(n):
                    after = tuple(v ^ (i == pin) for i, v in enumerate(vector))
                    settled = self._settled(nodes, after)
                    later.append((settled, after, (*path, after)))
                    raw_changes.append((key, pin, (after, tuple(settled[x] for x in self.switches.inner))))
            queue = later
            if len(states) + len(blind) > LIMIT:
                raise ParameterError(f"netlist = {self.netlist.name}: has more than {LIMIT} states")
        self.states = list(states.values())
        self.changes = [Change(states[a], pin, states[b]) for a, pin, b in raw_changes if a in states and b in states]
        known = {s.inputs for s in self.states}
        for vector in vectors:
            if vector not in known:
                values = " ".join(f"{p}={v}" for p, v in zip(self.inputs, vector, strict=True))
                raise ParameterError(f"netlist = {self.netlist.name}: an output is never known at {values}")

    def toggles(self, pin: str, level: int, keep: Callable[[Change], bool] = lambda change: True) -> list[Change]:
        """Changes of input ``pin`` to ``level``, shortest path first, of those to ``keep``.

        One for each pair of inputs and outputs before it.
        """
        number, states = self.inputs.index(pin), {}
        for change in sorted(self.changes, key=lambda c: len(c.before.path)):
            if change.pin == number and change.after.inputs[number] == level and keep(change):
                states.setdefault((change.before.inputs, change.before.outputs), change)
        return list(states.values())

    def _settled(self, nodes: Levels, vector: Vector) -> Levels:
        return self.switches.settle(nodes, dict(zip(self.inputs, vector, strict=True)))

    def _outputs(self, nodes: Levels) -> tuple[Output, ...] | None:
        values: list[Output] = []
        for pin in self.outputs:
            if floating(self.switches, nodes, pin):
                values.append("Z")
            elif (value := nodes[self.switches.root[pin]]) is None:
                return None
            else:
                values.append(value)
        return tuple(values)


def directions(netlist: Netlist, rails: Mapping[str, int]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The inputs and the outputs of a netlist: an output is a port that the cell drives from both rails."""
    root = joined(netlist)
    signals = [port for port in netlist.ports if port not in rails]
    outputs = [port for port in signals if _complementary(netlist, root, port, rails)]
    return tuple(port for port in signals if port not in outputs), tuple(outputs)


def _complementary(netlist: Netlist, root: Mapping[str, str], port: str, rails: Mapping[str, int]) -> bool:
    """Return whether transistors join ``port`` to both rails without passing another port."""
    ends = {root[p] for p in netlist.ports} - {root[port]}
    reached, queue, levels = {root[port]}, [root[port]], set()
    levels_of = {root[n]: level for n, level in rails.items() if n in root}
    while queue:
        node = queue.pop()
        for t in netlist.transistors:
            pair = {root[t.drain], root[t.source]}
            if node in pair and len(pair) == 2:
                other = (pair - {node}).pop()
                if other in levels_of:
                    levels.add(levels_of[other])
                elif other not in reached and other not in ends:
                    reached.add(other)
                    queue.append(other)
    return levels == {0, 1}
