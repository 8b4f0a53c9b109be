"""The cheapest way through a Window from one set of places to another: A*, compiled."""

import heapq

import numpy as np
from numba import njit

AGAINST = 3  # cost of a step against the direction of a layer's wires, in steps along it
CUT_NM = 2000  # cost of a cut, as that of so long a wire


def search(window, sources, targets, prices=None):
    """[(level, i, j), ...] from one of ``sources`` to one of ``targets`` (iterables of the same), or None.

    prices: dict level -> by how much its wires are dearer than others.
    """
    levels = sorted(window.wires)
    first, shape = levels[0], (len(levels), *window.shape)
    wires = np.stack([window.wires[level] for level in levels])
    cuts = np.stack([window.cuts[level] for level in levels[:-1]])
    steps = np.empty((len(levels), 2), np.int64)
    for level in levels:
        across, price = window.wiring.layers[level].across, (prices or {}).get(level, 1)
        x, y = (1, AGAINST) if across else (AGAINST, 1)
        steps[level - first] = window.dx * price * x, window.dy * price * y
    corner = np.array((first, *window.first))
    begins, ends = (
        np.array(sorted(filter(window.inside, places))) - corner if places else np.empty((0, 3), int)
        for places in (sources, targets)
    )
    if not len(begins) or not len(ends):
        return None
    wanted = np.zeros(wires.size, np.bool_)
    wanted[np.ravel_multi_index(ends.T, shape)] = True
    box = np.array((ends[:, 1].min(), ends[:, 1].max(), ends[:, 2].min(), ends[:, 2].max()))
    way = _search(
        wires.ravel(),
        cuts.ravel(),
        np.array(shape),
        np.ravel_multi_index(begins.T, shape),
        wanted,
        box,
        steps,
        np.array((window.dx, window.dy)),
    )
    return [tuple(map(int, place)) for place in np.transpose(np.unravel_index(way[::-1], shape)) + corner] or None


@njit(cache=True)
def _search(wires, cuts, shape, sources, ends, box, steps, pitch):
    """Numbers of the places of the way, from its end to its begin; none without one."""
    levels, columns, rows = shape
    layer = columns * rows
    cost = np.full(wires.size, 1 << 60, np.int64)
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
                price = steps[level, move // 2]
            else:
                there, below = (here + layer, level) if move == 4 else (here - layer, level - 1)
                if not 0 <= below < levels - 1 or cuts[below * layer + at] < 0:
                    continue
                price = CUT_NM + cuts[below * layer + at]
            if wires[there] < 0:
                continue
            price += wires[there]
            if cost[here] + price < cost[there]:
                cost[there], came[there] = cost[here] + price, here
                heapq.heappush(heap, (cost[there] + _least(there % layer, rows, box, pitch), np.int64(there)))
    return np.empty(0, np.int64)


@njit(cache=True)
def _least(at, rows, box, pitch):
    """The least that is left from a place to the box around the targets."""
    i, j = at // rows, at % rows
    return np.int64(max(box[0] - i, i - box[1], 0) * pitch[0] + max(box[2] - j, j - box[3], 0) * pitch[1])
