"""From blocks to places and routes: what lies where on the die. All in nm."""

from dataclasses import dataclass

from .plan import CORE, ORIENTATIONS, nets, nm, stack, with_core
from .routing import joined, length, raised, reaches, side_room, trunks


@dataclass(frozen=True)
class Arranged:
    """blocks: dict name -> Block, where it lies. nets: dict net -> pairs (block, pin). routes: dict net -> list of
    Reach, of those that the channel joins; y: dict net -> of its trunk. abutted: how many nets' pins touch. channel:
    its bottom and its top. count: of the channel's tracks."""

    blocks: dict
    nets: dict
    routes: dict
    y: dict
    abutted: int
    channel: tuple
    count: int

    @property
    def wire(self):
        """nm of all routes."""
        return sum(length(found, self.y[net]) for net, found in self.routes.items())


def arranged(blocks, die, tracks, layers, extra=()):
    """The Arranged of ``blocks``, dict name -> Block at the origin, with the chip turned so that there is least wire.

    layers: names in LEF of the wires of the chip's and of the analog blocks' pins. extra: as of `plan.nets`. Raises
    ParameterError, StepError.
    """
    return min(
        (arranged_as_is(blocks | {CORE: blocks[CORE].turned(way)}, die, tracks, layers, extra) for way in ORIENTATIONS),
        key=lambda made: made.wire,
    )


def arranged_as_is(blocks, die, tracks, layers, extra=()):
    """As `arranged`, the chip as it is given.

    Where verticals and trunks lie does not depend on the channel's height: they come first, then all blocks are raised.
    """
    analog = {name: block for name, block in blocks.items() if name != CORE}
    placed, room = stack(analog, die), side_room(blocks[CORE], tracks)
    low = with_core(placed, blocks[CORE], die, room, 0)
    found = nets(low, extra)
    routed, abutted = joined(low, found)
    routes = reaches(low, routed, die, tracks, layers)
    numbers, begin = trunks(routes, tracks), nm(die.edge_um + die.gap_um)
    count = max(numbers.values()) + 1
    height = begin + count * tracks.trunk_pitch + nm(die.gap_um)
    return Arranged(
        with_core(placed, blocks[CORE], die, room, height),
        found,
        raised(routes, height),
        {net: begin + number * tracks.trunk_pitch for net, number in numbers.items()},
        len(abutted),
        (begin, height),
        count,
    )
