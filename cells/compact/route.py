"""Routing inside a cell: negotiated congestion (PathFinder) on cells.compact.grid.

Every net is routed as if it were alone, at a cost; where two nets meet the cost rises until one of them takes another
way.
"""

import heapq
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.grid import Arrays, Flags, Floats, Grid, Ints, Vertex
from talbot.models.compiled import njit

Edges = list[tuple[int, int, int]]  # net, vertex, vertex
Terminals = tuple[Ints, Ints, Ints]  # start of each net's sets, start of each set's members, and the members

ROUNDS = 80
NOISE = 0.2


@dataclass
class Task:
    """The nets to route in ``columns`` half-site columns of ``canvas``.

    terminals: sets of vertices by net; the net must meet one vertex of each set.
    ports: nets that need a pin.
    blocked: vertices that belong to a net from the start (stubs of the rails).
    """

    columns: int
    canvas: Canvas
    terminals: dict[str, list[set[Vertex]]]
    ports: tuple[str, ...]
    blocked: dict[str, set[Vertex]] = field(default_factory=dict)


@dataclass
class Wiring:
    """The routes: vertices of every net, edges between them, and the pin of a port ('pin', ...) or ('tap', ...)."""

    vertices: dict[str, set[Vertex]]
    edges: dict[str, list[tuple[Vertex, Vertex]]]
    pins: dict[str, Vertex]


def route(task: Task, met1: bool = True, seed: int = 0) -> Wiring | None:
    """Route ``task`` without a conflict; None where that fails. met1: whether the cell may use it.

    seed: of the noise on prices, up to NOISE; another seed tries other ways of equal length.
    """
    grid, arrays = _grid(task.columns, task.canvas, met1)
    price = arrays[0] * (1 + NOISE * np.random.default_rng(seed).random(len(arrays[0])))
    nets = sorted(task.terminals, key=lambda net: (len(task.terminals[net]), net))
    pins = {v for v in grid.vertices if v[0] in ("pin", "tap")}
    sets = [[*task.terminals[net], *([pins] if net in task.ports else [])] for net in nets]
    net_start = np.cumsum([0, *(len(s) for s in sets)])
    flat = [sorted(grid.number[v] for v in vertices) for s in sets for vertices in s]
    set_start = np.cumsum([0, *(len(vertices) for vertices in flat)])
    members = np.array([v for vertices in flat for v in vertices], dtype=np.int64)
    used = np.zeros((len(nets) + len(task.blocked), len(grid.vertices)), dtype=np.bool_)
    for k, stub in enumerate(task.blocked.values()):
        used[len(nets) + k, [grid.number[v] for v in stub]] = True
    ok, edges = _negotiate((price, *arrays[1:]), (net_start, set_start, members), used)
    return _wiring(grid, [*nets, *task.blocked], used, edges) if ok else None


@lru_cache(maxsize=32)
def _grid(columns: int, canvas: Canvas, met1: bool) -> tuple[Grid, Arrays]:
    grid = Grid(columns, canvas, met1)
    return grid, grid.arrays()


def _wiring(grid: Grid, names: Sequence[str], used: Flags, edges: Edges) -> Wiring:
    held = {net: {grid.vertices[i] for i in np.flatnonzero(used[k])} for k, net in enumerate(names)}
    pairs: dict[str, list[tuple[Vertex, Vertex]]] = {net: [] for net in names}
    for k, a, b in edges:
        pairs[names[k]].append((grid.vertices[a], grid.vertices[b]))
    pins = {net: v for net, vertices in held.items() for v in vertices if v[0] in ("pin", "tap")}
    for net, (kind, h, r, *_) in pins.items():
        if kind == "pin":
            pairs[net].append((("li", h, r), ("li", h, r + 1)))
    return Wiring(
        {net: {v for v in vertices if v[0] != "pin"} for net, vertices in held.items()},
        {net: [e for e in net_edges if "pin" not in (e[0][0], e[1][0])] for net, net_edges in pairs.items()},
        pins,
    )


@njit(cache=True)
def _negotiate(grid: Arrays, terminals: Terminals, used: Flags) -> tuple[bool, Edges]:
    """Fill ``used`` (net, vertex); returns whether no conflict is left, and edges as (net, vertex, vertex)."""
    excludes, vertices, count = grid[3], used.shape[1], len(terminals[0]) - 1
    past, held = np.zeros(vertices), np.zeros(vertices, np.int64)
    for net in range(count, used.shape[0]):
        held += used[net]
    edges = [(0, 0, 0)]
    for round_ in range(ROUNDS):
        present = min(0.6 * 1.3**round_, 1e6)
        edges = [(0, 0, 0)]
        for net in range(count):
            held -= used[net]
            used[net] = False
            tree, ok = _tree(grid, terminals, held, past, present, net, edges)
            if not ok:
                return False, edges
            used[net] = tree
            held += tree
        clashes = 0
        for v in range(vertices):
            if held[v] == 0:
                continue
            clash = False
            for net in range(used.shape[0]):
                if used[net, v]:
                    for x in excludes[1][excludes[0][v] : excludes[0][v + 1]]:
                        clash |= held[x] > used[net, x]
            if clash:
                clashes += 1
                past[v] += 1.0
        if clashes == 0:
            return True, edges[1:]
    return False, edges


@njit(cache=True)
def _tree(
    grid: Arrays, terminals: Terminals, held: Ints, past: Floats, present: float, net: int, edges: Edges
) -> tuple[Flags, bool]:
    """Find a tree that meets every terminal of ``net``: its vertices, and whether there is one; appends its edges."""
    price, leaf, nexts, excludes, needs, crowds = grid
    net_start, set_start, members = terminals
    size = len(price)
    cost = np.zeros(size)
    for v in range(size):
        for k in range(needs[0][v], needs[0][v + 1]):
            u = needs[1][k]
            others = 0
            for e in range(excludes[0][u], excludes[0][u + 1]):
                others += held[excludes[1][e]]
            cost[v] += (price[u] + past[u]) * (1.0 + present * others)
    tree = np.zeros(size, np.bool_)
    first, last = net_start[net], net_start[net + 1]
    met = np.zeros(last - first, np.bool_)
    if first == last:
        return tree, True
    start = members[set_start[first]]
    for k in range(set_start[first], set_start[first + 1]):
        if cost[members[k]] < cost[start]:
            start = members[k]
    tree[start] = True
    goal = np.zeros(size, np.bool_)
    best, came = np.empty(size), np.empty(size, np.int64)
    while True:
        goal[:] = False
        waiting = False
        for s in range(first, last):
            if not met[s - first]:
                for k in range(set_start[s], set_start[s + 1]):
                    met[s - first] |= tree[members[k]]
            if not met[s - first]:
                waiting = True
                for k in range(set_start[s], set_start[s + 1]):
                    goal[members[k]] = True
        if not waiting:
            return tree, True
        best[:] = 1e18
        came[:] = -1
        heap = [(0.0, 0)]
        heap.pop()
        for v in range(size):
            if tree[v] and not leaf[v]:
                best[v] = 0.0
                heapq.heappush(heap, (0.0, v))
        end = -1
        while len(heap):
            d, v = heapq.heappop(heap)
            if d > best[v]:
                continue
            if goal[v]:
                end = v
                break
            for k in range(nexts[0][v], nexts[0][v + 1]):
                u = nexts[1][k]
                if d + cost[u] >= best[u] or (leaf[u] and not goal[u]):
                    continue
                crowded = False
                for c in crowds[1][crowds[0][u] : crowds[0][u + 1]]:
                    crowded |= tree[c] and c != v
                if not crowded:
                    best[u], came[u] = d + cost[u], v
                    heapq.heappush(heap, (float(best[u]), int(u)))
        if end < 0:
            return tree, False
        while end >= 0:
            for k in range(needs[0][end], needs[0][end + 1]):
                tree[needs[1][k]] = True
            tree[end] = True
            if came[end] >= 0:
                edges.append((net, came[end], end))
            end = came[end]
