"""The die's supplies on the top metal, and with them all metal of the die, in nm."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, Protocol

from talbot.base.steps import StepError
from talbot.flow.layout.sensor import plan, shapes
from talbot.flow.layout.sensor.arrange import Arranged
from talbot.flow.layout.sensor.plan import (
    ANALOG,
    CIRCUITS,
    CORE,
    DIGITAL,
    SUPPLIES,
    Block,
    Box,
    DieParameters,
    NoRoom,
    check_way,
    nm,
)
from talbot.flow.layout.sensor.ring import Way
from talbot.flow.layout.sensor.routing import Tracks
from talbot.flow.layout.sensor.rules import Layer, RoutingRules
from talbot.flow.layout.sensor.shapes import Shape
from talbot.platforms.die import TopMetal


class Line(NamedTuple):
    """A segment of a supply on the top metal, to one side of the die, and there up to its edge."""

    net: str
    side: str
    box: Box


class Around(Protocol):
    """What is around the blocks: a ring of pads, or a wrapper."""

    def track(self, net: str, side: str, level: int, ends: tuple[int, int]) -> tuple[int, int] | None:
        """Return the ends across the side of a supply's track that a line at ``ends`` meets, None without one."""

    def reach(self, net: str, side: str) -> Sequence[tuple[int, int]]:
        """Return the ends in y of what a supply's bar must meet."""
        ...


def metal(
    made: Arranged, die: DieParameters, tracks: Tracks, rules: RoutingRules, top: TopMetal, around: Around
) -> list[Shape]:
    """All shapes of the die but those of the ring's cells."""
    found = supplies(made.blocks, die, rules, top, around)
    for net, branches in made.routes.items():
        found += shapes.signal(net, branches, made.y[net], tracks, rules)
    return found


def supplies(
    blocks: Mapping[str, Block], die: DieParameters, rules: RoutingRules, top: TopMetal, around: Around
) -> list[Shape]:
    """Shapes of the supplies.

    Lines on the top metal lead from the straps over the chip and from the analog blocks' pins to the tracks of the ring
    in the west and the east, across bars of the metal below, one a net; a line whose net has no track beside it ends at
    the bar. Two lines in the north connect the west with the east. Raises NoRoom for a net that meets no track.
    """
    straps, lines = _straps(blocks[CORE]), _lines(blocks, die, top)
    found: list[Shape] = []
    for net in SUPPLIES:
        met: dict[str, bool] = {}  # whether a line meets the ring, by side
        for side in ("west", "east"):
            own = [line.box for line in lines if (line.net, line.side) == (net, side)]
            if own:
                ends = plan.bar(net, side, die)
                tracks = [around.track(net, side, len(rules.layers) - 1, (box[1], box[3])) for box in own]
                reach = around.reach(net, side)
                met[side] = any(tracks) or bool(reach)
                boxes = [to_track(box, side, track or ends) for box, track in zip(own, tracks, strict=True)]
                found += _bar(net, ends, boxes, reach, rules.layers[-1], top)
                for box, track in zip(boxes, tracks, strict=True):
                    if track:
                        found += vias(net, (track[0], box[1], track[1], box[3]), top)
        if met and not any(met.values()):
            side = next(iter(met))
            raise NoRoom(f"ring: {net} meets none of its tracks, above the signals' pads in the {side}", side)
    half = nm(top.via.size_um + 2 * top.via.enclosure_below_um) // 2
    for net, at in straps:
        for line in lines:
            if line.net == net:
                found += vias(net, (at - half, line.box[1], at + half, line.box[3]), top)
    return list(dict.fromkeys(found))


def ways(blocks: Mapping[str, Block], die: DieParameters, top: TopMetal) -> list[Way]:
    """Of all lines where they meet the ring."""
    return [Way(line.net, line.side, line.box[1], line.box[3]) for line in _lines(blocks, die, top)]


def to_track(box: Box, side: str, track: tuple[int, int]) -> Box:
    """The box of a line, up to the far end of a track of the ring, or of a bar."""
    return (track[0], *box[1:]) if side == "west" else (box[0], box[1], track[1], box[3])


def crossing(blocks: Mapping[str, Block], die: DieParameters, top: TopMetal, name: str) -> list[tuple[str, Box]]:
    """Pairs (net, box) of the lines from a block to the east."""
    east = _from_blocks({name: blocks[name]}, die, top)
    return [(line.net, line.box) for line in east if line.side == "east"]


def _straps(core: Block) -> list[tuple[str, int]]:
    """Pairs (net, x) of the straps over the chip."""
    return [(net, (box[0] + box[2]) // 2) for net in DIGITAL for _, box in core.pins[net]]


def _lines(blocks: Mapping[str, Block], die: DieParameters, top: TopMetal) -> list[Line]:
    return [*_over_core(blocks[CORE], _straps(blocks[CORE]), die), *_from_blocks(blocks, die, top), *_in_north(die)]


def _bar(
    net: str, bar: tuple[int, int], boxes: Sequence[Box], reach: Sequence[tuple[int, int]], below: Layer, top: TopMetal
) -> Iterator[Shape]:
    """Shapes of a net's lines ``boxes`` and of the bar that connects them, and ``reach``, on one side of the die."""
    lows, highs = zip(*((box[1], box[3]) for box in boxes), *reach, strict=True)
    across = bar[0], min(lows), bar[1], max(highs)
    yield shapes.drawn(below, net, across)
    for box in boxes:
        yield shapes.drawn(top.metal, net, box)
        yield from vias(net, (max(box[0], across[0]), box[1], min(box[2], across[2]), box[3]), top)


def _over_core(core: Block, straps: Sequence[tuple[str, int]], die: DieParameters) -> Iterator[Line]:
    """Lines over the chip, from the west edge to its last strap."""
    count, half = die.bars * len(DIGITAL), nm(die.bar_um) // 2
    end = max(x for _, x in straps) + nm(die.gap_um)
    for place in range(count):
        middle = core.y + core.height * (2 * place + 1) // (2 * count) // 10 * 10
        yield Line(DIGITAL[place % 2], "west", (0, middle - half, end, middle + half))


def _from_blocks(blocks: Mapping[str, Block], die: DieParameters, top: TopMetal) -> Iterator[Line]:
    """Lines from the analog blocks' supply pins. Raises StepError."""
    for name in (name for name in blocks if name != CORE):
        found = [
            Line(pin, side, box)
            for side in ("west", "east")
            for pin, layer, box in blocks[name].at(side)
            if pin in ANALOG and layer == top.metal.lef
        ]
        if lacking := (set(ANALOG) & set(blocks[name].pins)) - {line.net for line in found}:
            where = f"neither its west nor its east side on {top.metal.lef}"
            raise StepError(f"{name}: its pin {min(lacking)} reaches {where}")
        for pin, side, box in found:
            check_way(blocks, name, pin, box, side)
            left, right = (0, box[2]) if side == "west" else (box[0], nm(die.width_um))
            yield Line(pin, side, (left, box[1], right, box[3]))


def _in_north(die: DieParameters) -> Iterator[Line]:
    """Lines that connect the bars of the circuits' supplies."""
    middle, width = nm(die.width_um) // 2, nm(die.width_um)
    for net in CIRCUITS:
        low, high = in_north(net, die)
        yield Line(net, "west", (0, low, middle, high))
        yield Line(net, "east", (middle, low, width, high))


def in_north(net: str, die: DieParameters) -> tuple[int, int]:
    """Ends in y of the line of one of CIRCUITS in the north."""
    bar, place = nm(die.bar_um), CIRCUITS.index(net)
    low = nm(die.height_um - die.ring_um - die.edge_um) - (place + 1) * bar - place * nm(die.gap_um)
    return low, low + bar


def vias(net: str, box: Box, top: TopMetal) -> list[Shape]:
    """As many vias to the top metal as its rules allow in ``box``, centred."""
    rooms = nm(top.via.enclosure_below_um), nm(top.via.enclosure_um)
    return shapes.cuts(net, box, top.via, nm(top.via.size_um), nm(top.via.space_um), rooms)
