"""The signals' routes: from every pin a vertical to the channel, a trunk in it. All in nm."""

from dataclasses import dataclass, replace

from base.steps import StepError

from .channel import check_apart, free, left_edge
from .plan import CORE, SIGNALS, SUPPLIES, check_way, nm, touching

# Of RoutingRules.layers. Verticals are the highest: what a net joins it joins there, with its driver, so that no gate has the
# trunk or a vertical as an antenna before
STUB, TRUNK, VERTICAL = 1, 3, 4


@dataclass(frozen=True)
class Reach:
    """A pin's way to its trunk. x: of the vertical; end: y where it begins. box: of the pin, None at the die's edge;
    a pin in the west or the east has a stub from there to x."""

    block: str
    pin: str
    x: int
    end: int
    box: tuple = None


@dataclass(frozen=True)
class Tracks:
    """pitch: of verticals and of trunks; vertical, trunk: widths."""

    vertical_pitch: int
    trunk_pitch: int
    vertical: int
    trunk: int

    @classmethod
    def of(cls, rules):
        """As wide as the cuts' pads, with as much room between them."""
        cut = rules.vias[TRUNK]
        vertical = 2 * max(cut.above[0], -(-rules.layers[VERTICAL].width // 2))
        trunk = 2 * max(cut.below[1], -(-rules.layers[TRUNK].width // 2))
        pitches = [
            max(2 * width, width + rules.layers[level].space) for width, level in ((vertical, VERTICAL), (trunk, TRUNK))
        ]
        return cls(*(-(-pitch // 10) * 10 for pitch in pitches), vertical, trunk)


def joined(blocks, nets):
    """(nets that the channel joins, nets whose two pins touch): dicts net -> ends. Supplies are in neither."""
    signals = {net: ends for net, ends in nets.items() if net not in SUPPLIES}
    met = {net: ends for net, ends in signals.items() if touching(blocks, ends)}
    return {net: ends for net, ends in signals.items() if net not in met}, met


def side_room(core, tracks):
    """Width of the verticals beside the chip."""
    return (2 + max(len({pin for pin, *_ in core.at(side)}) for side in ("west", "east"))) * tracks.vertical_pitch


def reaches(blocks, routed, die, tracks, layers):
    """dict net -> list of Reach. layers: (stub, vertical) names in LEF of the pins' wires. Raises StepError."""
    made = {net: [] for net in routed}
    for name, block in blocks.items():
        if name == CORE:
            continue
        south = {pin: box for pin, of, box in block.at("south") if of == layers[1]}
        for pin in block.pins.keys() & routed.keys():
            if pin not in south:
                raise StepError(f"{name}: its pin {pin} does not reach its south side on {layers[1]}")
            check_way(blocks, name, pin, south[pin], "south")
            made[pin].append(Reach(name, pin, (south[pin][0] + south[pin][2]) // 10 * 5, south[pin][1], south[pin]))
    for net, reach in _beside(blocks[CORE], routed, tracks, layers[0]):
        made[net].append(reach)
    for net, reach in _pads(made, routed, die, tracks):
        made[net].append(reach)
    check_apart(
        {(reach.block, reach.pin): reach.x for found in made.values() for reach in found}, tracks.vertical_pitch
    )
    return made


def _beside(core, routed, tracks, layer):
    """Pairs (net, Reach) of the chip's pins, one vertical after another from its sides outwards. The lowest pin has
    the nearest."""
    left = set(core.pins) & set(routed)
    for side, edge, way in (("west", core.x, -1), ("east", core.box[2], 1)):
        pieces = {}
        for pin, of, box in core.at(side):
            if of == layer and pin in left:
                pieces[pin] = max(pieces.get(pin, box), box, key=lambda b: (b[2] - b[0], b))
        for place, (pin, box) in enumerate(sorted(pieces.items(), key=lambda item: item[1][1]), 2):
            left.discard(pin)
            yield pin, Reach(CORE, pin, edge + way * place * tracks.vertical_pitch, (box[1] + box[3]) // 10 * 5, box)
    if left:
        raise StepError(f"{CORE}: its pins {', '.join(sorted(left)[:5])} do not reach its west or east side on {layer}")


def _pads(made, routed, die, tracks):
    """Pairs (net, Reach) of the die's pins in the south, around the middle of those that they lead to."""
    out = [net for net in routed if ("die", net) in routed[net]]
    out.sort(key=lambda net: (SIGNALS.index(net) if net in SIGNALS else len(SIGNALS), net))
    taken = [reach.x for found in made.values() for reach in found]
    ends = [reach.x for net in out for reach in made[net]]
    pad, middle = nm(die.pad_um), sum(ends) // max(len(ends), 1)
    begin = max(pad, min(middle - pad * (len(out) - 1) // 2, nm(die.width_um) - pad * len(out)))
    for place, net in enumerate(out):
        x = free((begin + place * pad) // 10 * 10, taken, tracks.vertical_pitch)
        taken.append(x)
        yield net, Reach("die", net, x, 0)


def trunks(made, tracks):
    """dict net -> track of its trunk."""
    spans = {net: (min(reach.x for reach in found), max(reach.x for reach in found)) for net, found in made.items()}
    return left_edge(spans, 2 * tracks.trunk_pitch)


def raised(made, dy):
    """The routes with all but the die's pins ``dy`` higher."""

    def up(reach):
        if reach.block == "die":
            return reach
        box = reach.box and (reach.box[0], reach.box[1] + dy, reach.box[2], reach.box[3] + dy)
        return replace(reach, end=reach.end + dy, box=box)

    return {net: [up(reach) for reach in found] for net, found in made.items()}


def length(found, y):
    """nm of a net's wires, its trunk at ``y``."""
    xs = [reach.x for reach in found]
    return max(xs) - min(xs) + sum(abs(reach.end - y) + stub(reach) for reach in found)


def stub(reach):
    """nm of the wire from a pin in the west or the east to its vertical."""
    return max(reach.box[0] - reach.x, reach.x - reach.box[2], 0) if reach.block == CORE else 0
