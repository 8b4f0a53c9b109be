"""Metal of the routes, as rectangles. All in nm."""

from dataclasses import dataclass

from .plan import CORE, nm
from .routing import STUB, TRUNK, VERTICAL


@dataclass(frozen=True)
class Shape:
    """layer, datatype: of GDS. box: left, bottom, right, top."""

    net: str
    layer: int
    datatype: int
    box: tuple


def drawn(wire, net, *box):
    """The Shape of a net on a wire or a cut."""
    return Shape(net, wire.layer, wire.datatype, box)


def signal(net, reaches, y, tracks, rules):
    """Shapes of a net whose trunk lies at ``y``."""
    half, thick = tracks.vertical // 2, tracks.trunk // 2
    stub, vertical, trunk = (rules.layers[level] for level in (STUB, VERTICAL, TRUNK))
    xs = [reach.x for reach in reaches]
    yield drawn(trunk, net, min(xs) - thick, y - thick, max(xs) + thick, y + thick)
    for reach in reaches:
        yield from via(net, reach.x, y, TRUNK, rules)
        low, high = sorted((y, reach.end))
        if reach.block == CORE:
            left, bottom, right, top = reach.box
            pad = rules.vias[STUB].below
            yield drawn(stub, net, min(left, reach.x - pad[0]), bottom, max(right, reach.x + pad[0]), top)
            yield from stack(net, reach.x, reach.end, rules)
        yield drawn(vertical, net, reach.x - half, low, reach.x + half, high)


def stack(net, x, y, rules):
    """Cuts from the stub up to the vertical; the wires between have no more than their least areas."""
    for level in range(STUB, VERTICAL):
        yield from via(net, x, y, level, rules)
    for level in range(STUB + 1, VERTICAL):
        wire, height = rules.layers[level], 2 * rules.vias[level - 1].above[1]
        half = -(-wire.area // (2 * height) // 5) * 5
        yield drawn(wire, net, x - half, y - height // 2, x + half, y + height // 2)


def pad(reach, die, tracks, rules):
    """The Shape of a signal's pin at the die's south edge."""
    half = tracks.vertical // 2
    return drawn(rules.layers[VERTICAL], reach.pin, reach.x - half, 0, reach.x + half, nm(die.edge_um) // 2)


def via(net, x, y, level, rules):
    """A cut between layers[level] and the next, with its pads."""
    cut = rules.vias[level]
    for wire, (width, height) in (
        (rules.layers[level], cut.below),
        (rules.layers[level + 1], cut.above),
        (cut, (cut.size // 2, cut.size // 2)),
    ):
        yield drawn(wire, net, x - width, y - height, x + width, y + height)
