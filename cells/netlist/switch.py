"""Transistors as switches: which value every node takes, step after step of unit delay.

Ternary (0, 1, None for unknown), with charge kept on nodes that nothing drives, and with a fight decided for the side
whose path has the lower resistance by FIGHT (a keeper loses against a driver). [Bryant1984]
"""

import heapq
import math

FIGHT = 2.5  # ratio of resistances from which a path wins
SLOW_P = 2.5  # a p transistor's resistance to that of an n transistor of the same size
STEPS = 200  # of unit delay, after which what still changes is unknown


class Switches:
    """netlist: Netlist; polarity: model name -> 'n' or 'p'; rails: node -> 0 or 1."""

    def __init__(self, netlist, polarity, rails):
        root = _joined(netlist)
        self.rails = {root[n]: level for n, level in rails.items() if n in root}
        self.root = root
        self.inner = sorted(set(root.values()) - set(self.rails))
        self.edges = {}  # node -> [(neighbour, gate, level that switches on, resistance)]
        for t in netlist.transistors:
            on = 1 if polarity[t.model] == "n" else 0
            resistance = t.size["l"] / t.size["w"] * (1 if on else SLOW_P)
            a, b, gate = root[t.drain], root[t.source], root[t.gate]
            if a != b:
                self.edges.setdefault(a, []).append((b, gate, on, resistance))
                self.edges.setdefault(b, []).append((a, gate, on, resistance))

    def unknown(self):
        """The state in which no node is known: node -> None."""
        return dict.fromkeys(self.inner)

    def settle(self, state, inputs):
        """State after ``inputs`` (port -> 0 or 1) are applied to ``state``: node -> 0, 1 or None."""
        forced = {**self.rails, **{self.root[pin]: level for pin, level in inputs.items()}}
        state = {**state, **forced}
        for _ in range(STEPS):
            after = self._step(state, forced)
            if after == state:
                return state
            previous, state = state, after
        return {n: v if v == previous[n] else None for n, v in state.items()}

    def _step(self, state, forced):
        sure, maybe = (
            {level: self._distance(state, forced, level, doubt) for level in (0, 1)} for doubt in (False, True)
        )
        after = dict(forced)
        for node in self.inner:
            if node in forced:
                continue
            low, high = sure[0].get(node, math.inf), sure[1].get(node, math.inf)
            may_low, may_high = maybe[0].get(node, math.inf), maybe[1].get(node, math.inf)
            if math.isinf(may_low) and math.isinf(may_high):
                after[node] = state[node]
            elif low * FIGHT < may_high:
                after[node] = 0
            elif high * FIGHT < may_low:
                after[node] = 1
            else:
                after[node] = None
        return after

    def _distance(self, state, forced, level, doubt):
        """Resistance from every node to the nearest source of ``level``: dict. doubt: unknown gates conduct, too, and

        unknown sources count.
        """
        best = {n: 0.0 for n, v in forced.items() if v == level}
        queue = [(0.0, n) for n in best]
        while queue:
            so_far, node = heapq.heappop(queue)
            if so_far > best[node]:
                continue
            for neighbour, gate, on, resistance in self.edges.get(node, ()):
                if neighbour in forced or not (state[gate] == on or (doubt and state[gate] is None)):
                    continue
                total = so_far + resistance
                if total < best.get(neighbour, math.inf):
                    best[neighbour] = total
                    heapq.heappush(queue, (total, neighbour))
        return best


def floating(switches, state, node):
    """Whether ``node`` is driven by nothing in ``state`` (high impedance): no path to a rail conducts."""
    reached, queue = {switches.root[node]}, [switches.root[node]]
    while queue:
        for neighbour, gate, on, _ in switches.edges.get(queue.pop(), ()):
            if state[gate] in (on, None) and neighbour not in reached:
                if neighbour in switches.rails:
                    return False
                reached.add(neighbour)
                queue.append(neighbour)
    return True


def _joined(netlist):
    """node -> its representative: nodes that resistors join are one."""
    root = {n: n for n in netlist.nodes}

    def find(n):
        while root[n] != n:
            n = root[n]
        return n

    order = {n: i for i, n in enumerate(netlist.nodes)}
    for r in netlist.resistors:
        a, b = sorted((find(r.a), find(r.b)), key=order.get)  # ports come first and stay
        root[b] = a
    return {n: find(n) for n in root}
