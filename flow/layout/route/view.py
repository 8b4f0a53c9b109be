"""The board as one net sees it: what is clear to it, and whom it is too near to."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.boxes import Box, Boxes
from .board import CONTENDED, Board, as_rows
from .index import Rows
from .route import Place, Route

OWN = 40  # cost of a via too near to another one of its net, in conflicts
AVOIDED = 2000  # cost of a place too near to what its net is to avoid, in conflicts


class Straight(NamedTuple):
    """How a net is to be short. conflict_nm: of Grid.search. trunk: whether its farthest ends are joined first."""

    conflict_nm: int
    trunk: bool = False


class NetView:
    """The board as the net with the number ``net`` sees it.

    straight: how it is to be short. costs: of places from which its pins are met, in conflicts. vias, avoided: of its
    own, from which others keep away.
    """

    def __init__(self, board: Board, net: int, straight: Straight | None = None) -> None:
        self.board, self.rules, self.net, self.straight = board, board.rules, net, straight
        self.costs: dict[Place, int] = {}
        self.vias: list[Boxes] = []
        self.avoided: list[Rows] = []

    def search(self, box: Box, sources: Sequence[Place], targets: Sequence[Place]) -> list[Place] | None:
        """Return the cheapest path of this net, as Grid.search does."""
        straight_nm = self.straight.conflict_nm if self.straight else None
        return self.board.grid.search(self.net, box, sources, targets, self.costs, straight_nm)

    def hold(self, places: Boxes) -> None:
        """Let other vias of this net keep away from those of a path, rows (level, i, j), until `release`."""
        low = np.minimum(places[:-1], places[1:])
        self.vias.append(low[places[:-1, 0] != places[1:, 0]])
        self.board.grid.keep_apart(self.vias[-1], OWN)

    def avoid(self, places: Iterable[tuple[int, Box]]) -> None:
        """Let this net keep away from ``places`` (level, box), until `release`."""
        self.avoided.append(as_rows([(level, *box) for level, box in places], self.net))
        self.board.grid.use(self.avoided[-1], AVOIDED)

    def release(self) -> None:
        """Let vias and segments be anywhere again."""
        for vias in self.vias:
            self.board.grid.keep_apart(vias, -OWN)
        for rows in self.avoided:
            self.board.grid.use(rows, -AVOIDED)
        self.vias, self.avoided = [], []

    def clear(self, level: int, box: Box, others: bool = False) -> bool:
        """Whether nothing fixed, nor any net with ``others``, is nearer to ``box`` (nm) than the least space."""
        reach = self.reach(level, box)
        near = self.board.fixed.count(level, reach, self.net)
        return not near and not (others and self.board.routed.count(level, reach, self.net))

    def congestion(self, level: int, box: Box) -> int:
        """Cost of others' segments, and of conflicts before, nearer to ``box`` (nm) than the least space."""
        owners = self.board.routed.touching(level, self.reach(level, box))[:, -1]
        nets = np.unique(owners[(owners >= 0) & (owners != self.net)])
        taken = sum(self.board.price(self.board.nets[number]) for number in nets)
        return taken + int((owners == CONTENDED).sum()) * self.board.conflict()

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
