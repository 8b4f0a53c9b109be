"""The board as one net sees it: what is clear to it, and whom it is too near to."""

from collections.abc import Sequence

import numpy as np

from ..geometry.boxes import Box
from .board import CONTENDED, Board, as_rows
from .grid import HELD
from .route import Place, Route


class NetView:
    """The board as the net with the number ``net`` sees it.

    held: boxes of its own that its other segments avoid. costs: of places from which its pins are met, in conflicts.
    """

    def __init__(self, board: Board, net: int) -> None:
        self.board, self.rules, self.net = board, board.rules, net
        self.held: list[tuple[int, Box]] = []
        self.costs: dict[Place, int] = {}

    def hold(self, boxes: Sequence[tuple[int, Box]]) -> None:
        """Let pairs (level, box in nm) be obstacles, until `release`."""
        self.held += boxes
        self.board.grid.use(as_rows([(level, *box) for level, box in boxes], self.net), HELD)

    def release(self) -> None:
        """Let nothing be held any longer."""
        self.board.grid.use(as_rows([(level, *box) for level, box in self.held], self.net), -HELD)
        self.held = []

    def clear(self, level: int, box: Box, others: bool = False) -> bool:
        """Whether nothing fixed, nor any net with ``others``, is nearer to ``box`` (nm) than the least space."""
        reach = self.reach(level, box)
        if self.board.fixed.count(level, reach, self.net) or (
            others and self.board.routed.count(level, reach, self.net)
        ):
            return False
        return not any(at == level and _touch(reach, held) for at, held in self.held)

    def congestion(self, level: int, box: Box) -> int:
        """Cost of others' segments, and of conflicts before, nearer to ``box`` (nm) than the least space."""
        owners = self.board.routed.touching(level, self.reach(level, box))[:, -1]
        nets = np.unique(owners[(owners >= 0) & (owners != self.net)])
        return len(nets) * self.board.present + int((owners == CONTENDED).sum()) * self.board.conflict()

    def conflicts(self, route: Route) -> tuple[set[str], list[tuple[int, Box]]]:
        """Return the board's nets that are nearer to ``route`` than the least space, and (level, box) of where."""
        nets, places = set(), []
        for level, boxes in route.segments.items():
            for box in boxes:
                a, b, c, d = reach = self.reach(level, box)
                for left, bottom, right, top, owner in self.board.routed.touching(level, reach).tolist():
                    if owner not in (CONTENDED, self.net):
                        nets.add(self.board.nets[owner])
                        places.append((level, (max(left, a), max(bottom, b), min(right, c), min(top, d))))
        return nets, places

    def reach(self, level: int, box: Box) -> Box:
        """Return the box in which other nets are too near to ``box`` (nm)."""
        space = self.rules.layers[level].space - 1
        return box[0] - space, box[1] - space, box[2] + space, box[3] + space


def _touch(one: Box, other: Box) -> bool:
    return one[0] <= other[2] and other[0] <= one[2] and one[1] <= other[3] and other[1] <= one[3]
