"""The analog blocks as hard macros: their sizes, and the pins at which they meet the chip and each other.

A pin has the name of the net that it is on, the same at every block. Signals of the chip come from the south; rows,
columns and lanes continue edge to edge between blocks that touch.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Self

from talbot.models.parameters import ArrayParameters, ChipParameters, ParameterError, check_real

# Supplies: of the pixels, of the circuits at the chip's level, of the rows' lines; one ground
PIXEL_SUPPLIES, CIRCUIT_SUPPLIES, ROW_SUPPLIES = ("vdda", "vssa"), ("vddc", "vssa"), ("vddc", "vddr", "vssa")
SUPPLIES = "vdda", "vddc", "vddr", "vssa"
# Phases that the row driver gates with its row (rtl/amp_ctrl/README.md): each is a line of the row
ROW_PHASES = {"pixel_reset": 1, "shutter": 1, "integrate": 1, "read": 1, "tap": 2}
DIODES = "a", "b"
ROW_BITS, GROUP_BITS, K_BITS, BALANCE_BITS, CODE_BITS = 10, 8, 3, 10, 8
# Inputs of the blocks from the chip, bits each: phases of the amplifiers; position and trim as in pixels/afe.sv
# The row driver keeps for each row whether it is open: set by `expose`, cleared by its own `integrate` or `pixel_reset`
# and its `read` waits for the end of `ref_ctl`
DRIVER_IN = {"amp_row": ROW_BITS, "reset_row": ROW_BITS, "expose": 1} | ROW_PHASES | {"ref_ctl": 1}
COLUMNS_IN = {
    "ref_ctl": 1,
    "cm_reset": 1,
    "sample": 1,
    "read": 1,
    "tap": 2,
    "mode": 2,
    "row": ROW_BITS,
    "group": GROUP_BITS,
    "k": K_BITS,
    "sub": 2,
    "hold": 1,
}
LANES_IN = {"clk": 1, "hold": 1, "wake": 1, "convert": 1, "mode": 2, "sub": 2, "unsigned_": 1, "balance": BALANCE_BITS}
LANES_SUPPLIES = 0.25, 0.46, 0.75  # of the height: the supply of the lanes, the ground, the supply of the amplifiers
MARGIN_UM, DEEP_UM = 5.0, 2.0  # of pins from a block's corners; how far a pin reaches into its block
CONTROL_PITCH_UM = 4.0  # of the column amplifiers' control pins
# Of the drawn column amplifiers, in columns: the bank and its bias, west of the lines to the converters; the pins of
# references and biases in the east, and um from there to the room for the bias
WEST_COLUMNS, EAST_COLUMNS, EAST_UM = 49, 40, 100.0


@dataclass(frozen=True)
class AnalogSizes:
    """Room for circuits that this project does not have: assumptions, not measured. um, 20..1000 each.

    row_driver: width. columns: height of the column amplifiers. lane, lanes: width of a converter with its amplifier,
    height of all. bias: width of what is east of them, their bias and what rises from the chip to the amplifiers.
    chip: room between the column amplifiers' control pins, in their west, and the converters. The chip is there where
    it fits, else west of the row driver.
    supply: width of a supply pin.
    """

    row_driver_um: float = field(default=200.0, metadata={"unit": "um"})
    columns_um: float = field(default=200.0, metadata={"unit": "um"})
    lane_um: float = field(default=100.0, metadata={"unit": "um"})
    lanes_um: float = field(default=720.0, metadata={"unit": "um"})
    bias_um: float = field(default=140.0, metadata={"unit": "um"})
    chip_um: float = field(default=840.0, metadata={"unit": "um"})
    supply_um: float = field(default=10.0, metadata={"unit": "um"})

    def __post_init__(self) -> None:
        for name in ("row_driver_um", "columns_um", "lane_um", "lanes_um", "bias_um", "chip_um"):
            check_real(name, getattr(self, name), 20, 1000)
        check_real("supply_um", self.supply_um, 2, 30)

    @classmethod
    def of(cls, array: ArrayParameters, chip: ChipParameters) -> Self:
        """Sizes for a sensor: where its columns are too few for the whole room the chip has less."""
        sizes, pitch = cls(), array.pitch_um
        taken = control_um() + chip.lanes * sizes.lane_um + sizes.bias_um + EAST_UM + EAST_COLUMNS * pitch
        room = max(array.cols * pitch - taken, WEST_COLUMNS * pitch)
        return replace(sizes, chip_um=min(sizes.chip_um, float(round(room))))


@dataclass(frozen=True)
class Pin:
    """A pin on a block's edge.

    direction: input, output or inout, seen from the block.
    side: north, south, west or east.
    at_um: of its centre along that side.
    supply: whether it belongs to a supply.
    """

    name: str
    direction: str
    side: str
    at_um: float
    supply: bool = False


@dataclass(frozen=True)
class Block:
    """A block of the die; pins: of a supply several of one name."""

    name: str
    width_um: float
    height_um: float
    pins: tuple[Pin, ...]


def blocks(
    array: ArrayParameters | None = None, chip: ChipParameters | None = None, sizes: AnalogSizes | None = None
) -> tuple[Block, ...]:
    """Return the four analog blocks. Raises ParameterError where there is no room for the pins."""
    array, chip = array or ArrayParameters(), chip or ChipParameters()
    sizes = sizes or AnalogSizes.of(array, chip)
    return (
        pixel_array(array),
        row_driver(array, sizes),
        _column_amplifiers(array, chip, sizes),
        _adc_lanes(chip, sizes),
    )


def bits(ports: Mapping[str, int]) -> list[str]:
    """Names of the pins of ports (name -> bits), a bus bit by bit."""
    return [name if width == 1 else f"{name}[{bit}]" for name, width in ports.items() for bit in range(width)]


def control_um() -> float:
    """Width of the column amplifiers' control pins."""
    return CONTROL_PITCH_UM * (len(bits(COLUMNS_IN)) - 1) + 2 * MARGIN_UM


def row_lines(array: ArrayParameters) -> list[tuple[str, float]]:
    """Pairs (name, um from the south) of every row's lines; row 0 is the north one, as images have it."""
    lines = [f"{name}{bit if width > 1 else ''}_row" for name, width in ROW_PHASES.items() for bit in range(width)]
    pitch = array.pitch * 1e6
    return [
        (f"{line}[{row}]", (array.rows - row - 1 + (place + 0.5) / len(lines)) * pitch)
        for row in range(array.rows)
        for place, line in enumerate(lines)
    ]


def column_lines(array: ArrayParameters) -> list[tuple[str, float]]:
    """Pairs (name, um from the west) of every column's two lines, one a diode."""
    pitch = array.pitch * 1e6
    return [
        (f"column_{diode}[{column}]", (column + (place + 0.5) / len(DIODES)) * pitch)
        for column in range(array.cols)
        for place, diode in enumerate(DIODES)
    ]


def lane_lines(chip: ChipParameters, sizes: AnalogSizes) -> list[tuple[str, float]]:
    """Pairs (name, um from the west of the converters) of the lines from the column amplifiers to every lane."""
    return [
        (f"lane_{diode}[{lane}]", (lane + (place + 1) / (len(DIODES) + 1)) * sizes.lane_um)
        for lane in range(chip.lanes)
        for place, diode in enumerate(DIODES)
    ]


def pixel_array(array: ArrayParameters) -> Block:
    """Return the pixels alone, without dummies and rings."""
    width, height = array.cols * array.pitch * 1e6, array.rows * array.pitch * 1e6
    return Block(
        "pixel_array",
        width,
        height,
        (
            *(Pin(name, "input", "west", at) for name, at in row_lines(array)),
            *(Pin(name, "output", "south", at) for name, at in column_lines(array)),
            *_supplies("east", height, PIXEL_SUPPLIES),
        ),
    )


def row_driver(array: ArrayParameters, sizes: AnalogSizes) -> Block:
    """Return the drivers of all rows: the chip in the south, each row's lines in the east, supplies in the west."""
    height = array.rows * array.pitch * 1e6
    return Block(
        "row_driver",
        sizes.row_driver_um,
        height,
        (
            *_spread("row_driver", bits(DRIVER_IN), "input", 0, sizes.row_driver_um),
            *(Pin(name, "output", "east", at) for name, at in row_lines(array)),
            *_supplies("west", height, ROW_SUPPLIES),
        ),
    )


def _column_amplifiers(array: ArrayParameters, chip: ChipParameters, sizes: AnalogSizes) -> Block:
    """From the west: the control pins, room for the chip, the lines to the converters."""
    width, pins = array.cols * array.pitch * 1e6, bits(COLUMNS_IN)
    control = control_um()
    begin = control + sizes.chip_um
    if (end := begin + chip.lanes * sizes.lane_um + sizes.bias_um) > width:
        raise ParameterError(
            f"cols = {array.cols}: {width:g} um must have room for pins, chip and converters, {end:g} um"
        )
    return Block(
        "column_amplifiers",
        width,
        sizes.columns_um,
        (
            *(Pin(name, "input", "north", at) for name, at in column_lines(array)),
            *_spread("column_amplifiers", pins, "input", 0, control),
            *(Pin(name, "output", "south", begin + at) for name, at in lane_lines(chip, sizes)),
            *_supplies("west", sizes.columns_um / 2, CIRCUIT_SUPPLIES),  # above it the row driver is in the way
            *_supplies("east", sizes.columns_um, CIRCUIT_SUPPLIES),
        ),
    )


def _adc_lanes(chip: ChipParameters, sizes: AnalogSizes) -> Block:
    """Codes and decision of a lane are at its place; the other pins are spread over all lanes.

    In the east the ground is between two pins of the supply, of the lanes and of the amplifiers above these.
    """
    width = chip.lanes * sizes.lane_um
    names = [
        name
        for lane in range(chip.lanes)
        for name in (
            *(f"dac[{CODE_BITS * lane + bit}]" for bit in range(CODE_BITS)),
            f"en[{lane}]",
            f"comparator[{lane}]",
        )
    ]
    if chip.lanes == 1:
        names = [name.removesuffix("[0]") if name.startswith(("en", "comparator")) else name for name in names]
    shared = bits(LANES_IN)
    pins = _spread("adc_lanes", [*shared, *names], "input", 0, width)
    return Block(
        "adc_lanes",
        width + sizes.bias_um,
        sizes.lanes_um,
        (
            *(Pin(name, "input", "north", at) for name, at in lane_lines(chip, sizes)),
            *(
                Pin(pin.name, "output" if pin.name.startswith("comparator") else "input", "south", pin.at_um)
                for pin in pins
            ),
            *(
                Pin(name, "inout", "east", sizes.lanes_um * part, True)
                for name, part in zip(("vddc", "vssa", "vddc"), LANES_SUPPLIES, strict=True)
            ),
        ),
    )


def _spread(block: str, names: Sequence[str], direction: str, begin: float, end: float) -> list[Pin]:
    """Pins on the south side, evenly from ``begin`` to ``end`` (um). Raises ParameterError."""
    step = (end - begin - 2 * MARGIN_UM) / max(len(names) - 1, 1)
    if step < 1.5:
        raise ParameterError(
            f"{block} = {end - begin:g} um wide: must have 1.5 um for each of its {len(names)} pins in the south"
        )
    return [Pin(name, direction, "south", begin + MARGIN_UM + step * k) for k, name in enumerate(names)]


def _supplies(side: str, length: float, names: Sequence[str]) -> list[Pin]:
    """Return a pin of each supply for every 500 um of the side, one at least."""
    count = max(1, round(length / 500))
    return [
        Pin(name, "inout", side, (place + (1 + k) / (len(names) + 1)) * length / count, True)
        for place in range(count)
        for k, name in enumerate(names)
    ]
