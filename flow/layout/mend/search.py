"""The cheapest way through a Window from one set of places to another: A*, compiled."""

import heapq

import numpy as np
from numba import njit

AGAINST = 3         # cost of a step against the direction of a layer's wires, in steps along it
CUT_NM = 2000       # cost of a cut, as that of so long a wire


def search(window, sources, targets, prices=None):
    """[(level, i, j), ...] from one of ``sources`` to one of ``targets`` (both sets of the same), or None.

    prices: dict level -> by how much its wires are dearer than others.
    """
    levels = sorted(window.wires)
    first, shape = levels[0], (len(levels), window.columns, window.rows)
    wires = np.stack([window.wires[level] for level in levels])
    cuts = np.stack([window.cuts[level] for level in levels[:-1]])
    steps = np.empty((len(levels), 2), np.int64)
    for level in levels:
        across, price = window.wiring.layers[level].across, (prices or {}).get(level, 1)
        x, y = (1, AGAINST) if across else (AGAINST, 1)
        steps[level - first] = window.dx * price * x, window.dy * price * y

    def numbers(places):
        level, i, j = np.array(sorted(places)).T
        return np.ravel_multi_index((level - first, i, j), shape)

    ends = np.zeros(wires.size, np.bool_)
    ends[numbers(targets)] = True
    _, i, j = np.array(sorted(targets)).T
    way = _search(wires.ravel(), cuts.ravel(), np.array(shape), numbers(sources), ends,
                  np.array((i.min(), i.max(), j.min(), j.max())), steps, np.array((window.dx, window.dy)))
    places = zip(*np.unravel_index(way[::-1], shape), strict=True) if len(way) else None
    return places and [(int(level) + first, int(i), int(j)) for level, i, j in places]


@njit(cache=True)
def _search(wires, cuts, shape, sources, ends, box, steps, pitch):
    """Numbers of the places of the way, from its end to its begin; none without one."""
    levels, columns, rows = shape
    layer = columns * rows
    cost = np.full(wires.size, 1 << 30, np.int32)
    came = np.full(wires.size, -1, np.int32)
    done = np.zeros(wires.size, np.bool_)
    heap = [(np.int64(0), np.int64(0))]
    heap.pop()
    for place in sources:
        cost[place] = 0
        heapq.heappush(heap, (_least(place % layer, rows, box, pitch), np.int64(place)))
    while heap:
        _, here = heapq.heappop(heap)
        if ends[here]:
            way = [here]
            while came[way[-1]] >= 0:
                way.append(np.int64(came[way[-1]]))
            return np.array(way)
        if done[here]:
            continue
        done[here] = True
        level, at = here // layer, here % layer
        for move in range(6):
            if move < 4:
                there = here + (rows, -rows, 1, -1)[move]
                free, price = wires[there], steps[level, move // 2]
            else:
                there, below = (here + layer, level) if move == 4 else (here - layer, level - 1)
                free, price = 0 <= below < levels - 1 and cuts[max(below, 0) * layer + at], CUT_NM
            if free and cost[here] + price < cost[there]:
                cost[there], came[there] = cost[here] + price, here
                heapq.heappush(heap, (cost[there] + _least(there % layer, rows, box, pitch), np.int64(there)))
    return np.empty(0, np.int64)


@njit(cache=True)
def _least(at, rows, box, pitch):
    """The least that is left from a place to the box around the targets."""
    i, j = at // rows, at % rows
    return np.int64(max(box[0] - i, i - box[1], 0) * pitch[0] + max(box[2] - j, j - box[3], 0) * pitch[1])
