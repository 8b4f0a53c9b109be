"""Placement of the transistors: their order in the row and their orientation, so that diffusions are shared."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from talbot.cells.compact.grid import Flags, Ints
from talbot.cells.compact.transistors import Schematic, Switch
from talbot.models.compiled import njit

BREAK = 10.0  # cost of a break of the diffusions; that of a net is the columns that it spans


@dataclass(frozen=True)
class Column:
    """A gate column: the n and p switch, ``a`` on the left of each unless turned."""

    n: Switch
    p: Switch
    n_turned: bool
    p_turned: bool

    def ends(self, kind: str) -> tuple[str, str]:
        """The left and the right net of its n or p switch."""
        switch, turned = (self.n, self.n_turned) if kind == "n" else (self.p, self.p_turned)
        return (switch.b, switch.a) if turned else (switch.a, switch.b)


def breaks(columns: Sequence[Column]) -> list[int]:
    """Indices k where columns k and k + 1 cannot share both diffusions."""
    pairs = enumerate(pairwise(columns))
    return [k for k, (left, right) in pairs if any(left.ends(kind)[1] != right.ends(kind)[0] for kind in "np")]


def place(schematic: Schematic, seed: int) -> list[Column]:
    """Place ``schematic`` with few breaks and short nets (simulated annealing); another seed, another placement."""
    n, p, nets = schematic.n, schematic.p, {"vdd": 0, "vss": 1}
    pins = [[[nets.setdefault(net, len(nets)) for net in (s.gate, s.a, s.b)] for s in kind] for kind in (n, p)]
    order, turned = _anneal(np.array(pins), len(nets), 4000 + 6000 * len(n) * max(1, len(n) - 4), seed)
    return [Column(n[i], p[j], bool(a), bool(b)) for i, j, a, b in zip(*order, *turned, strict=True)]


@njit(cache=True)
def _cost(pins: Ints, nets: int, order: Ints, turned: Flags) -> float:
    """The cost: breaks weigh most, then how far nets reach, without the rails."""
    low, high = np.full(nets, 1e9), np.full(nets, -1e9)
    broken, x = 0, 0.0
    for k in range(order.shape[1]):
        if k:
            gap = False
            for kind in range(2):
                left = pins[kind, order[kind, k - 1], 1 if turned[kind, k - 1] else 2]
                gap |= left != pins[kind, order[kind, k], 2 if turned[kind, k] else 1]
            broken += gap
            x += 2.0 if gap else 1.0
        for kind in range(2):
            for pin in range(3):
                at = x + (0.5 if pin == 0 else 0.0 if (pin == 1) != turned[kind, k] else 1.0)
                net = pins[kind, order[kind, k], pin]
                low[net], high[net] = min(low[net], at), max(high[net], at)
    total = BREAK * broken
    for net in range(2, nets):
        total += high[net] - low[net]
    return total


@njit(cache=True)
def _anneal(pins: Ints, nets: int, steps: int, seed: int) -> tuple[Ints, Flags]:
    """Order and orientation of kinds n and p by columns; a column's gates stay one net, or a clock's two phases."""
    np.random.seed(seed)
    count = pins.shape[1]
    order, turned = np.zeros((2, count), np.int64), np.zeros((2, count), np.bool_)
    for k in range(count):
        order[:, k] = k
    cost = _cost(pins, nets, order, turned)
    best, best_order, best_turned = cost, order.copy(), turned.copy()
    if count == 1:
        return order, turned
    for step in range(steps):
        heat = 6.0 * (1 - step / steps) ** 2 + 0.05
        old_order, old_turned = order.copy(), turned.copy()
        i, j = np.random.randint(count), np.random.randint(count)
        move = np.random.random()
        if move < 0.25:  # one switch the other way round
            kind = np.random.randint(2)
            turned[kind, i] = not turned[kind, i]
        elif move < 0.5:  # a stretch reversed
            first, last = min(i, j), max(i, j)
            for kind in range(2):
                order[kind, first : last + 1] = old_order[kind, first : last + 1][::-1]
                turned[kind, first : last + 1] = ~old_turned[kind, first : last + 1][::-1]
        elif move < 0.7:  # a column moved
            step_ = 1 if j > i else -1
            for k in range(i, j, step_):
                order[:, k], turned[:, k] = old_order[:, k + step_], old_turned[:, k + step_]
            order[:, j], turned[:, j] = old_order[:, i], old_turned[:, i]
        elif move < 0.85:
            order[:, i], order[:, j] = old_order[:, j], old_order[:, i]
            turned[:, i], turned[:, j] = old_turned[:, j], old_turned[:, i]
        else:  # p switches exchanged, where the gates allow it
            gi, gj = pins[0, order[0, i], 0], pins[0, order[0, j], 0]
            qi, qj = pins[1, order[1, i], 0], pins[1, order[1, j], 0]
            if qi == qj or (gi == qj and gj == qi) or (gi == qi and gj == qj and gi == gj):
                order[1, i], order[1, j] = order[1, j], order[1, i]
                turned[1, i], turned[1, j] = turned[1, j], turned[1, i]
        trial = _cost(pins, nets, order, turned)
        if trial <= cost or np.random.random() < np.exp((cost - trial) / heat):
            cost = trial
            if cost < best:
                best, best_order, best_turned = cost, order.copy(), turned.copy()
        else:
            order, turned = old_order, old_turned
    return best_order, best_turned
