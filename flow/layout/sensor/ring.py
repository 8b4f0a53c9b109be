"""The ring of pads around the blocks: which pads, where on the four sides, what joins them to the die's nets; in nm.

The ring has four segments. In the south up to the last pin of the host, and in the west beside the chip, are the
host's pins and the supplies of chip and pads. The pixels' supply is in the north and in the east beside the array, that
of the analog circuits, with the analog signals, in the south-east and in the west above the host's. In the west and the
east signals are above the supplies of their segment: below, beside the channel, a way to a pad would meet its trunks.
Fillers and corners continue the supplies'
tracks through a segment; at a border those tracks continue that are of one net on both sides: at the host's segment the
pads' ground alone, between the analog ones all but the supply. A supply's line on the top metal with another net's
track before its own passes through a slot: there is no cell, all tracks continue below that metal. Pads are beside it.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from talbot.flow.layout.sensor.plan import NoRoom
from talbot.platforms.pads import PadProcess

Box = tuple[int, int, int, int]  # left, bottom, right, top
Terminal = tuple[str, str]  # (block or pad, pin); 'die' for a bond pad
Pins = Mapping[str, Mapping[str, Sequence[Sequence[int]]]]  # cell -> pin -> [level of metal, left, bottom, right, top]

INPUTS = "clk", "reset", "sclk", "csn", "mosi", "link_rdy"
# Net of each of the tracks, by segment
DIGITAL = {"vdd": "vdd", "vss": "vss", "iovdd": "vddio", "iovss": "vssio"}
ANALOG = {"vdd": "vddc", "vss": "vssa", "iovdd": "vddr", "iovss": "vssio"}
PIXELS = ANALOG | {"vdd": "vdda"}
# Supplies on a side, evenly: in the west beside the chip, and on each side of the analog segment
BESIDE_CHIP = "vdd", "vss", "vssio", "vddio"
CIRCUITS_ON_SIDE = "vddc", "vssa", "vddr", "vssio", "vssa", "vddc"
PIXELS_ON_SIDE = "vdda", "vssa", "vddr", "vssio", "vssa", "vdda"
SIDES = "south", "east", "north", "west"
UM, GAP = 1000, 20_000  # the grid of cells in the ring; between the segments
BESIDE = 4_000  # of a line in a slot from the next cells' metal
OUTSIDE = "pad_"  # of the names of pads, and of the nets of their bond pads
TOP = 5  # level of the bond pads' metal
CORE_PINS = {"input": "p2c", "output": "c2p", "analog": "padres"}


class Place(NamedTuple):
    """A cell of the ring. at: of its low end along its side. nets: by pin, of a pad; a filler has none."""

    name: str
    cell: str
    side: str
    at: int
    nets: Mapping[str, str]


class Gap(NamedTuple):
    """Where no cell is. nets: by pin, of the tracks that continue; whole: on the top metal, too."""

    name: str
    side: str
    at: int
    width: int
    nets: Mapping[str, str]
    whole: bool = True


class Way(NamedTuple):
    """The ends along a side of a supply's line to its track."""

    net: str
    side: str
    low: int
    high: int


@dataclass(frozen=True)
class Frame:
    """Outline of the die, and the ring in it. seal: from the die's edge to the pads; depth, width: of a pad."""

    width: int
    height: int
    seal: int
    depth: int
    pad: int

    @property
    def inner(self) -> int:
        """From the die's edge to what is inside of the ring."""
        return self.seal + self.depth

    def span(self, side: str) -> tuple[int, int]:
        """Ends of a side between its corners."""
        return self.inner, (self.height if side in ("west", "east") else self.width) - self.inner

    def box(self, side: str, at: int, box: Sequence[int]) -> Box:
        """Where ``box`` of a cell at ``at`` is on the die; cells are drawn as they are in the south."""
        left, bottom, right, top = box
        low, high, near, far = at + left, at + right, self.seal + bottom, self.seal + top
        return {
            "south": (low, near, high, far),
            "north": (low, self.height - far, high, self.height - near),
            "west": (near, low, far, high),
            "east": (self.width - far, low, self.width - near, high),
        }[side]


@dataclass(frozen=True)
class Pads:
    """Outline, the pins of all cells, and the process. borders: y of those of segments, in the west and in the east."""

    frame: Frame
    cells: Pins
    process: PadProcess
    borders: Mapping[str, int]

    @property
    def filler(self) -> Mapping[str, Sequence[Sequence[int]]]:
        """Pins of the widest filler: the tracks."""
        return self.cells[next(iter(self.process.fillers.values()))]

    def box(self, place: Place) -> Box:
        """Outline of a pad or a filler."""
        widths = {name: round(um * UM) for um, name in self.process.fillers.items()}
        width = widths.get(place.cell, self.frame.pad)
        return self.frame.box(place.side, place.at, (0, 0, width, self.frame.depth))

    def core_pin(self, kind: str) -> Box:
        """Of a signal's pad of this function its pin to the core, on the lowest routing metal."""
        _, *box = next(found for found in self.cells[self.process.signals[kind]][CORE_PINS[kind]] if found[0] == 1)
        return box[0], box[1], box[2], box[3]

    def tracks(self, side: str, at: int) -> Mapping[str, str]:
        """Nets of the tracks of the west or the east at y = ``at``."""
        above = at > self.borders[side] + GAP // 2
        return {"west": (DIGITAL, ANALOG), "east": (ANALOG, PIXELS)}[side][above]

    def track(self, net: str, side: str, level: int, ends: tuple[int, int]) -> tuple[int, int] | None:
        """Of the track of a supply, on a level of metal, its two ends across the side; None where it has none there.

        ends: y of what is to meet it. Raises NoRoom where that is across the border.
        """
        pin = next((pin for pin, own in self.tracks(side, ends[0]).items() if own == net), None)
        if pin is None:
            return None
        border = self.borders[side]
        if ends[0] < border + GAP and ends[1] > border and self.tracks(side, ends[1]) != self.tracks(side, ends[0]):
            where = f"at {ends[0] / UM:g} um in the {side}"
            raise NoRoom(f"ring: {net} {where} is at the border of two segments", "height_um")
        _, _, bottom, _, top = next(found for found in self.filler[pin] if found[0] == level)
        left, low, right, high = self.frame.box(side, 0, (0, bottom, 0, top))
        return (left, right) if side in ("west", "east") else (low, high)

    def reach(self, net: str, side: str) -> Sequence[tuple[int, int]]:
        """Nothing: the tracks meet a supply's lines, not its bar."""
        return ()

    def crossed(self, net: str, side: str, at: int) -> bool:
        """Whether a supply's line on the top metal has a track of another net before its own."""
        pins = {pin for pin, own in self.tracks(side, at).items() if own == net}
        reach = [low for pin in pins for level, _, low, *_ in self.filler[pin] if level < TOP]
        others = [(level, high) for pin, boxes in self.filler.items() if pin not in pins for level, *_, high in boxes]
        return any(level == TOP and high > min(reach, default=high) for level, high in others)


def function(net: str, driven: bool) -> str:
    """Of the pad of a signal: 'output' of what the chip drives, 'input' of the host's others, else 'analog'."""
    return "output" if driven else "input" if net in INPUTS else "analog"


def signal(net: str, kind: str, at: int, process: PadProcess, side: str = "south") -> Place:
    """The pad of a signal."""
    outside = OUTSIDE + net
    tracks = ANALOG if kind == "analog" else DIGITAL
    return Place(outside, process.signals[kind], side, at, tracks | {CORE_PINS[kind]: net, "pad": outside})


def supply(net: str, number: int, side: str, at: int, process: PadProcess, tracks: Mapping[str, str]) -> Place:
    """The pad ``number`` of a supply."""
    (track,) = [track for track, own in tracks.items() if own == net]
    return Place(f"{OUTSIDE}{net}_{number}", process.supplies[track], side, at, dict(tracks))


def ring(pads: Pads, signals: Sequence[Place], ways: Iterable[Way] = ()) -> tuple[list[Place], list[Gap]]:
    """All cells of the ring but its corners, and the gaps: between the segments, and the slots of the lines ``ways``.

    signals: pads, in the south digital ones before analog ones. Raises NoRoom.
    """
    frame, process = pads.frame, pads.process
    digital = [place for place in signals if place.side == "south" and "vddio" in place.nets.values()]
    low, _ = frame.span("west")
    end = max(place.at for place in digital) + frame.pad
    west, east = pads.borders["west"], pads.borders["east"]
    gaps = [
        Gap("south_border", "south", end, GAP, _common(DIGITAL, ANALOG)),
        Gap("west_border", "west", west, GAP, _common(DIGITAL, ANALOG)),
        Gap("east_border", "east", east, GAP, _common(ANALOG, PIXELS)),
        Gap("north_border", "north", frame.span("north")[0], GAP, _common(ANALOG, PIXELS)),
    ]
    slots = [_slot(way, pads) for way in ways if pads.crossed(way.net, way.side, way.low)]
    parts = [
        ("west", low, lowest(signals, "west", west), BESIDE_CHIP, DIGITAL),
        ("east", frame.span("east")[0], lowest(signals, "east", east), CIRCUITS_ON_SIDE, ANALOG),
        ("east", east + GAP, frame.span("east")[1], PIXELS_ON_SIDE, PIXELS),
        ("north", frame.span("north")[0] + GAP, frame.span("north")[1], PIXELS_ON_SIDE, PIXELS),
        ("west", west + GAP, frame.span("west")[1], CIRCUITS_ON_SIDE, ANALOG),
    ]
    made, count = list(signals), dict[str, int]()
    for side, begin, to, nets, tracks in parts:
        room = (to - begin - len(nets) * frame.pad) // (len(nets) + 1) // UM * UM
        if room < 0:
            where = f"in the {side}, from {begin / UM:g} to {to / UM:g} um"
            raise NoRoom(f"ring: no room for {len(nets)} pads {where}", _size(side))
        beside = [slot for slot in slots if slot.side == side]
        for place, net in enumerate(nets):
            count[net] = count.get(net, 0) + 1
            at = _beside(begin + room + place * (frame.pad + room), frame.pad, beside)
            made.append(supply(net, count[net], side, at, process, tracks))
    gaps += slots
    return made + list(_fillers(frame, made, gaps, process)), gaps


def _size(side: str) -> str:
    """The size of the die along a side."""
    return "width_um" if side in ("north", "south") else "height_um"


def lowest(signals: Iterable[Place], side: str, border: int) -> int:
    """Where the signals' pads of a side begin, its border if there are none."""
    return min((place.at for place in signals if place.side == side), default=border)


def _slot(way: Way, pads: Pads) -> Gap:
    """The slot of a line."""
    at = (way.low - BESIDE) // UM * UM
    width = -(-(way.high + BESIDE - at) // UM) * UM
    return Gap(f"slot of {way.net}", way.side, at, width, pads.tracks(way.side, at), whole=False)


def _beside(at: int, pad: int, slots: Sequence[Gap]) -> int:
    """The place nearest to ``at`` where a pad is over no slot."""
    places = [at, *(slot.at - pad for slot in slots), *(slot.at + slot.width for slot in slots)]
    clear = [place for place in places if all(place + pad <= one.at or one.at + one.width <= place for one in slots)]
    return min(clear, key=lambda place: (abs(place - at), place))


def _common(one: Mapping[str, str], other: Mapping[str, str]) -> dict[str, str]:
    """Nets of the tracks that two segments share."""
    return {pin: net for pin, net in one.items() if other[pin] == net}


def _fillers(frame: Frame, places: Iterable[Place], gaps: Iterable[Gap], process: PadProcess) -> Iterator[Place]:
    """Fillers of all that is free between the corners. Raises NoRoom for what overlaps."""
    taken = [(place.side, place.at, frame.pad, place.name) for place in places]
    taken += [(gap.side, gap.at, gap.width, gap.name) for gap in gaps]
    for side in SIDES:
        (at, end), before = frame.span(side), "the corner"
        here = sorted(own for of, *own in taken if of == side)
        for begin, width, name in [*here, [end, 0, "the corner"]]:
            if begin < at:
                where = f"overlap in the {side}, at {begin / UM:g} um"
                raise NoRoom(f"ring: {before} and {name} {where}", _size(side))
            for um, cell in process.fillers.items():
                while begin - at >= um * UM:
                    yield Place(f"{side}_{at // UM}", cell, side, at, {})
                    at += round(um * UM)
            at, before = begin + width, name


def bridges(pads: Pads, gaps: Iterable[Gap]) -> Iterator[tuple[str, int, Box]]:
    """Triples (net, level of metal, box) that continue tracks across gaps."""
    for gap in gaps:
        for pin, net in gap.nets.items():
            for level, _, bottom, _, top in pads.filler[pin]:
                if level < TOP or gap.whole:
                    yield net, level, pads.frame.box(gap.side, gap.at, (0, bottom, gap.width, top))


def middle(box: Box) -> int:
    """X of the middle of a pin, on the grid."""
    return (box[0] + box[2]) // 10 * 5


def bond(place: Place, process: PadProcess) -> str:
    """The pin of a pad that is its bond pad."""
    return next((pin for pin, cell in process.supplies.items() if cell == place.cell), "pad")


def nets(inside: Mapping[str, Sequence[Terminal]], places: Iterable[Place]) -> dict[str, list[Terminal]]:
    """Terminals of the nets with those of the pads in place of the die's, which are then their bond pads."""
    found = {net: [end for end in ends if end[0] != "die"] for net, ends in inside.items()}
    for place in places:
        for pin, net in place.nets.items():
            found.setdefault(net, []).append((place.name, pin))
    bonded = {net for place in places for net in place.nets.values() if net.startswith(OUTSIDE)}
    supplied = {*DIGITAL.values(), *ANALOG.values(), *PIXELS.values()}
    return {net: [("die", net)] * (net in bonded | supplied) + ends for net, ends in sorted(found.items())}
