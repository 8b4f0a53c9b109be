"""From blocks to their places and routes on the die, in nm."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from talbot.flow.layout.sensor.plan import (
    CORE,
    ORIENTATIONS,
    Block,
    DieParameters,
    Terminal,
    nets,
    nm,
    stack,
    with_core,
)
from talbot.flow.layout.sensor.routing import (
    Branch,
    Outside,
    Tracks,
    branches,
    heights,
    length,
    raised,
    side_room,
    split_nets,
)


@dataclass(frozen=True)
class Arranged:
    """A placed and routed die.

    blocks: where they are placed. routes: branches of the nets that the channel routes; y: of their trunks. abutted:
    number of nets whose pins touch. channel: its bottom and top. count: of the channel's tracks.
    """

    blocks: dict[str, Block]
    nets: dict[str, list[Terminal]]
    routes: dict[str, list[Branch]]
    y: dict[str, int]
    abutted: int
    channel: tuple[int, int]
    count: int

    @property
    def wire(self) -> int:
        """Wire length of all routes."""
        return sum(length(found, self.y[net]) for net, found in self.routes.items())


def arranged(
    blocks: dict[str, Block],
    die: DieParameters,
    tracks: Tracks,
    layers: Sequence[str],
    outside: Outside,
    extra: Iterable[str] = (),
) -> Arranged:
    """Place and route ``blocks``, given at the origin, with the chip in the orientation of the least wire length.

    layers: see `routing.branches`. extra: see `plan.nets`. Raises ParameterError, StepError.
    """
    turned = [blocks | {CORE: blocks[CORE].turned(way)} for way in ORIENTATIONS]
    return min(
        (arranged_as_is(found, die, tracks, layers, outside, extra) for found in turned), key=lambda made: made.wire
    )


def arranged_as_is(
    blocks: dict[str, Block],
    die: DieParameters,
    tracks: Tracks,
    layers: Sequence[str],
    outside: Outside,
    extra: Iterable[str] = (),
) -> Arranged:
    """Place and route with the chip in the orientation given. Arguments: see `arranged`.

    Branches and trunks do not depend on the channel's height: they come first, then all blocks are raised.
    """
    analog = {name: block for name, block in blocks.items() if name != CORE}
    placed, room = stack(analog), side_room(blocks[CORE], tracks)
    low = with_core(placed, blocks[CORE], die, room, 0)
    found = nets(low, extra)
    routed, abutted = split_nets(low, found)
    routes = branches(low, routed, tracks, layers, outside)
    begin = nm(die.ring_um + die.edge_um + die.gap_um)
    y, count = heights(routes, tracks, begin)
    height = begin + count * tracks.trunk_pitch + nm(die.gap_um)
    high = with_core(placed, blocks[CORE], die, room, height)
    return Arranged(high, found, raised(routes, height), y, len(abutted), (begin, height), count)
