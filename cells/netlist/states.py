"""Every settled state that a cell can be in, how to get there, and what toggling an input does."""

from dataclasses import dataclass

from cells.netlist.switch import Switches, floating
from models.parameters import ParameterError

LIMIT = 20000  # states, more than any cell of a library has


@dataclass(frozen=True)
class State:
    """inputs, outputs: levels in the order of the machine's pins ('Z' for high impedance); kept: the outputs' charge;

    nodes: (node, level) of every node inside that is known.
    path: input vectors that lead here from an unknown state, this state's own last; one alone where the inputs say all.
    """

    inputs: tuple
    outputs: tuple
    kept: tuple
    nodes: tuple
    path: tuple


@dataclass(frozen=True)
class Change:
    """Input number ``pin`` toggles in ``before``, and the cell settles in ``after``."""

    before: State
    pin: int
    after: State


class Machine:
    """A cell as its settled states. inputs, outputs: signal ports; states, changes: lists.

    sequential: the outputs are not decided by the inputs alone. Raises ParameterError when an output stays unknown.
    """

    def __init__(self, netlist, polarity, rails):
        self.netlist = netlist
        self.switches = Switches(netlist, polarity, rails)
        self.inputs, self.outputs = directions(netlist, rails)
        if not self.outputs:
            raise ParameterError(f"netlist = {netlist.name}: has no output, a port that it drives to both levels")
        self._explore()
        seen = {}
        for state in self.states:
            seen.setdefault(state.inputs, set()).add(state.outputs)
        self.sequential = any(len(found) > 1 for found in seen.values())

    def _explore(self):
        """Breadth first from the unknown state: the shortest path to every state is found."""
        n = len(self.inputs)
        queue, found, blind = [], {}, set()
        for code in range(1 << n):
            vector = tuple(code >> (n - 1 - i) & 1 for i in range(n))
            queue.append(
                (
                    self.switches.settle(self.switches.unknown(), dict(zip(self.inputs, vector, strict=True))),
                    vector,
                    (vector,),
                )
            )
        raw_changes = []
        while queue:
            later = []
            for nodes, vector, path in queue:
                key = (vector, tuple(nodes[node] for node in self.switches.inner))
                known = self._outputs(nodes)
                if key in found or key in blind:
                    continue
                if known is None:
                    blind.add(key)
                else:
                    kept = tuple(nodes[self.switches.root[pin]] for pin in self.outputs)
                    inside = tuple(
                        (node, nodes[node])
                        for node in self.switches.inner
                        if node not in self.netlist.ports and nodes[node] is not None
                    )
                    found[key] = State(vector, known, kept, inside, path)
                for pin in range(n):
                    after = tuple(v ^ (i == pin) for i, v in enumerate(vector))
                    settled = self.switches.settle(nodes, dict(zip(self.inputs, after, strict=True)))
                    later.append((settled, after, (*path, after)))
                    raw_changes.append((key, pin, (after, tuple(settled[x] for x in self.switches.inner))))
            queue = later
            if len(found) + len(blind) > LIMIT:
                raise ParameterError(f"netlist = {self.netlist.name}: has more than {LIMIT} states")
        self.states = list(found.values())
        self.changes = [Change(found[a], pin, found[b]) for a, pin, b in raw_changes if a in found and b in found]
        vectors = {s.inputs for s in self.states}
        if len(vectors) < 1 << n:
            missing = next(
                v for c in range(1 << n) if (v := tuple(c >> (n - 1 - i) & 1 for i in range(n))) not in vectors
            )
            values = " ".join(f"{p}={v}" for p, v in zip(self.inputs, missing, strict=True))
            raise ParameterError(f"netlist = {self.netlist.name}: an output is never known at {values}")

    def _outputs(self, nodes):
        values = []
        for pin in self.outputs:
            if floating(self.switches, nodes, pin):
                values.append("Z")
            elif (value := nodes[self.switches.root[pin]]) is None:
                return None
            else:
                values.append(value)
        return tuple(values)


def directions(netlist, rails):
    """(inputs, outputs) of a netlist: ports that drive gates only, and ports on a drain or source of which one at

    least is driven from a rail by the cell itself.
    """
    drains = {n for t in netlist.transistors for n in (t.drain, t.source)}
    gates = {t.gate for t in netlist.transistors}
    signals = [p for p in netlist.ports if p not in rails]
    joined = Switches(netlist, {t.model: "n" for t in netlist.transistors}, rails).root
    drains, gates = {joined[n] for n in drains}, {joined[n] for n in gates}
    inputs, outputs = [], []
    for port in signals:
        on_drain = joined[port] in drains
        is_output = on_drain and _complementary(netlist, joined, port, rails)
        (outputs if is_output else inputs).append(port)
    return tuple(inputs), tuple(outputs)


def _complementary(netlist, root, port, rails):
    """Whether ``port`` is reached from both rails through transistors, without passing another port."""
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
