"""Where the blocks lie on the die: the analog ones edge to edge, the chip to the west of the converters. All in nm."""

from dataclasses import dataclass, field, replace

from base.lef.read import read_macro
from base.steps import StepError
from models.parameters import ParameterError, check_real

CORE = "core"
BLOCKS = "pixel_array", "row_driver", "column_amplifiers", "adc_lanes"
# (block that lies, block that is put to it, its side towards the first, pin at which they meet)
MEETINGS = (
    ("pixel_array", "row_driver", "east", "pixel_reset_row[0]"),
    ("pixel_array", "column_amplifiers", "north", "column_a[0]"),
    ("column_amplifiers", "adc_lanes", "north", "lane_a[0]"),
)
DIGITAL, ANALOG = ("vdd", "vss"), ("vdda", "vssa")
SUPPLIES = DIGITAL + ANALOG
# Pins of the die, beside the supplies, from the west
SIGNALS = (
    "clk",
    "reset",
    "sclk",
    "csn",
    "mosi",
    "miso",
    "busy",
    "frame_sync",
    *(f"link_data[{k}]" for k in range(8)),
    "link_val",
    "link_rdy",
)


@dataclass(frozen=True)
class DieParameters:
    """width, height: of the die, 5 x 5 mm [Jayasuriya2017, Sec. 3.5.1]. edge: from the die's edge to the first bar.
    bar: width of the supplies' bars. gap: between bars, and between blocks that do not touch. bars: of each supply
    over the chip. pad: pitch of the signals' pins at the die's edge."""

    width_um: float = field(default=5000.0, metadata={"unit": "um"})
    height_um: float = field(default=5000.0, metadata={"unit": "um"})
    edge_um: float = field(default=10.0, metadata={"unit": "um"})
    bar_um: float = field(default=20.0, metadata={"unit": "um"})
    gap_um: float = field(default=10.0, metadata={"unit": "um"})
    pad_um: float = field(default=100.0, metadata={"unit": "um"})
    bars: int = 2

    def __post_init__(self):
        for name, low, high in (
            ("width_um", 50, 3e4),
            ("height_um", 50, 3e4),
            ("edge_um", 2, 200),
            ("bar_um", 4, 30),
            ("gap_um", 4, 200),
            ("pad_um", 2, 500),
        ):
            check_real(name, getattr(self, name), low, high)


# As LEF names them: whether west and east, and south and north, change places
ORIENTATIONS = {"N": (False, False), "FN": (True, False), "FS": (False, True), "S": (True, True)}


@dataclass(frozen=True)
class Block:
    """x, y: of its south-west corner. orientation: one of ORIENTATIONS. pins: dict pin -> tuple of (LEF layer, (left,
    bottom, right, top)), where they lie. directions: dict pin -> 'input', 'output' or 'inout'."""

    name: str
    cell: str
    x: int
    y: int
    width: int
    height: int
    pins: dict
    directions: dict
    orientation: str = "N"

    @classmethod
    def read(cls, name, text):
        """From a LEF, at the origin."""
        macro = read_macro(text)
        return cls(
            name,
            macro.name,
            0,
            0,
            nm(macro.width_um),
            nm(macro.height_um),
            {pin.name: tuple((of, tuple(map(nm, box))) for of, box in pin.boxes) for pin in macro.pins.values()},
            {pin.name: pin.direction.lower() for pin in macro.pins.values()},
        )

    @property
    def box(self):
        return self.x, self.y, self.x + self.width, self.y + self.height

    def moved(self, dx, dy):
        return replace(
            self,
            x=self.x + dx,
            y=self.y + dy,
            pins={
                pin: tuple((of, (box[0] + dx, box[1] + dy, box[2] + dx, box[3] + dy)) for of, box in boxes)
                for pin, boxes in self.pins.items()
            },
        )

    def turned(self, orientation):
        """The block, at the origin and not yet turned, in one of ORIENTATIONS."""
        sideways, upright = ORIENTATIONS[orientation]

        def turn(box):
            left, bottom, right, top = box
            if sideways:
                left, right = self.width - right, self.width - left
            if upright:
                bottom, top = self.height - top, self.height - bottom
            return left, bottom, right, top

        return replace(
            self,
            orientation=orientation,
            pins={pin: tuple((of, turn(box)) for of, box in boxes) for pin, boxes in self.pins.items()},
        )

    def at(self, side):
        """Boxes of pins that reach ``side``: list of (pin, layer, box)."""
        place = {"west": 0, "south": 1, "east": 2, "north": 3}[side]
        return [
            (pin, of, box)
            for pin, boxes in self.pins.items()
            for of, box in boxes
            if (box[place] <= self.box[place] if place < 2 else box[place] >= self.box[place])
        ]


def nm(um):
    """um as whole nm."""
    return round(um * 1000)


def stack(blocks, die):
    """dict name -> Block, the analog ones put to the array, which is in the middle of the die with its row driver;
    the column amplifiers' bottom is at y = 0. Raises ParameterError."""
    array, driver = blocks["pixel_array"], blocks["row_driver"]
    placed = {
        "pixel_array": array.moved(
            (nm(die.width_um) - array.width + driver.width) // 2 // 5 * 5, blocks["column_amplifiers"].height
        )
    }
    for there, name, side, pin in MEETINGS:
        placed[name] = meet(placed[there], blocks[name], side, pin)
    return placed


def meet(there, block, side, pin):
    """``block`` with its ``side`` at ``there``'s opposite one, so that ``pin`` of both meets."""
    ((_, own),) = [piece for piece in block.pins[pin]]
    ((_, other),) = [piece for piece in there.pins[pin]]
    if side == "east":
        return block.moved(there.x - block.width, other[1] - own[1])
    return block.moved(other[0] - own[0], there.y - block.height)


def with_core(placed, core, die, side_nm, channel_nm):
    """The stack and the chip beside the converters, all above a channel of ``channel_nm``; ``side_nm``: room for
    verticals on either side of the chip. Raises ParameterError where they do not lie within the die."""
    lanes, columns, gap = placed["adc_lanes"], placed["column_amplifiers"], nm(die.gap_um)
    bottom = max(core.height + gap, lanes.height) + channel_nm
    shifted = {name: block.moved(0, bottom - columns.y) for name, block in placed.items()}
    made = shifted | {CORE: core.moved((lanes.x - gap - side_nm - core.width) // 10 * 10, channel_nm)}
    bars = nm(die.edge_um + len(SUPPLIES) * (die.bar_um + die.gap_um))
    spans = [
        (min(block.box[low] for block in made.values()), max(block.box[low + 2] for block in made.values()))
        for low in (0, 1)
    ]
    for name, size, (begin, end), free in (
        ("width_um", die.width_um, spans[0], 2 * bars),
        ("height_um", die.height_um, (0, spans[1][1]), bars),
    ):
        if end - begin + free > nm(size):
            raise ParameterError(
                f"{name} = {size:g}: must be at least {(end - begin + free) / 1000:g}, for the blocks "
                "and the supplies' bars"
            )
    return made


def nets(blocks, extra=()):
    """dict net -> list of (block, pin): pins of one name are one net, and the die's pins, block 'die', are on theirs.

    extra: pins of analog blocks that lead to pins of the die. Raises ParameterError for a pin that no other meets, and
    for a net that nothing or more than one block drives.
    """
    found = {net: [("die", net)] for net in (*SIGNALS, *SUPPLIES, *extra)}
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


def driver(blocks, ends):
    """Of a net's ``ends`` the one that drives it: a block's output, else the die's pin."""
    return next((end for end in ends if end[0] != "die" and blocks[end[0]].directions[end[1]] == "output"), ends[0])


def touching(blocks, ends):
    """Whether the pins ``ends`` of two blocks meet edge to edge."""
    if len(ends) != 2 or any(name not in blocks for name, _ in ends):
        return False
    (one, first), (other, second) = [(name, blocks[name].pins[pin]) for name, pin in ends]
    return any(
        of == of_other and a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]
        for of, a in first
        for of_other, b in second
    )


def check_way(blocks, name, pin, box, side):
    """Raise StepError where a block lies between ``box`` of a pin and the die's ``side``."""
    for other, block in blocks.items():
        left, bottom, right, top = block.box
        if other == name:
            continue
        beside = left < box[2] and box[0] < right if side == "south" else bottom < box[3] and box[1] < top
        before = {"south": bottom < box[1], "west": left < box[0], "east": right > box[2]}[side]
        if beside and before:
            raise StepError(f"{name}: its pin {pin} has {other} in its way to the {side}")
