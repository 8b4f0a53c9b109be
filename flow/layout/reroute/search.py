"""The cheapest path through a Window from one set of places to another: A*, compiled."""

import heapq
from collections.abc import Collection, Mapping

import numpy as np
import numpy.typing as npt
from numba import njit

from .route import Place
from .window import Costs, Window

WRONG_WAY = 3  # cost of a step against the preferred direction of a layer, in steps along it
VIA_NM = 2000  # cost of a via, as that of so long a segment
Ints = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


def search(
    window: Window, sources: Collection[Place], targets: Collection[Place], factors: Mapping[int, int] | None = None
) -> list[Place] | None:
    """Return the places of the path from one of ``sources`` to one of ``targets``, or None.

    factors: by level, of the cost of a step.
    """
    levels = sorted(window.metals)
    first, shape = levels[0], (len(levels), *window.shape)
    metals = np.stack([window.metals[level] for level in levels])
    vias = np.stack([window.vias[level] for level in levels[:-1]])
    steps = np.empty((len(levels), 2), np.int64)
    for level in levels:
        factor = (factors or {}).get(level, 1)
        x, y = (1, WRONG_WAY) if window.rules.layers[level].horizontal else (WRONG_WAY, 1)
        steps[level - first] = window.dx * factor * x, window.dy * factor * y
    corner = np.array((first, *window.first))
    begins, ends = (
        np.array(sorted(filter(window.inside, places))) - corner if places else np.empty((0, 3), int)
        for places in (sources, targets)
    )
    if not len(begins) or not len(ends):
        return None
    wanted = np.zeros(metals.size, np.bool_)
    wanted[np.ravel_multi_index(tuple(ends.T), shape)] = True
    box = np.array((ends[:, 1].min(), ends[:, 1].max(), ends[:, 2].min(), ends[:, 2].max()))
    starts, pitch = np.ravel_multi_index(tuple(begins.T), shape), np.array((window.dx, window.dy))
    path = _search(metals.ravel(), vias.ravel(), np.array(shape), starts, wanted, box, steps, pitch)
    places = np.transpose(np.unravel_index(path[::-1], shape)) + corner
    return [(int(level), int(i), int(j)) for level, i, j in places] or None


@njit(cache=True)
def _search(
    metals: Costs, vias: Costs, shape: Ints, sources: Ints, ends: Flags, box: Ints, steps: Ints, pitch: Ints
) -> Ints:
    """Numbers of the places of the path, from its end to its begin; none without one."""
    levels, columns, rows = shape
    layer = columns * rows
    cost = np.full(metals.size, 1 << 60, np.int64)
    came = np.full(metals.size, -1, np.int32)
    done = np.zeros(metals.size, np.bool_)
    heap = [(np.int64(0), np.int64(0))]
    heap.pop()
    for place in sources:
        cost[place] = 0
        heapq.heappush(heap, (_least(place % layer, rows, box, pitch), np.int64(place)))
    while heap:
        _, here = heapq.heappop(heap)
        if ends[here]:
            path = [here]
            while came[path[-1]] >= 0:
                path.append(np.int64(came[path[-1]]))
            return np.array(path)
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
                if not 0 <= below < levels - 1 or vias[below * layer + at] < 0:
                    continue
                price = VIA_NM + vias[below * layer + at]
            if metals[there] < 0:
                continue
            price += metals[there]
            if cost[here] + price < cost[there]:
                cost[there], came[there] = cost[here] + price, here
                heapq.heappush(heap, (cost[there] + _least(there % layer, rows, box, pitch), np.int64(there)))
    return np.empty(0, np.int64)


@njit(cache=True)
def _least(at: int, rows: int, box: Ints, pitch: Ints) -> np.int64:
    """Lower bound of the cost from a place to the box around the targets."""
    i, j = at // rows, at % rows
    return np.int64(max(box[0] - i, i - box[1], 0) * pitch[0] + max(box[2] - j, j - box[3], 0) * pitch[1])
