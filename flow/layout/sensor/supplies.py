"""The die's supplies on the thick wire, and with them all metal of the die. All in nm."""

from base.steps import StepError

from . import shapes
from .plan import ANALOG, CORE, DIGITAL, SUPPLIES, check_way, nm


def metal(made, die, tracks, rules, thick):
    """(list of all Shapes of an Arranged, dict net -> those at the die's edge that are its pins).

    thick: TopMetal.
    """
    found, ends = supplies(made.blocks, die, rules, thick)
    pins = {net: [shapes.drawn(thick.metal, net, *box) for box in boxes] for net, boxes in ends.items()}
    for net, reaches in made.routes.items():
        found += shapes.signal(net, reaches, made.y[net], tracks, rules)
        pins |= {net: [shapes.pad(reach, die, tracks, rules)] for reach in reaches if reach.block == "die"}
    return found, pins


def supplies(blocks, die, rules, thick):
    """(list of Shapes of the supplies, dict net -> boxes of the die's pins on the thick wire).

    Thick wires lead from the straps over the chip and from the analog blocks' pins to the die's west and east edge,
    across bars of the wire below, one a net, and two thick wires in the north join the west with the east.
    """
    straps = [(net, (box[0] + box[2]) // 2) for net in DIGITAL for _, box in blocks[CORE].pins[net]]
    lines = [*_over_core(blocks[CORE], straps, die), *_from_blocks(blocks, die, thick), *_in_north(die)]
    found, pins = [], {}
    width, edge = nm(die.width_um), nm(die.edge_um)
    for net in SUPPLIES:
        for side, left, right in (("west", 0, edge), ("east", width - edge, width)):
            boxes = [box for of, way, box in lines if (of, way) == (net, side)]
            if boxes:
                found += _bar(net, side, boxes, die, rules.layers[-1], thick)
                pins.setdefault(net, []).extend((left, box[1], right, box[3]) for box in boxes)
    half = nm(thick.via.size_um + 2 * thick.via.enclosure_below_um) // 2
    for net, at in straps:
        for box in (box for of, _, box in lines if of == net):
            found += cuts(net, (at - half, box[1], at + half, box[3]), thick)
    return list(dict.fromkeys(found)), pins


def _bar(net, side, boxes, die, below, thick):
    """Shapes of a net's thick wires ``boxes`` and of the bar that joins them on one side of the die."""
    bar = nm(die.bar_um)
    begin = nm(die.edge_um) + SUPPLIES.index(net) * (bar + nm(die.gap_um))
    left = begin if side == "west" else nm(die.width_um) - begin - bar
    across = (left, min(box[1] for box in boxes), left + bar, max(box[3] for box in boxes))
    yield shapes.drawn(below, net, *across)
    for box in boxes:
        yield shapes.drawn(thick.metal, net, *box)
        yield from cuts(net, (max(box[0], across[0]), box[1], min(box[2], across[2]), box[3]), thick)


def _over_core(core, straps, die):
    """(net, side, box) of the thick wires over the chip, from the west edge to its last strap."""
    count, half = die.bars * len(DIGITAL), nm(die.bar_um) // 2
    end = max(x for _, x in straps) + nm(die.gap_um)
    for place in range(count):
        middle = core.y + core.height * (2 * place + 1) // (2 * count) // 10 * 10
        yield DIGITAL[place % 2], "west", (0, middle - half, end, middle + half)


def _from_blocks(blocks, die, thick):
    """(net, side, box) of the thick wires from the analog blocks' supply pins. Raises StepError."""
    for name in (name for name in blocks if name != CORE):
        found = [
            (pin, side, box)
            for side in ("west", "east")
            for pin, of, box in blocks[name].at(side)
            if pin in ANALOG and of == thick.metal.lef
        ]
        if lacking := set(ANALOG) - {pin for pin, *_ in found}:
            raise StepError(
                f"{name}: its pin {min(lacking)} reaches neither its west nor its east side on {thick.metal.lef}"
            )
        for pin, side, box in found:
            check_way(blocks, name, pin, box, side)
            yield pin, side, ((0, *box[1:]) if side == "west" else (*box[:2], nm(die.width_um), box[3]))


def _in_north(die):
    """(net, side, box) of the thick wires that join the analog supplies' bars."""
    bar, top = nm(die.bar_um), nm(die.height_um) - nm(die.edge_um)
    for place, net in enumerate(ANALOG):
        y = top - (place + 1) * bar - place * nm(die.gap_um)
        for side in ("west", "east"):
            yield net, side, (0, y, nm(die.width_um), y + bar)


def cuts(net, box, thick):
    """As many cuts to the thick wire as its rules allow in ``box``, in its middle."""
    size, space = nm(thick.via.size_um), nm(thick.via.space_um)
    pitch, counts, starts = size + space, [], []
    for low, high, room in ((box[0], box[2], thick.via.enclosure_below_um), (box[1], box[3], thick.via.enclosure_um)):
        count = max((high - low - 2 * nm(room) + space) // pitch, 0)
        counts.append(count)
        starts.append((low + high - count * pitch + space) // 10 * 5)
    return [
        shapes.drawn(
            thick.via,
            net,
            starts[0] + i * pitch,
            starts[1] + j * pitch,
            starts[0] + i * pitch + size,
            starts[1] + j * pitch + size,
        )
        for i in range(counts[0])
        for j in range(counts[1])
    ]
