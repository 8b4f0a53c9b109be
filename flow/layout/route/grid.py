"""Places for the middles of segments and vias: what blocks them, which nets have them, the cheapest path over them."""

import heapq
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit

from ..geometry.boxes import Box
from .route import Place, Point
from .rules import RoutingRules

WRONG_WAY = 3  # cost of a step against the preferred direction of a layer, in steps along it
LAYER_COSTS = 3.0, 1.5  # of a step on the lowest layers, where pins are met, in steps on another
VIA_NM = 2000  # cost of a via, as that of so long a segment
CONFLICT_NM = 500  # cost of a place where nets contended once, as that of so long a segment
HASTE = 5  # quarters of the remaining cost: paths of up to a quarter more are taken for a search so much shorter
EXACT = 4
FREE, BLOCKED = 0, -1  # of `Grid.fixed`; else the number of the only net that may pass, and 1
PAID = 1 << 27  # marks a place in the queue as the end of a path
METAL, BELOW, ABOVE = range(3)  # what is at a place of a layer: a segment, the pad of a via upwards, of one from below
Owners = npt.NDArray[np.int32]
Counts = npt.NDArray[np.int32]
Rows = npt.NDArray[np.int64]  # (n, 6): level, left, bottom, right, top (nm), owner


class Grid:
    """Places (level, i, j) at (i dx, j dy) within ``area`` (nm), levels of RoutingRules.layers from 1 on.

    fixed: for segments [0] and for vias [1] to the layer above, arrays [level - 1, column, row] of FREE, BLOCKED or the
    net that may pass. used: the same of how many shapes are too near, of any net, and how often nets contended.
    """

    def __init__(self, area: Box, rules: RoutingRules) -> None:
        self.rules, self.step = rules, np.array(rules.step)
        self.first = np.array(area[:2]) // self.step
        shape = np.array(area[2:]) // self.step - self.first + 2
        self.levels, self.columns, self.rows = len(rules.layers) - 1, *shape.tolist()
        self.fixed: Owners = np.zeros((2, self.levels, *shape), np.int32)
        self.used: Counts = np.zeros((2, self.levels, *shape), np.int32)
        self.reach = _reaches(rules)
        self.apart = [((via.size + via.space - 1) // self.step).tolist() for via in rules.vias[1:]]
        directions = [(1, WRONG_WAY) if layer.horizontal else (WRONG_WAY, 1) for layer in rules.layers[1:]]
        self.prices = np.array(directions) * self.step
        for level, factor in enumerate(LAYER_COSTS[: self.levels - 1]):
            self.prices[level] = self.prices[level] * factor
        size = int(np.prod(self.fixed.shape[1:]))
        self.cost, self.seen, self.goal, self.due = (np.zeros(size, np.int32) for _ in range(4))
        self.came = np.zeros(size, np.int8)
        self.searches = 0

    def block(self, rows: Rows) -> None:
        """Let ``rows``, boxes with an owner or BLOCKED, be fixed."""
        _block(self.fixed, rows, self.reach, self.step, self.first)

    def use(self, rows: Rows, times: int = 1) -> None:
        """Let ``rows`` be in the way of others ``times`` times more."""
        _use(self.used, rows, self.reach, self.step, self.first, times)

    def keep_apart(self, vias: Rows, times: int) -> None:
        """Let vias too near to those at ``vias``, rows (level, i, j), not at the same places, cost ``times`` more."""
        for level, i, j in (vias - (1, *self.first)).tolist():
            across, along = self.apart[level]
            self.used[1, level, max(0, i - across) : i + across + 1, max(0, j - along) : j + along + 1] += times
            self.used[1, level, i, j] -= times

    def inside(self, place: Place) -> bool:
        """Whether a place is on the grid."""
        return 0 < place[1] - self.first[0] < self.columns - 1 and 0 < place[2] - self.first[1] < self.rows - 1

    def at(self, i: int, j: int) -> Point:
        """(x, y) in nm of a place."""
        return i * int(self.step[0]), j * int(self.step[1])

    def near(self, x: int, y: int) -> list[tuple[int, int]]:
        """Places (i, j) around a point: at most four."""
        dx, dy = self.step.tolist()
        return [(i, j) for i in range(x // dx, -(-x // dx) + 1) for j in range(y // dy, -(-y // dy) + 1)]

    def search(
        self, net: int, box: Box, sources: Sequence[Place], targets: Sequence[Place],
        costs: Mapping[Place, int] | None = None, straight_nm: int | None = None,
    ) -> list[Place] | None:  # fmt: skip
        """Return the places of the cheapest path within ``box`` (nm) from a source to a target, or None.

        net: its number. costs: of sources and targets, in conflicts. straight_nm: cost of a conflict for a path that
        is to be short, which is searched for exactly.
        """
        conflict, haste = (CONFLICT_NM, HASTE) if straight_nm is None else (straight_nm, EXACT)
        low = np.maximum(np.array(box[:2]) // self.step - self.first, 1)
        high = np.minimum(np.array(box[2:]) // self.step - self.first, (self.columns - 2, self.rows - 2))
        (begins, at_begin), (ends, at_end) = (
            self._numbers(places, low, high, costs or {}, conflict) for places in (sources, targets)
        )
        if not len(begins) or not len(ends):
            return None
        self.searches += 1
        path = _search(
            self.fixed, self.used, self.cost, self.seen, self.came, self.goal, self.due, self.searches, net + 1, begins,
            ends, at_begin, at_end, low, high, self.prices, conflict, haste,
        )  # fmt: skip
        levels, columns, rows = np.unravel_index(path[::-1], self.fixed.shape[1:])
        made = zip((levels + 1).tolist(), (columns + self.first[0]).tolist(), (rows + self.first[1]).tolist())
        return list(made) or None

    def _numbers(
        self, places: Sequence[Place], low: Rows, high: Rows, costs: Mapping[Place, int], conflict: int
    ) -> tuple[Rows, Rows]:
        """Numbers of those of ``places`` that are within the window, and what each costs."""
        found = np.array(places, np.int64).reshape(-1, 3) - (1, *self.first)
        inside = ((found[:, 1:] >= low) & (found[:, 1:] <= high)).all(1)
        numbers = np.asarray(np.ravel_multi_index(tuple(found[inside].T), self.fixed.shape[1:]), np.int64)
        return numbers, np.array([costs.get(place, 0) for place in places], np.int64)[inside] * conflict


def _reaches(rules: RoutingRules) -> Rows:
    """[level, what, axis]: half of what may be at a place of a layer, and the least space (nm); -1 for nothing."""
    made = np.full((len(rules.layers), 3, 2), -1)
    for level, layer in enumerate(rules.layers):
        sizes: Sequence[tuple[int, tuple[int, int]]] = [(METAL, layer.half)]
        if 0 < level < len(rules.layers) - 1:
            sizes = [*sizes, (BELOW, rules.vias[level].below)]
        if level > 1:
            sizes = [*sizes, (ABOVE, rules.vias[level - 1].above)]
        for what, half in sizes:
            made[level, what] = np.array(half) + layer.space
    return made


@njit(cache=True)
def _range(low: int, high: int, reach: int, step: int, first: int, size: int) -> tuple[int, int]:
    """Places, from and before which, whose shapes are nearer than allowed to what is between ``low`` and ``high``."""
    begin, end = (low - reach) // step + 1 - first, -(-(high + reach) // step) - first
    return max(0, begin), min(size, end)


@njit(cache=True)
def _spans(row: Rows, what: int, reach: Rows, step: Rows, first: Rows, shape: tuple[int, ...]) -> tuple[int, ...]:
    """Of a row the index of Grid.fixed's first two axes, and the ranges of the others where ``what`` is too near."""
    kind, at = (0, row[0] - 1) if what == METAL else (1, row[0] - 1 if what == BELOW else row[0] - 2)
    across, along = reach[row[0], what, 0], reach[row[0], what, 1]
    if across < 0:
        return 0, 0, 0, 0, 0, 0
    a, c = _range(row[1], row[3], across, step[0], first[0], shape[2])
    b, d = _range(row[2], row[4], along, step[1], first[1], shape[3])
    return kind, at, a, c, b, d


@njit(cache=True)
def _block(fixed: Owners, rows: Rows, reach: Rows, step: Rows, first: Rows) -> None:
    for row in rows:
        owner = row[5] + 1 if row[5] >= 0 else BLOCKED
        for what in range(3):
            kind, at, a, c, b, d = _spans(row, what, reach, step, first, fixed.shape)
            for i in range(a, c):
                for j in range(b, d):
                    free = fixed[kind, at, i, j] == FREE or fixed[kind, at, i, j] == owner
                    fixed[kind, at, i, j] = owner if free else BLOCKED


@njit(cache=True)
def _use(used: Counts, rows: Rows, reach: Rows, step: Rows, first: Rows, times: int) -> None:
    for row in rows:
        for what in range(3):
            kind, at, a, c, b, d = _spans(row, what, reach, step, first, used.shape)
            used[kind, at, a:c, b:d] += times


@njit(cache=True)
def _search(
    fixed: Owners, used: Counts, cost: Owners, seen: Owners, came: npt.NDArray[np.int8], goal: Owners,
    due: Owners, search: int, owner: int, sources: Rows, ends: Rows, at_begin: Rows, at_end: Rows, low: Rows,
    high: Rows, prices: Rows, conflict: int, haste: int,
) -> Rows:  # fmt: skip
    """Numbers of the places of the path, from its end to its begin; none without one."""
    levels, columns, rows = fixed.shape[1:]
    layer = columns * rows
    box = np.array((columns, 0, rows, 0, levels))
    for k in range(len(ends)):
        end = ends[k]
        due[end] = at_end[k] if goal[end] != search else min(due[end], at_end[k])
        goal[end] = search
        box[4] = min(box[4], end // layer)
        i, j = end % layer // rows, end % rows
        box[0], box[1], box[2], box[3] = min(box[0], i), max(box[1], i), min(box[2], j), max(box[3], j)
    least = prices.copy()  # price of a step on a level or below
    for level in range(1, levels):
        for axis in range(2):
            least[level, axis] = min(least[level, axis], least[level - 1, axis])
    metal, via = fixed[0].ravel(), fixed[1].ravel()
    of_metal, of_via = used[0].ravel(), used[1].ravel()
    moves = (rows, -rows, 1, -1, layer, -layer)
    heap = [np.int64(0)]
    heap.pop()
    for k in range(len(sources)):
        place = sources[k]
        if seen[place] != search or at_begin[k] < cost[place]:
            cost[place], seen[place], came[place] = at_begin[k], search, -1
            heapq.heappush(heap, (at_begin[k] + _least(place, layer, rows, levels, box, least, haste)) << 28 | place)
    while heap:
        entry = heapq.heappop(heap)
        here = entry & (PAID - 1)
        if entry & PAID:  # the cheapest path and what its end costs
            path = [here]
            while came[path[-1]] >= 0:
                path.append(path[-1] - moves[came[path[-1]]])
            return np.array(path)
        level, at = here // layer, here % layer
        if (entry >> 28) - _least(here, layer, rows, levels, box, least, haste) > cost[here]:
            continue
        if goal[here] == search:
            heapq.heappush(heap, (cost[here] + due[here]) << 28 | PAID | here)
        i, j = at // rows, at % rows
        for move in range(6):
            there = here + moves[move]
            if move < 4:
                if move < 2 and not low[0] <= i + 1 - 2 * move <= high[0]:
                    continue
                if move > 1 and not low[1] <= j + 5 - 2 * move <= high[1]:
                    continue
                price = prices[level, move // 2]
            else:
                below, cut = (level, here) if move == 4 else (level - 1, there)
                if not 0 <= below < levels - 1 or (via[cut] != FREE and via[cut] != owner):
                    continue
                price = VIA_NM + of_via[cut] * conflict
            if metal[there] != FREE and metal[there] != owner:
                continue
            price += of_metal[there] * conflict
            total = cost[here] + price
            if seen[there] != search or total < cost[there]:
                cost[there], seen[there], came[there] = total, search, move
                heapq.heappush(heap, (total + _least(there, layer, rows, levels, box, least, haste)) << 28 | there)
    return np.empty(0, np.int64)


@njit(cache=True)
def _least(here: int | np.int64, layer: int, rows: int, levels: int, box: Rows, least: Rows, haste: int) -> np.int64:
    """Lower bound of the cost from a place to the box around the targets: up to the best level, along, and down."""
    level, i, j = here // layer, here % layer // rows, here % rows
    across, along = max(box[0] - i, i - box[1], 0), max(box[2] - j, j - box[3], 0)
    found = np.int64(1) << 60
    for top in range(max(level, box[4]), levels):
        found = min(found, VIA_NM * (2 * top - level - box[4]) + across * least[top, 0] + along * least[top, 1])
    return found * haste // EXACT
