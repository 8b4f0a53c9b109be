"""Switch-level simulation: the level of every node, in steps of unit delay.

Ternary (0, 1, None for unknown). A node that nothing drives keeps its charge; a fight is decided for the side whose
path has the lower resistance by FIGHT (a keeper loses against a driver). [Bryant1984]
"""

import heapq
import math
from collections.abc import Mapping
from typing import NamedTuple

from talbot.cells.netlist.spice import Netlist

Levels = dict[str, int | None]  # node -> 0, 1, or None for unknown
FIGHT = 2.5  # ratio of resistances from which a path wins
SLOW_P = 2.5  # a p transistor's resistance to that of an n transistor of the same size
STEPS = 200  # of unit delay, after which what still changes is unknown


class Switch(NamedTuple):
    """A transistor seen from one end. on: the level of ``gate`` that switches it on; resistance: relative."""

    other_end: str
    gate: str
    on: int
    resistance: float


class Switches:
    """The transistors of a netlist as switches.

    polarity: 'n' or 'p' of each model. rails: supply nodes and their levels. root: each node's representative (nodes
    that resistors join are one); inner: representatives that are no rails; edges: the switches at each.
    """

    def __init__(self, netlist: Netlist, polarity: Mapping[str, str], rails: Mapping[str, int]) -> None:
        root = joined(netlist)
        self.rails = {root[n]: level for n, level in rails.items() if n in root}
        self.root = root
        self.inner = sorted(set(root.values()) - set(self.rails))
        self.edges: dict[str, list[Switch]] = {}
        for t in netlist.transistors:
            on = 1 if polarity[t.model] == "n" else 0
            resistance = t.size["l"] / t.size["w"] * (1 if on else SLOW_P)
            a, b, gate = root[t.drain], root[t.source], root[t.gate]
            if a != b:
                self.edges.setdefault(a, []).append(Switch(b, gate, on, resistance))
                self.edges.setdefault(b, []).append(Switch(a, gate, on, resistance))

    def unknown(self) -> Levels:
        """The state in which no node is known."""
        return dict.fromkeys(self.inner)

    def settle(self, state: Levels, inputs: Mapping[str, int]) -> Levels:
        """The state that follows when ``inputs`` (port -> 0 or 1) are applied to ``state``."""
        forced: Levels = {**self.rails, **{self.root[pin]: level for pin, level in inputs.items()}}
        previous: Levels = {}
        state = {**state, **forced}
        for _ in range(STEPS + 1):
            if state == previous:
                return state
            previous, state = state, self._step(state, forced)
        return {n: v if v == previous[n] else None for n, v in state.items()}

    def _step(self, state: Levels, forced: Levels) -> Levels:
        levels = [[self._distance(state, forced, level, doubt) for level in (0, 1)] for doubt in (False, True)]
        sure, maybe = levels
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

    def _distance(self, state: Levels, forced: Levels, level: int, doubt: bool) -> dict[str, float]:
        """Resistance from every node to the nearest source of ``level``; with ``doubt`` unknown gates conduct."""
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


def floating(switches: Switches, state: Levels, node: str) -> bool:
    """Return whether ``node`` has high impedance in ``state``: no path to a rail conducts."""
    reached, queue = {switches.root[node]}, [switches.root[node]]
    while queue:
        for neighbour, gate, on, _ in switches.edges.get(queue.pop(), ()):
            if state[gate] in (on, None) and neighbour not in reached:
                if neighbour in switches.rails:
                    return False
                reached.add(neighbour)
                queue.append(neighbour)
    return True


def joined(netlist: Netlist) -> dict[str, str]:
    """Each node's representative: nodes that resistors join are one."""
    root = {n: n for n in netlist.nodes}

    def find(n: str) -> str:
        while root[n] != n:
            n = root[n]
        return n

    order = {n: i for i, n in enumerate(netlist.nodes)}
    for r in netlist.resistors:
        a, b = sorted((find(r.a), find(r.b)), key=order.__getitem__)  # ports come first and stay
        root[b] = a
    return {n: find(n) for n in root}
