"""Routes of the signals, in nm: a trunk in the channel, a vertical branch from it to every pin."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from talbot.base.steps import StepError
from talbot.flow.layout.sensor.channel import check_apart, left_edge
from talbot.flow.layout.sensor.plan import (
    CORE,
    SIGNALS,
    SUPPLIES,
    Block,
    Box,
    DieParameters,
    NoRoom,
    Terminal,
    bar,
    check_way,
    driver,
    nm,
    touching,
)
from talbot.flow.layout.sensor.ring import BESIDE_CHIP, CIRCUITS_ON_SIDE, GAP, UM, Pads, function
from talbot.flow.layout.sensor.rules import RoutingRules

# Places in RoutingRules.layers. Branches are the highest: a net is connected only there, with its driver, so that no
# gate has a trunk or a branch as an antenna before. Stubs are where the chip's ports are
STUB, TRUNK, BRANCH = 3, 3, 4
PAD = 1  # of the pads' pins
STUB_HALF, ABOVE = 150, 700  # of the metal from a pad's pin, and how far inside of the ring its vias are
Nets = Mapping[str, list[Terminal]]


@dataclass(frozen=True)
class Branch:
    """A pin's connection to its trunk.

    x: of the vertical segment; end: y of its end at the pin. box: of the pin. side: of the die, where its pad is. A pin
    in the west or the east, of the chip or of a pad, has a stub from there to x. level: of the pin, in
    RoutingRules.layers.
    """

    block: str
    pin: str
    x: int
    end: int
    box: Box | None = None
    side: str = "south"
    level: int = PAD


Found = Mapping[str, list[Branch]]
# From the branches of the blocks, the nets and the blocks to the branches of the die's pins
Outside = Callable[[Found, Nets, Mapping[str, Block]], Iterator[tuple[str, Branch]]]


@dataclass(frozen=True)
class Tracks:
    """Pitches and widths of branches and trunks, least height of stubs."""

    branch_pitch: int
    trunk_pitch: int
    branch: int
    trunk: int
    stub: int

    @classmethod
    def of(cls, rules: RoutingRules, die: DieParameters) -> "Tracks":
        """As wide as the vias' pads."""
        via = rules.vias[TRUNK]
        branch = 2 * max(via.above[0], -(-rules.layers[BRANCH].width // 2))
        trunk = 2 * max(via.below[1], -(-rules.layers[TRUNK].width // 2))
        sizes = (branch, rules.layers[BRANCH]), (trunk, rules.layers[TRUNK])
        pitches = die.branch_pitch, die.trunk_pitch
        branch_pitch, trunk_pitch = (
            -(-max(round(pitch * width), width + layer.space) // 10) * 10
            for pitch, (width, layer) in zip(pitches, sizes, strict=True)
        )
        return cls(branch_pitch, trunk_pitch, branch, trunk, rules.layers[STUB].width)


def split_nets(blocks: Mapping[str, Block], nets: Nets) -> tuple[Nets, Nets]:
    """Nets that the channel routes, and nets whose two pins touch. Supplies are in neither."""
    signals = {net: ends for net, ends in nets.items() if net not in SUPPLIES}
    met = {net: ends for net, ends in signals.items() if touching(blocks, ends)}
    return {net: ends for net, ends in signals.items() if net not in met}, met


def side_room(core: Block, tracks: Tracks) -> int:
    """Width of the branches beside the chip."""
    return (2 + max(len({pin for pin, *_ in core.at(side)}) for side in ("west", "east"))) * tracks.branch_pitch


def branches(
    blocks: Mapping[str, Block], routed: Nets, tracks: Tracks, layers: Sequence[str], outside: Outside
) -> dict[str, list[Branch]]:
    """Branches of the nets. layers: (stub, branch), LEF names of the layers of the pins. Raises StepError."""
    made: dict[str, list[Branch]] = {net: [] for net in routed}
    for name, block in blocks.items():
        if name == CORE:
            continue
        south = {pin: box for pin, layer, box in block.at("south") if layer == layers[1]}
        for pin in block.pins.keys() & routed.keys():
            if pin not in south:
                raise StepError(f"{name}: its pin {pin} does not reach its south side on {layers[1]}")
            check_way(blocks, name, pin, south[pin], "south")
            made[pin].append(Branch(name, pin, (south[pin][0] + south[pin][2]) // 10 * 5, south[pin][1], south[pin]))
    for net, branch in _beside(blocks[CORE], routed, tracks, layers[0]):
        made[net].append(branch)
    for net, branch in outside(made, routed, blocks):
        made[net].append(branch)
    check_apart({(b.block, b.pin): b.x for found in made.values() for b in found}, tracks.branch_pitch)
    return made


def _beside(core: Block, routed: Nets, tracks: Tracks, layer: str) -> Iterator[tuple[str, Branch]]:
    """Pairs (net, Branch) of the chip's pins, from its sides outwards; the lowest pin has the nearest branch."""
    left = set(core.pins) & set(routed)
    for side, edge, way in (("west", core.x, -1), ("east", core.box[2], 1)):
        pieces: dict[str, list[Box]] = {}
        for pin, of, box in core.at(side):
            if of == layer and pin in left:
                pieces.setdefault(pin, []).append(box)
        boxes = {pin: _whole(found, tracks.stub) for pin, found in pieces.items()}
        for place, (pin, box) in enumerate(sorted(boxes.items(), key=lambda item: item[1][1]), 2):
            left.discard(pin)
            yield pin, Branch(CORE, pin, edge + way * place * tracks.branch_pitch, (box[1] + box[3]) // 10 * 5, box)
    if left:
        raise StepError(f"{CORE}: its pins {', '.join(sorted(left)[:5])} do not reach its west or east side on {layer}")


def _whole(pieces: Sequence[Box], least: int) -> Box:
    """Metal of a pin's ``pieces`` at a side that is ``least`` high: of one, or of some on top of each other."""
    ranked, found = sorted(pieces, key=lambda box: box[1]), list[Box]()
    for i in range(len(ranked)):
        left, bottom, right, top = ranked[i]
        for box in ranked[i:]:
            if box[1] > top:
                break
            left, right, top = max(left, box[0]), min(right, box[2]), max(top, box[3])
            found.append((left, bottom, right, top))
    high = [box for box in found if box[3] - box[1] >= least]
    return min(high or found, key=lambda box: (box[3] - box[1] if high else box[1] - box[3], box[0] - box[2], box))


def pad_branches(
    made: Found, routed: Nets, blocks: Mapping[str, Block], *, die: DieParameters, tracks: Tracks, pads: Pads
) -> Iterator[tuple[str, Branch]]:
    """Pairs (net, Branch) of the signals' pads; in the south around the middle of the blocks' pins on these nets.

    Analog signals are behind the host's, across the border of the ring's segments. Raises NoRoom.
    """
    kinds = {
        net: function(net, driver(blocks, ends)[0] == CORE) for net, ends in routed.items() if ("die", net) in ends
    }
    ranks = {net: place for place, net in enumerate(SIGNALS)}
    out = sorted(kinds, key=lambda net: (kinds[net] == "analog", ranks.get(net, len(ranks)), net))
    analog = sorted((net for net in out if kinds[net] == "analog"), key=lambda net: -max(b.x for b in made[net]))
    for side, nets, below in (("west", out[: die.west], BESIDE_CHIP), ("east", analog[: die.east], CIRCUITS_ON_SIDE)):
        yield from _on_side(side, {net: kinds[net] for net in nets}, len(below), die, tracks, pads)
        out = [net for net in out if net not in nets]
    taken = [branch.x for found in made.values() for branch in found]
    ends = [branch.x for net in out for branch in made[net]]
    pitch, middle, (low, high) = nm(die.pad_um), sum(ends) // max(len(ends), 1), pads.frame.span("south")
    at = max(low, min(middle - pitch * len(out) // 2, high - GAP - pitch * len(out))) // UM * UM
    for before, net in zip(["", *out], out):
        if before and kinds[net] != kinds[before] and kinds[net] == "analog":
            at += GAP
        left, bottom, right, top = pads.core_pin(kinds[net])
        offset = (left + right) // 10 * 5
        while any(abs(at + offset - other) < tracks.branch_pitch for other in taken):
            at += UM
        if at + pads.frame.pad + GAP > high:
            raise NoRoom(f"ring: no room for the pad of {net} in the south", "width_um")
        taken.append(at + offset)
        half = min(right - left, 2 * STUB_HALF) // 2
        box = at + offset - half, pads.frame.seal + bottom, at + offset + half, pads.frame.seal + top
        yield net, Branch("die", net, at + offset, pads.frame.inner + ABOVE, box)
        at = max(at + pitch, at + pads.frame.pad + UM)


def _on_side(
    side: str, kinds: Mapping[str, str], below: int, die: DieParameters, tracks: Tracks, pads: Pads
) -> Iterator[tuple[str, Branch]]:
    """Pairs (net, Branch) of the pads in the west or the east, from the north, above as many of supplies as ``below``.

    The branches are where that side has no bar: the west has none of the pixels, the east none of the chip. Raises
    StepError.
    """
    pitch, frame = max(nm(die.side_um), pads.frame.pad), pads.frame
    low, high = bar("vdda" if side == "west" else "vdd", side, die)
    if len(kinds) * tracks.branch_pitch > high - low:
        raise StepError(f"ring: no room for the branches of {len(kinds)} pads in the {side}")
    for k, (net, kind) in enumerate(kinds.items()):
        at = frame.span(side)[0] + pitch * (below + len(kinds) - 1 - k) // UM * UM
        left, bottom, right, top = pads.core_pin(kind)
        middle, half = (left + right) // 10 * 5, min(right - left, 2 * STUB_HALF) // 2
        box = frame.box(side, at, (middle - half, bottom, middle + half, frame.depth + ABOVE))
        yield net, Branch("die", net, low + tracks.branch_pitch // 2 + k * tracks.branch_pitch, at + middle, box, side)


def heights(made: Found, tracks: Tracks, begin: int) -> tuple[dict[str, int], int]:
    """Return the y of each net's trunk, and the number of tracks from ``begin`` on.

    The tracks are in an order in which no trunk meets the stub of another net's pin in the west or the east of the die.
    Raises StepError where none is found.
    """
    spans = {net: (min(branch.x for branch in found), max(branch.x for branch in found)) for net, found in made.items()}
    numbers = left_edge(spans, 2 * tracks.trunk_pitch)
    count = max(numbers.values()) + 1
    stubs = [(net, b) for net, found in made.items() for b in found if b.block == "die" and b.side in ("west", "east")]
    meets = set[tuple[int, int]]()  # (track, place)
    for net, pin in stubs:
        reach = tracks.trunk_pitch + ((pin.box[3] - pin.box[1]) // 2 if pin.box else 0)
        near = [k for k in range(count) if abs(begin + k * tracks.trunk_pitch - pin.end) < reach]
        for other, (low, high) in spans.items() if near else ():
            beyond = low < pin.x + tracks.trunk if pin.side == "west" else high > pin.x - tracks.trunk
            if other != net and beyond:
                meets.update((numbers[other], k) for k in near)
    places = list(range(count))  # of the tracks
    for track in range(count):
        if (track, places[track]) in meets:
            free = (k for k in range(count) if {(track, places[k]), (k, places[track])}.isdisjoint(meets))
            if (swapped := next(free, None)) is None:
                raise StepError("channel: the stub of a pin in the west or the east meets all tracks")
            places[track], places[swapped] = places[swapped], places[track]
    return {net: begin + places[number] * tracks.trunk_pitch for net, number in numbers.items()}, count


def raised(made: Mapping[str, list[Branch]], dy: int) -> dict[str, list[Branch]]:
    """The branches with all but the die's pins ``dy`` higher."""

    def up(branch: Branch) -> Branch:
        if branch.block == "die":
            return branch
        box = branch.box and (branch.box[0], branch.box[1] + dy, branch.box[2], branch.box[3] + dy)
        return replace(branch, end=branch.end + dy, box=box)

    return {net: [up(branch) for branch in found] for net, found in made.items()}


def length(found: Sequence[Branch], y: int) -> int:
    """Wire length of a net whose trunk is at ``y``."""
    xs = [branch.x for branch in found]
    return max(xs) - min(xs) + sum(abs(branch.end - y) + stub(branch) for branch in found)


def stub(branch: Branch) -> int:
    """Length of the stub from a pin in the west or the east to its branch."""
    beside = branch.block == CORE or branch.side != "south"
    return max(branch.box[0] - branch.x, branch.x - branch.box[2], 0) if beside and branch.box else 0
