"""Metal of the routes and of the supplies, as rectangles. All in nm."""

from dataclasses import dataclass

from .plan import ANALOG, CORE, DIGITAL, SUPPLIES, check_way, nm
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


def metal(made, straps, die, tracks, wiring, thick):
    """(list of all Shapes of an Arranged, dict net -> those at the die's edge that are its pins).

    straps: pairs (supply, x in the chip). thick: Thick.
    """
    found, ends = supplies(made.blocks, straps, die, wiring, thick)
    pins = {net: [drawn(thick.wire, net, *box) for box in boxes] for net, boxes in ends.items()}
    for net, reaches in made.routes.items():
        found += signal(net, reaches, made.y[net], tracks, wiring)
        pins |= {net: [pad(reach, die, tracks, wiring)] for reach in reaches if reach.block == "die"}
    return found, pins


def signal(net, reaches, y, tracks, wiring):
    """Shapes of a net whose trunk lies at ``y``."""
    half, thick = tracks.vertical // 2, tracks.trunk // 2
    stub, vertical, trunk = (wiring.layers[level] for level in (STUB, VERTICAL, TRUNK))
    xs = [reach.x for reach in reaches]
    yield drawn(trunk, net, min(xs) - thick, y - thick, max(xs) + thick, y + thick)
    for reach in reaches:
        yield from via(net, reach.x, y, TRUNK, wiring)
        low, high = sorted((y, reach.end))
        if reach.block == CORE:
            left, bottom, right, top = reach.box
            pad = wiring.cuts[STUB].below
            yield drawn(stub, net, min(left, reach.x - pad[0]), bottom, max(right, reach.x + pad[0]), top)
            yield from stack(net, reach.x, reach.end, wiring)
        yield drawn(vertical, net, reach.x - half, low, reach.x + half, high)


def stack(net, x, y, wiring):
    """Cuts from the stub up to the vertical; the wires between have no more than their least areas."""
    for level in range(STUB, VERTICAL):
        yield from via(net, x, y, level, wiring)
    for level in range(STUB + 1, VERTICAL):
        wire, height = wiring.layers[level], 2 * wiring.cuts[level - 1].above[1]
        half = -(-wire.area // (2 * height) // 5) * 5
        yield drawn(wire, net, x - half, y - height // 2, x + half, y + height // 2)


def pad(reach, die, tracks, wiring):
    """The Shape of a signal's pin at the die's south edge."""
    half = tracks.vertical // 2
    return drawn(wiring.layers[VERTICAL], reach.pin, reach.x - half, 0, reach.x + half, nm(die.edge_um) // 2)


def via(net, x, y, level, wiring):
    """A cut between layers[level] and the next, with its pads."""
    cut = wiring.cuts[level]
    for wire, (width, height) in ((wiring.layers[level], cut.below), (wiring.layers[level + 1], cut.above),
                                  (cut, (cut.size // 2, cut.size // 2))):
        yield drawn(wire, net, x - width, y - height, x + width, y + height)


def supplies(blocks, straps, die, wiring, thick):
    """Shapes of the supplies, and the die's pins: dict net -> list of boxes on the thick wire.

    Thick wires lead from the straps over the chip and from the analog blocks' pins to the die's west and east edge,
    across bars of the wire below, one a net, and two thick wires in the north join the west with the east.
    """
    lines = [*_over_core(blocks[CORE], straps, die), *_from_blocks(blocks, die)]
    shapes, pins, edge = [], {}, nm(die.edge_um)
    below, width, bar = wiring.layers[-1], nm(die.width_um), nm(die.bar_um)
    top = nm(die.height_um) - edge
    for place, net in enumerate(ANALOG):
        y = top - (place + 1) * bar - place * nm(die.gap_um)
        lines += [(net, side, (0, y, width, y + bar)) for side in ("west", "east")]
    for net in SUPPLIES:
        for side in ("west", "east"):
            boxes = [box for of, way, box in lines if (of, way) == (net, side)]
            if not boxes:
                continue
            begin = edge + SUPPLIES.index(net) * (bar + nm(die.gap_um))
            left = begin if side == "west" else width - begin - bar
            across = (left, min(box[1] for box in boxes), left + bar, max(box[3] for box in boxes))
            shapes.append(drawn(below, net, *across))
            for box in boxes:
                shapes += [drawn(thick.wire, net, *box),
                           *cuts(net, _both(box, across), thick)]
                at = (0, edge) if side == "west" else (width - edge, width)
                pins.setdefault(net, []).append((at[0], box[1], at[1], box[3]))
    for net, x in straps:
        for of, _, box in lines:
            if of == net:
                half = nm(thick.cut.size_um + 2 * thick.below_um) // 2
                at = blocks[CORE].x + x
                shapes += cuts(net, (at - half, box[1], at + half, box[3]), thick)
    return list(dict.fromkeys(shapes)), pins


def _over_core(core, straps, die):
    """(net, side, box) of the thick wires over the chip, from the west edge to its last strap."""
    count = die.bars * len(DIGITAL)
    end = core.x + max(x for _, x in straps) + nm(die.gap_um)
    for place in range(count):
        middle = core.y + core.height * (2 * place + 1) // (2 * count) // 10 * 10
        half = nm(die.bar_um) // 2
        yield DIGITAL[place % 2], "west", (0, middle - half, end, middle + half)


def _from_blocks(blocks, die):
    """(net, side, box) of the thick wires from the analog blocks' supply pins."""
    for name, block in blocks.items():
        for side in ("west", "east") if name != CORE else ():
            for pin, _, box in block.at(side):
                if pin in ANALOG:
                    check_way(blocks, name, pin, box, side)
                    yield pin, side, ((0, *box[1:]) if side == "west" else (*box[:2], nm(die.width_um), box[3]))


def cuts(net, box, thick):
    """As many cuts to the thick wire as its rules allow in ``box``, in its middle."""
    size, space = nm(thick.cut.size_um), nm(thick.cut.space_um)
    pitch, counts, starts = size + space, [], []
    for low, high, room in ((box[0], box[2], thick.below_um), (box[1], box[3], thick.cut.enclosure_um)):
        count = max((high - low - 2 * nm(room) + space) // pitch, 0)
        counts.append(count)
        starts.append((low + high - count * pitch + space) // 10 * 5)
    return [drawn(thick.cut, net, starts[0] + i * pitch, starts[1] + j * pitch,
                  starts[0] + i * pitch + size, starts[1] + j * pitch + size)
            for i in range(counts[0]) for j in range(counts[1])]




def _both(a, b):
    return max(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), min(a[3], b[3])
