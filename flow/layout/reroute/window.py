"""A part of a board as a grid: the cost of the middle of a segment, or of a via, at a place."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import numpy.typing as npt
from numba import njit

from ..geometry.boxes import Box, Boxes
from .board import Board, Layers, overlapping
from .route import Place, Point, Route

BLOCKED = -1
CONFLICT_NM = 1500  # cost of a place that a net has, or that nets contended for, as that of so long a segment
MAX_COST = 1 << 24
Costs = npt.NDArray[np.int32]  # (columns, rows)


class NetView:
    """The board as one net sees it. own: boxes by level that are no obstacles, the net's own pins."""

    def __init__(self, board: Board, own: Mapping[int, Iterable[Sequence[int]]]) -> None:
        self.board, self.rules, self.fixed = board, board.rules, dict(board.fixed)
        for level, boxes in own.items():
            for left, bottom, right, top in boxes:
                a, b, c, d = self.fixed[level].T
                self.fixed[level] = self.fixed[level][(a >= right) | (c <= left) | (b >= top) | (d <= bottom)]

    def block(self, level: int, box: Box) -> None:
        """Let ``box`` (nm), the net's own, be an obstacle to its other segments."""
        self.fixed[level] = np.vstack([self.fixed[level], box])

    def clear(self, level: int, box: Box, others: bool = False) -> bool:
        """Whether nothing fixed, nor any net with ``others``, is nearer to ``box`` (nm) than the least space."""
        reach = self.reach(level, box)
        layers = (self.fixed, self.board.routed) if others else (self.fixed,)
        return not any(len(overlapping(boxes[level], reach)) for boxes in layers)

    def conflicts(self, route: Route) -> tuple[set[str], list[tuple[int, Box]]]:
        """Return the board's nets that are nearer to ``route`` than the least space, and (level, box) of where."""
        nets, places = set(), []
        for level, boxes in route.segments.items():
            ends = np.array(boxes)
            around = self.reach(level, (*ends[:, :2].min(0), *ends[:, 2:].max(0)))
            routed = overlapping(self.board.routed[level], around)
            for box in boxes:
                a, b, c, d = reach = self.reach(level, box)
                for left, bottom, right, top, number in overlapping(routed, reach).tolist():
                    nets.add(self.board.nets[number])
                    places.append((level, (max(left, a), max(bottom, b), min(right, c), min(top, d))))
        return nets, places

    def reach(self, level: int, box: Box) -> Box:
        """Return the box in which other nets are too near to ``box`` (nm)."""
        space = self.rules.layers[level].space - 1
        return box[0] - space, box[1] - space, box[2] + space, box[3] + space


class Window:
    """The part of a NetView in ``box`` (nm) and on the die.

    Places are (level, i, j) at (i dx, j dy); first: of the window's lower left corner. metals[level], vias[level]:
    arrays [column, row], BLOCKED where there is no place, else CONFLICT_NM for every net in the way and every time that
    nets contended for the place; a via's level is that of the layer below.
    """

    def __init__(self, view: NetView, box: Box) -> None:
        self.view, self.rules, (self.dx, self.dy) = view, view.rules, view.rules.step
        die = view.board.top.bbox().enlarged(self.dx, self.dy)  # so that no port is at the window's edge
        left, bottom = max(box[0], die.left), max(box[1], die.bottom)
        right, top = min(box[2], die.right), min(box[3], die.top)
        self.first = left // self.dx, bottom // self.dy
        self.shape = right // self.dx - self.first[0] + 1, top // self.dy - self.first[1] + 1
        reach = left - 1000, bottom - 1000, right + 1000, top + 1000
        levels = range(1, len(self.rules.layers))
        board = view.board
        self._fixed: Layers = {level: overlapping(view.fixed[level], reach) for level in levels}
        others = {level: np.vstack([board.routed[level][:, :4], board.history[level]]) for level in levels}
        self._others: Layers = {level: overlapping(boxes, reach) for level, boxes in others.items()}
        self.metals = {level: self._costs([(level, self.rules.layers[level].half)]) for level in levels}
        vias = list(enumerate(self.rules.vias))[1:]
        self.vias = {level: self._costs([(level, via.below), (level + 1, via.above)]) for level, via in vias}

    def clear(self, level: int, box: Box) -> bool:
        """Whether nothing fixed is nearer to ``box`` (nm), which is in the window, than the least space."""
        return not len(overlapping(self._fixed[level], self.view.reach(level, box)))

    def congestion(self, level: int, box: Box) -> int:
        """Segments of others, and places that nets contended for, nearer to ``box`` (nm) than the least space."""
        return len(overlapping(self._others[level], self.view.reach(level, box)))

    def inside(self, place: Place) -> bool:
        """Whether a place is in the window and not at its edge."""
        return all(0 < at - first < size - 1 for at, first, size in zip(place[1:], self.first, self.shape, strict=True))

    def at(self, i: int, j: int) -> Point:
        """(x, y) in nm of a place."""
        return i * self.dx, j * self.dy

    def near(self, x: int, y: int) -> list[tuple[int, int]]:
        """Places (i, j) around a point: at most four."""
        columns = range(x // self.dx, -(-x // self.dx) + 1)
        return [(i, j) for i in columns for j in range(y // self.dy, -(-y // self.dy) + 1)]

    def _costs(self, parts: Sequence[tuple[int, tuple[int, int]]]) -> Costs:
        """Cost of each place for boxes there, ``parts``: list of (level, half of the box's size)."""
        made = np.zeros(self.shape, np.int32)
        for level, half in parts:
            self._add(made, level, half, self._others[level], CONFLICT_NM)
        for level, half in parts:
            self._add(made, level, half, self._fixed[level], BLOCKED)
        made[[0, -1], :] = BLOCKED
        made[:, [0, -1]] = BLOCKED
        return made

    def _add(self, made: Costs, level: int, half: tuple[int, int], boxes: Boxes, cost: int) -> None:
        """Add ``cost`` where a box of half the size ``half`` is too near to one of ``boxes``."""
        step = np.array((self.dx, self.dy))
        reach = np.array(half) + self.rules.layers[level].space
        first = (boxes[:, :2] - reach) // step + 1 - self.first
        last = -((-boxes[:, 2:] - reach) // step) - self.first
        _fill(made, np.maximum(0, first), np.maximum(0, last), cost)


@njit(cache=True)
def _fill(made: Costs, first: Boxes, last: Boxes, cost: int) -> None:
    """Add ``cost``, or put BLOCKED, at the places from first[k] to before last[k], arrays (n, 2)."""
    for k in range(len(first)):
        for i in range(first[k, 0], min(last[k, 0], made.shape[0])):
            for j in range(first[k, 1], min(last[k, 1], made.shape[1])):
                made[i, j] = BLOCKED if cost < 0 else min(made[i, j] + cost, MAX_COST)
