"""Where a layout breaks rules that the router keeps: least space and width, and antennas."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path

from talbot.base.gds import db, read_gds
from talbot.platforms.coriolis import CoriolisPlatform

from ..geometry.antenna import charged
from ..geometry.boxes import Box, corners
from .board import Board
from .rules import RoutingRules


@dataclass(frozen=True)
class Violations:
    """Violations of a layout.

    spacing: (level, box, box) of two edges (nm) that are too near, of metal or of the vias below it, or of vias that
    overlap.
    antennas: (level, polygon as KLayout writes it, gates on it in nm).
    Levels are those of RoutingRules.layers.
    """

    spacing: tuple[tuple[int, Box, Box], ...] = ()
    antennas: tuple[tuple[int, str, tuple[Box, ...]], ...] = ()

    def __add__(self, other: "Violations") -> "Violations":
        return Violations(self.spacing + other.spacing, self.antennas + other.antennas)

    def nets(self, board: Board, among: Iterable[str] | None = None) -> tuple[list[str], list[tuple[str, Box]]]:
        """Return the nets that are too near to others or to themselves, of two the first, and those with an antenna,
        each with a gate on it, as often as it has one.

        Both sorted, of the names ``among`` alone if given.
        """
        numbers = set(range(len(board.nets)) if among is None else (board.numbers[net] for net in among))
        spacing = set()
        for level, *edges in self.spacing:
            owners = {number for box in edges for number in board.owners(level, box)} & numbers
            spacing |= {board.nets[min(owners)]} if owners else set()
        found = {(net, gates) for level, metal, gates in self.antennas for net in board.within(level, metal)}
        return sorted(spacing), sorted((net, gates[0]) for net, gates in found if board.numbers[net] in numbers)


def find(
    layout: "db.Layout", rules: RoutingRules, tech: CoriolisPlatform, levels: Collection[int] | None = None
) -> Violations:
    """Violations of a KLayout layout on ``levels``, default all."""
    top, spacing = layout.top_cell(), []
    levels = range(len(rules.layers)) if levels is None else levels
    for level in filter(None, levels):  # the lowest is that of the cells' pins
        layer = rules.layers[level]
        metal = db.Region(top.begin_shapes_rec(layout.layer(layer.layer, layer.datatype)))
        via = rules.vias[level - 1]
        cuts = db.Region(top.begin_shapes_rec(layout.layer(via.layer, via.datatype)))
        found = metal.space_check(layer.space), metal.width_check(layer.width), cuts.space_check(via.space)
        for pair in (pair for pairs in found for pair in pairs.each()):
            spacing.append((level, corners(pair.first.bbox()), corners(pair.second.bbox())))
        for joined in cuts.merged().with_area(via.size**2, True).each():
            spacing.append((level, *[corners(joined.bbox())] * 2))
    return Violations(tuple(spacing), tuple(charged(layout, top, tech, levels)))


def find_in_file(path: Path, rules: RoutingRules, tech: CoriolisPlatform, levels: Collection[int]) -> Violations:
    """Violations of a GDS file: see `find`."""
    return find(read_gds(path), rules, tech, levels)


def split_levels(rules: RoutingRules, jobs: int) -> list[list[int]]:
    """``jobs`` lists of levels that take about equally long to check: a higher one joins all that is below."""
    levels, found = sorted(range(len(rules.layers)), reverse=True), [[] for _ in range(jobs)]
    for level in levels:
        min(found, key=sum).append(level)
    return found
