"""Metal of the routes as rectangles, in nm."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from talbot.flow.layout.sensor.plan import CORE, Box
from talbot.flow.layout.sensor.routing import BRANCH, STUB, TRUNK, Branch, Tracks
from talbot.flow.layout.sensor.rules import Layer, RoutingRules, Via
from talbot.platforms import layers


@dataclass(frozen=True)
class Shape:
    """A rectangle of a net. layer, datatype: of GDS."""

    net: str
    layer: int
    datatype: int
    box: Box


def drawn(on: Layer | Via | layers.Layer | layers.Via, net: str, box: Box) -> Shape:
    """A Shape of a net on a metal layer or via."""
    return Shape(net, on.layer, on.datatype, box)


def signal(net: str, branches: Sequence[Branch], y: int, tracks: Tracks, rules: RoutingRules) -> Iterator[Shape]:
    """Shapes of a net whose trunk is at ``y``."""
    half, half_trunk = tracks.branch // 2, tracks.trunk // 2
    xs = [branch.x for branch in branches]
    trunk = min(xs) - half_trunk, y - half_trunk, max(xs) + half_trunk, y + half_trunk
    yield drawn(rules.layers[TRUNK], net, trunk)
    for branch in branches:
        yield from via(net, branch.x, y, TRUNK, rules)
        low, high = sorted((y, branch.end))
        if branch.block == CORE and branch.box:
            left, bottom, right, top = branch.box
            pad, _ = rules.vias[STUB].below
            yield drawn(rules.layers[STUB], net, (min(left, branch.x - pad), bottom, max(right, branch.x + pad), top))
            yield from stack(net, branch.x, branch.end, rules)
        elif branch.side in ("west", "east") and branch.box:
            left, bottom, right, top = branch.box
            pad, _ = rules.vias[STUB].below
            edge = right if branch.x > right else left
            first, last = sorted((edge, branch.x))
            yield drawn(rules.layers[branch.level], net, branch.box)
            for level in range(branch.level, STUB):
                yield from via(net, edge, branch.end, level, rules)
            yield from islands(net, edge, branch.end, rules, branch.level, STUB)
            wide = max((top - bottom) // 2, tracks.stub // 2)
            yield drawn(rules.layers[STUB], net, (first - pad, branch.end - wide, last + pad, branch.end + wide))
            yield from stack(net, branch.x, branch.end, rules)
        elif branch.block == "die" and branch.side == "south" and branch.box:
            left, bottom, right, _ = branch.box
            yield drawn(rules.layers[branch.level], net, (left, bottom, right, branch.end))
            yield from stack(net, branch.x, branch.end, rules, branch.level)
        yield drawn(rules.layers[BRANCH], net, (branch.x - half, low, branch.x + half, high))


def stack(net: str, x: int, y: int, rules: RoutingRules, low: int = STUB) -> Iterator[Shape]:
    """Vias from ``low`` up to the branch; the metals between have their minimum areas."""
    for level in range(low, BRANCH):
        yield from via(net, x, y, level, rules)
    yield from islands(net, x, y, rules, low, BRANCH)


def islands(net: str, x: int, y: int, rules: RoutingRules, low: int, high: int) -> Iterator[Shape]:
    """Metal of the levels between ``low`` and ``high``, in a stack of vias, with its minimum area."""
    for level in range(low + 1, high):
        layer, height = rules.layers[level], 2 * rules.vias[level - 1].above[1]
        half = -(-layer.area // (2 * height) // 5) * 5
        yield drawn(layer, net, (x - half, y - height // 2, x + half, y + height // 2))


def via(net: str, x: int, y: int, level: int, rules: RoutingRules) -> Iterator[Shape]:
    """A via between layers[level] and the next, with its pads."""
    own = rules.vias[level]
    low, high, half = rules.layers[level], rules.layers[level + 1], own.size // 2
    for on, (width, height) in ((low, own.below), (high, own.above), (own, (half, half))):
        yield drawn(on, net, (x - width, y - height, x + width, y + height))


def cuts(net: str, box: Box, on: Via | layers.Via, size: int, space: int, rooms: tuple[int, int]) -> list[Shape]:
    """As many cuts as fit into ``box``, centred. rooms: from its sides in x and in y to the first."""
    pitch, places = size + space, []
    for low, high, room in ((box[0], box[2], rooms[0]), (box[1], box[3], rooms[1])):
        count = max((high - low - 2 * room + space) // pitch, 0)
        start = (low + high - count * pitch + space) // 10 * 5
        places.append([start + k * pitch for k in range(count)])
    return [drawn(on, net, (x, y, x + size, y + size)) for x in places[0] for y in places[1]]
