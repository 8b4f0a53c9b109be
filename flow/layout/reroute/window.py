"""A part of a board as a grid: what it costs to have the middle of a wire, or a cut, at a place."""

import numpy as np
from numba import njit

from .board import near

BLOCKED = -1
PRICE_NM = 1500  # of a place that a net has, or that was fought over, as that of so long a wire
DEAREST = 1 << 24


class Site:
    """The board as one net sees it. own: dict level -> boxes that are no obstacles, the net's own pins."""

    def __init__(self, board, own):
        self.board, self.wiring, self.fixed = board, board.wiring, dict(board.fixed)
        for level, boxes in own.items():
            for left, bottom, right, top in boxes:
                there = self.fixed[level]
                self.fixed[level] = there[
                    (there[:, 0] >= right) | (there[:, 2] <= left) | (there[:, 1] >= top) | (there[:, 3] <= bottom)
                ]

    def block(self, level, box):
        """From now on the net's other wires come nowhere near ``box`` (nm) of its own."""
        self.fixed[level] = np.vstack([self.fixed[level], box])

    def clear(self, level, box, others=False):
        """Whether nothing fixed, or nothing at all with ``others``, is nearer to ``box`` (nm) than wires must be."""
        reach = self.reach(level, box)
        return not len(near(self.fixed[level], reach)) and not (others and len(near(self.board.there[level], reach)))

    def fought_over(self, shapes):
        """(nets, places): names of the board's nets that are nearer to the Shapes ``shapes`` than wires must be, and
        [(level, box), ...] of where."""
        nets, places = set(), []
        for level, boxes in shapes.wires.items():
            ends = np.array(boxes)
            there = near(self.board.there[level], self.reach(level, (*ends[:, :2].min(0), *ends[:, 2:].max(0))))
            for box in boxes:
                reach = self.reach(level, box)
                for left, bottom, right, top, number in near(there, reach).tolist():
                    nets.add(self.board.nets[number])
                    places.append(
                        (level, (max(left, reach[0]), max(bottom, reach[1]), min(right, reach[2]), min(top, reach[3])))
                    )
        return nets, places

    def reach(self, level, box):
        """Where wires are too near to ``box`` (nm)."""
        space = self.wiring.layers[level].space - 1
        return box[0] - space, box[1] - space, box[2] + space, box[3] + space


class Window:
    """site: Site. box: (left, bottom, right, top) in nm, of which the part on the die is meant.

    Places are (level, i, j) at (i dx, j dy); first: of the window's lower left corner. wires[level], cuts[level]: int32
    arrays [column, row], BLOCKED where there is no place, else PRICE_NM for every net that is in the way and every time
    that the place was fought over; a cut's level is that of the layer below.
    """

    def __init__(self, site, box):
        self.site, self.wiring, (self.dx, self.dy) = site, site.wiring, site.wiring.step
        die = site.board.top.bbox().enlarged(self.dx, self.dy)  # so that no port is at the window's edge
        left, bottom = max(box[0], die.left), max(box[1], die.bottom)
        right, top = min(box[2], die.right), min(box[3], die.top)
        self.first = left // self.dx, bottom // self.dy
        self.shape = right // self.dx - self.first[0] + 1, top // self.dy - self.first[1] + 1
        reach = left - 1000, bottom - 1000, right + 1000, top + 1000
        levels = range(1, len(self.wiring.layers))
        self._fixed = {level: near(site.fixed[level], reach) for level in levels}
        self._others = {
            level: near(np.vstack([site.board.there[level][:, :4], site.board.scars[level]]), reach) for level in levels
        }
        self.wires = {level: self._prices([(level, self._half(level))]) for level in levels}
        self.cuts = {
            level: self._prices([(level, cut.below), (level + 1, cut.above)])
            for level, cut in enumerate(self.wiring.cuts)
            if level
        }

    def clear(self, level, box):
        """Whether nothing fixed is nearer to ``box`` (nm), which is in the window, than wires must be."""
        return not len(near(self._fixed[level], self.site.reach(level, box)))

    def strife(self, level, box):
        """How many wires of others are nearer to ``box`` (nm), which is in the window, than wires must be, and places
        that were fought over."""
        return len(near(self._others[level], self.site.reach(level, box)))

    def inside(self, place):
        """Whether a place is in the window and not at its edge."""
        return all(0 < at - first < size - 1 for at, first, size in zip(place[1:], self.first, self.shape, strict=True))

    def at(self, i, j):
        """(x, y) in nm of a place."""
        return i * self.dx, j * self.dy

    def near(self, x, y):
        """Places (i, j) around a point: at most four."""
        return [
            (x // self.dx + a, y // self.dy + b)
            for a in range(1 + bool(x % self.dx))
            for b in range(1 + bool(y % self.dy))
        ]

    def _half(self, level):
        return (self.wiring.layers[level].width // 2,) * 2

    def _prices(self, parts):
        """What each place costs for boxes of half the size ``half`` there, ``parts``: list of (level, half)."""
        made = np.zeros(self.shape, np.int32)
        for level, half in parts:
            self._fill(made, level, half, self._others[level], PRICE_NM)
        for level, half in parts:
            self._fill(made, level, half, self._fixed[level], BLOCKED)
        made[[0, -1], :] = BLOCKED
        made[:, [0, -1]] = BLOCKED
        return made

    def _fill(self, made, level, half, boxes, price):
        """Where a box of half the size ``half`` is too near to one of ``boxes``, ``price`` is added."""
        step = np.array((self.dx, self.dy))
        reach = np.array(half) + self.wiring.layers[level].space
        first = (boxes[:, :2] - reach) // step + 1 - self.first
        last = -((-boxes[:, 2:] - reach) // step) - self.first
        _fill(made, np.maximum(0, first), np.maximum(0, last), price)


@njit(cache=True)
def _fill(made, first, last, price):
    """Add ``price``, or put BLOCKED, at the places from first[k] to before last[k], arrays (n, 2)."""
    for k in range(len(first)):
        for i in range(first[k, 0], min(last[k, 0], made.shape[0])):
            for j in range(first[k, 1], min(last[k, 1], made.shape[1])):
                made[i, j] = BLOCKED if price < 0 else min(made[i, j] + price, DEAREST)
