"""Placement of the blocks on the die and their nets, in nm: analog blocks abut, the chip is west of the converters.

It is below the column amplifiers, or west of the row driver where these have no room for it.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import NamedTuple, Self

from talbot.base.lef.read import read_macro
from talbot.base.steps import StepError
from talbot.models.parameters import ParameterError, check_real

CORE = "core"
BLOCKS = "pixel_array", "row_driver", "column_amplifiers", "adc_lanes"
Box = tuple[int, int, int, int]  # left, bottom, right, top
Terminal = tuple[str, str]  # (block, pin); block 'die' for a pin of the die


class Abutment(NamedTuple):
    """``block`` abuts ``placed`` with its ``side``, so that their pins of one name touch."""

    placed: str
    block: str
    side: str
    pin: str


ABUTMENTS = (
    Abutment("pixel_array", "row_driver", "east", "pixel_reset_row[0]"),
    Abutment("pixel_array", "column_amplifiers", "north", "column_a[0]"),
    Abutment("column_amplifiers", "adc_lanes", "north", "lane_a[0]"),
)
# Supplies of the chip; of the pixels (3.3 V), of the analog circuits (1.8 V), of the rows' lines (5 V), their ground
DIGITAL, ANALOG = ("vdd", "vss"), ("vdda", "vddc", "vddr", "vssa")
CIRCUITS = "vddc", "vssa"  # with bars in the west and in the east
SUPPLIES = DIGITAL + ANALOG
STEP_UM = 20.0  # in which a die grows
SIDES = "west", "east"  # fields of DieParameters
# Pins of the die, beside the supplies, from the west
LINK = *(f"link_data[{k}]" for k in range(8)), "link_val", "link_rdy"
SIGNALS = "clk", "reset", "sclk", "csn", "mosi", "miso", "miso_oe", "busy", "frame_sync", *LINK


class NoRoom(ParameterError):
    """A side of the die is too short.

    size: field of DieParameters that is to be changed: a size, or the number of signals on a side. least: of a size, um
    that it takes, 0 where that is not known.
    """

    def __init__(self, text: str, size: str, least: float = 0.0) -> None:
        super().__init__(text)
        self.size, self.least = size, least


@dataclass(frozen=True)
class DieParameters:
    """Sizes of the die: its blocks, and a ring of pads around them.

    width, height: 0 for the least that blocks and pads take, in steps of STEP_UM.
    ring: from the die's edge to what is inside of the pads. edge: from there to the first bar. bar: width of the
    supplies' bars. gap: between bars, and between blocks that do not touch. pad, side: pitch of the signals' pads
    in the south, and in the west and the east. west: the first of SIGNALS that have theirs in the west. east: analog
    signals that have theirs in the east, those whose pins are; all others' are in the south. Twenty on a side need 80
    leads. bars: of each supply over the chip. branch_pitch, trunk_pitch: of the routes, in their
    widths: coupling is most of a net's capacitance where they are as near as rules allow.
    """

    width_um: float = field(default=0.0, metadata={"unit": "um", "range": (0, 3e4)})
    height_um: float = field(default=0.0, metadata={"unit": "um", "range": (0, 3e4)})
    ring_um: float = field(default=203.0, metadata={"unit": "um", "range": (20, 1000)})
    edge_um: float = field(default=10.0, metadata={"unit": "um", "range": (2, 200)})
    bar_um: float = field(default=20.0, metadata={"unit": "um", "range": (4, 30)})
    gap_um: float = field(default=10.0, metadata={"unit": "um", "range": (4, 200)})
    pad_um: float = field(default=150.0, metadata={"unit": "um", "range": (2, 500)})
    side_um: float = field(default=100.0, metadata={"unit": "um", "range": (2, 500)})
    west: int = field(default=7, metadata={"range": (0, len(SIGNALS) - 1)})
    east: int = field(default=7, metadata={"range": (0, 50)})
    bars: int = 2
    branch_pitch: float = field(default=3.0, metadata={"range": (1, 25)})
    trunk_pitch: float = field(default=4.0, metadata={"range": (1, 25)})

    def __post_init__(self) -> None:
        for size in fields(self):
            if "range" in size.metadata:
                check_real(size.name, getattr(self, size.name), *size.metadata["range"])

    def larger(self, reason: NoRoom) -> Self:
        """The die with room where ``reason`` has none.

        A signal leaves a side where its pads take the supplies' place. Pads in the south first move as near to each
        other as on the other sides. Raises ``reason`` where no size helps.
        """
        if reason.size in SIDES:
            if not (count := getattr(self, reason.size)):
                raise reason
            return replace(self, **{reason.size: count - 1})
        if reason.size == "width_um" and not reason.least and self.pad_um > self.side_um:
            return replace(self, pad_um=self.side_um)
        least = max(reason.least, getattr(self, reason.size) + STEP_UM)
        return replace(self, **{reason.size: -(-least // STEP_UM) * STEP_UM})


# Of LEF: whether west and east, and south and north, are swapped
ORIENTATIONS = {"N": (False, False), "FN": (True, False), "FS": (False, True), "S": (True, True)}


class PinShape(NamedTuple):
    """A rectangle of a pin on a layer of LEF."""

    pin: str
    layer: str
    box: Box


@dataclass(frozen=True)
class Block:
    """A macro on the die.

    x, y: of its south-west corner. orientation: one of ORIENTATIONS. pins: pin -> its (LEF layer, box). directions: pin
    -> 'input', 'output' or 'inout'.
    """

    name: str
    cell: str
    x: int
    y: int
    width: int
    height: int
    pins: dict[str, tuple[tuple[str, Box], ...]]
    directions: dict[str, str]
    orientation: str = "N"

    @classmethod
    def read(cls, name: str, text: str) -> "Block":
        """Read a LEF; the block is at the origin."""
        macro = read_macro(text)
        directions = {pin.name: pin.direction.lower() for pin in macro.pins.values()}
        pins = {
            pin.name: tuple((layer, (nm(a), nm(b), nm(c), nm(d))) for layer, (a, b, c, d) in pin.boxes)
            for pin in macro.pins.values()
        }
        return cls(name, macro.name, 0, 0, nm(macro.width_um), nm(macro.height_um), pins, directions)

    @property
    def box(self) -> Box:
        """Outline."""
        return self.x, self.y, self.x + self.width, self.y + self.height

    def moved(self, dx: int, dy: int) -> "Block":
        """The block, moved."""
        pins = {
            pin: tuple((layer, (a + dx, b + dy, c + dx, d + dy)) for layer, (a, b, c, d) in boxes)
            for pin, boxes in self.pins.items()
        }
        return replace(self, x=self.x + dx, y=self.y + dy, pins=pins)

    def turned(self, orientation: str) -> "Block":
        """The block, at the origin and in orientation N, in another one."""
        sideways, upright = ORIENTATIONS[orientation]

        def turn(box: Box) -> Box:
            left, bottom, right, top = box
            if sideways:
                left, right = self.width - right, self.width - left
            if upright:
                bottom, top = self.height - top, self.height - bottom
            return left, bottom, right, top

        pins = {pin: tuple((layer, turn(box)) for layer, box in boxes) for pin, boxes in self.pins.items()}
        return replace(self, orientation=orientation, pins=pins)

    def at(self, side: str) -> list[PinShape]:
        """Shapes of pins that reach ``side``."""
        place = ("west", "south", "east", "north").index(side)
        shapes = [PinShape(pin, layer, box) for pin, boxes in self.pins.items() for layer, box in boxes]
        way = -1 if place < 2 else 1
        return [shape for shape in shapes if way * shape.box[place] >= way * self.box[place]]


def bar(net: str, side: str, die: DieParameters) -> tuple[int, int]:
    """The ends across its side of the bar of a supply in the west or the east."""
    width = nm(die.bar_um)
    begin = nm(die.ring_um + die.edge_um) + SUPPLIES.index(net) * (width + nm(die.gap_um))
    left = begin if side == "west" else nm(die.width_um) - begin - width
    return left, left + width


def nm(um: float) -> int:
    """Length in um as whole nm."""
    return round(um * 1000)


def stack(blocks: Mapping[str, Block]) -> dict[str, Block]:
    """Place the analog blocks; the array's west is at x = 0, the column amplifiers' bottom at y = 0."""
    placed = {"pixel_array": blocks["pixel_array"].moved(0, blocks["column_amplifiers"].height)}
    for there, name, side, pin in ABUTMENTS:
        placed[name] = abut(placed[there], blocks[name], side, pin)
    return placed


def abut(there: Block, block: Block, side: str, pin: str) -> Block:
    """Place ``block`` with its ``side`` at the opposite one of ``there``, so that ``pin`` of both touches."""
    ((_, own),) = block.pins[pin]
    ((_, other),) = there.pins[pin]
    if side == "east":
        return block.moved(there.x - block.width, other[1] - own[1])
    return block.moved(other[0] - own[0], there.y - block.height)


def with_core(
    placed: Mapping[str, Block], core: Block, die: DieParameters, side_nm: int, channel_nm: int
) -> dict[str, Block]:
    """Place the chip west of the converters, all blocks above a channel of ``channel_nm`` and in the die's middle.

    side_nm: width of the branches on either side of the chip. Raises NoRoom.
    """
    lanes, columns, gap = placed["adc_lanes"], placed["column_amplifiers"], nm(die.gap_um)
    bottom = max(core.height + gap, lanes.height) + channel_nm
    controls = max(shape.box[2] for shape in columns.at("south") if shape.box[2] < lanes.x)
    east = lanes.x
    if east - gap - 2 * side_nm - core.width < controls + gap:
        east = placed["row_driver"].x
    low = {name: block.moved(0, bottom - columns.y) for name, block in placed.items()}
    low[CORE] = core.moved((east - gap - side_nm - core.width) // 10 * 10, channel_nm)
    bars, north = (
        nm(die.ring_um + die.edge_um + len(nets) * (die.bar_um + die.gap_um)) for nets in (SUPPLIES, CIRCUITS)
    )
    lefts, _, rights, tops = zip(*(block.box for block in low.values()), strict=True)
    wide = max(rights) - min(lefts)
    for name, least in (("width_um", wide + 2 * bars), ("height_um", max(tops) + north)):
        if least > nm(size := getattr(die, name)):
            why = "for the blocks, the supplies' bars and the pads"
            raise NoRoom(f"{name} = {size:g}: must be at least {least / 1000:g}, {why}", name, least / 1000)
    begin = ((nm(die.width_um) - wide) // 2 - min(lefts)) // 10 * 10
    return {name: block.moved(begin, 0) for name, block in low.items()}


def nets(blocks: Mapping[str, Block], extra: Iterable[str] = ()) -> dict[str, list[Terminal]]:
    """Terminals of every net: pins of one name, of blocks and of the die, are one net.

    extra: pins of analog blocks that lead to pins of the die. Raises ParameterError for a net with one pin, and for one
    that nothing or more than one block drives.
    """
    found: dict[str, list[Terminal]] = {net: [("die", net)] for net in (*SIGNALS, *SUPPLIES, *extra)}
    for name, block in blocks.items():
        for pin in block.pins:
            found.setdefault(pin, []).append((name, pin))
    for net, ends in found.items():
        if len(ends) == 1:
            raise ParameterError(f"{net} = a pin of {ends[0][0]} alone: must be one of another block or of the die too")
        drivers = [name for name, pin in ends if name != "die" and blocks[name].directions[pin] == "output"]
        if len(drivers) > 1 or not drivers and ends[0][0] != "die":
            raise ParameterError(f"{net} = driven by {', '.join(drivers) or 'nothing'}: must have one driver")
    return dict(sorted(found.items()))


def driver(blocks: Mapping[str, Block], ends: Sequence[Terminal]) -> Terminal:
    """The terminal of a net that drives it: a block's output, else the die's pin."""
    return next((end for end in ends if end[0] != "die" and blocks[end[0]].directions[end[1]] == "output"), ends[0])


def touching(blocks: Mapping[str, Block], ends: Sequence[Terminal]) -> bool:
    """Whether the net has two terminals, of abutting blocks, that touch."""
    if len(ends) != 2 or any(name not in blocks for name, _ in ends):
        return False
    (one, first), (other, second) = [(name, blocks[name].pins[pin]) for name, pin in ends]
    return any(
        of == of_other and a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]
        for of, a in first
        for of_other, b in second
    )


def check_way(blocks: Mapping[str, Block], name: str, pin: str, box: Box, side: str) -> None:
    """Raise StepError where a block is between ``box`` of a pin and the die's ``side``."""
    for other, block in blocks.items():
        left, bottom, right, top = block.box
        if other == name:
            continue
        beside = left < box[2] and box[0] < right if side == "south" else bottom < box[3] and box[1] < top
        before = {"south": bottom < box[1], "west": left < box[0], "east": right > box[2]}[side]
        if beside and before:
            raise StepError(f"{name}: its pin {pin} has {other} in its way to the {side}")
