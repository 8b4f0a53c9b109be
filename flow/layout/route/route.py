"""The shapes of a net: its segments and vias."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from ..geometry.boxes import Box
from .rules import RoutingRules

CELL_PINS = 0  # level of the layer of the cells' pins, on which nothing is routed
Point = tuple[int, int]  # x, y in nm
Place = tuple[int, int, int]  # level, column, row of the search's grid


@dataclass
class Route:
    """By level: boxes of the segments (nm), (x, y) of the vias to the layer above, length of the segments (nm)."""

    segments: dict[int, list[Box]] = field(default_factory=dict)
    vias: dict[int, list[Point]] = field(default_factory=dict)
    lengths: dict[int, int] = field(default_factory=dict)

    @classmethod
    def of(cls, parts: "Iterable[Route]") -> "Route":
        """All of ``parts``."""
        made = cls()
        for part in parts:
            made.join(part)
        return made

    @property
    def nm(self) -> int:
        """Length of all segments."""
        return sum(self.lengths.values())

    def near(self, other: "Route", rules: RoutingRules) -> bool:
        """Whether a segment is nearer to one of ``other`` than the least space."""
        for level in self.segments.keys() & other.segments.keys():
            ours, theirs = (np.array(route.segments[level])[:, None] for route in (self, other))
            theirs, space = theirs.swapaxes(0, 1), rules.layers[level].space
            gaps = np.maximum(ours[..., :2] - theirs[..., 2:], theirs[..., :2] - ours[..., 2:])
            if (gaps < space).all(-1).any():
                return True
        return False

    def segment(self, level: int, box: Box, length: int = 0) -> None:
        """Add a segment, or a pad without a length."""
        self.segments.setdefault(level, []).append(box)
        self.lengths[level] = self.lengths.get(level, 0) + length

    def via(self, rules: RoutingRules, level: int, point: Point) -> None:
        """Add a via from the layer ``level`` up and its pads."""
        self.vias.setdefault(level, []).append(point)
        for at, half in ((level, rules.vias[level].below), (level + 1, rules.vias[level].above)):
            if at != CELL_PINS:
                self.segment(at, around(point, point, half))

    def join(self, other: "Route") -> None:
        """Add the shapes of ``other``."""
        for level, boxes in other.segments.items():
            self.segments.setdefault(level, []).extend(boxes)
        for level, points in other.vias.items():
            self.vias.setdefault(level, []).extend(points)
        for level, length in other.lengths.items():
            self.lengths[level] = self.lengths.get(level, 0) + length

    def draw(self, rules: RoutingRules, path: Sequence[Place]) -> None:
        """Add the segments and vias of ``path``, neighbouring places one after another."""
        dx, dy = rules.step
        for (level, i, j), (other, k, m) in pairwise(_corners(path)):
            here, there = (i * dx, j * dy), (k * dx, m * dy)
            if other != level:
                self.via(rules, min(level, other), here)
            else:
                low, high = min(here, there), max(here, there)  # along a row or a column
                self.segment(level, around(low, high, rules.layers[level].half), high[0] - low[0] + high[1] - low[1])

    def listed(self, rules: RoutingRules) -> list[tuple[str, float, float]]:
        """(layer, length_um, width_um) of the segments and vias, as coriolis.dump.segments has them."""
        layers = rules.layers
        made = [(layers[level].name, nm / 1000, layers[level].width / 1000) for level, nm in self.lengths.items()]
        for level, points in self.vias.items():
            made += [(f"{layers[level].name}_{rules.vias[level].name}_{layers[level + 1].name}", 0, 0)] * len(points)
        return made


def around(low: Point, high: Point, half: tuple[int, int]) -> Box:
    """The box from ``low`` to ``high``, larger by ``half`` of a (width, height) on each side."""
    return low[0] - half[0], low[1] - half[1], high[0] + half[0], high[1] + half[1]


def _corners(path: Sequence[Place]) -> list[Place]:
    """Places where the path begins, turns, has a via or ends."""
    turns = [
        here
        for before, here, after in zip(path, path[1:], path[2:], strict=False)
        if before[0] != after[0] or any(y - x != z - y for x, y, z in zip(before, here, after, strict=True))
    ]
    return [path[0], *turns, *path[1:][-1:]]
