"""The pixels and column amplifiers of one row, for the deck of a co-simulation.

A pixel has two wells. A transistor of each resets it from the row's reset line, another connects it to its column
line from the row's read line. A charge amplifier at each column line, with a capacitor of the well's size, takes all
of its charge, whatever the capacitance of the well's junctions. Next to the row is a dark pixel whose amplifiers hold
what the switches leave: that is taken off every column. The value is formed as in `models/afe`, and transistors
sample it on a capacitor for each tap.

Amplifiers are ideal but for gain and bandwidth; the pixels and all switches are transistors, lines have resistance and
capacitance.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from talbot.models.parameters import DIODE, ELEMENTARY_CHARGE, ArrayParameters, check_real, drawn_lines
from talbot.pixels.circuits.gates import LENGTH, inverter
from talbot.pixels.circuits.netlist import Capacitor, Circuit, Instance, Transistor

STAGE = 1e-3  # S, of the stage in which an amplifier has its gain
DARK = "dark"
LINES = ("reset", "read")


@dataclass(frozen=True)
class PixelSizes:
    """Parts of a row.

    Attributes
    ----------
    full_well : float
        Electrons, 100..1e9.
    swing : float
        V by which a full well falls, 0.01..0.7.
    level : float
        V to which a well is reset, and of a column line, 0.5..0.9.
    gain, bandwidth : float
        Of a column's amplifiers, 100..1e9, and frequency at which it is 1, 1e6..1e11 Hz.
    line_resistance, line_capacitance : float
        Of the row's lines, for each column: 0.1..1e5 ohm, 1e-17..1e-11 F; as extracted, gates are transistors here.
    column_capacitance : float
        Of a column line, 1e-16..1e-10 F: metal of 384 rows, as extracted.
    hold : float
        Capacitor of a sample, 1e-15..1e-11 F.
    cut : float
        Ohm of a line that is cut, 1e9..1e15.
    """

    full_well: float = 1e5
    swing: float = 0.5
    level: float = 0.8
    gain: float = 3e4
    bandwidth: float = 500e6
    line_resistance: float = drawn_lines().row_ohm
    line_capacitance: float = drawn_lines().row_farad
    column_capacitance: float = ArrayParameters().rows * drawn_lines().column_farad
    hold: float = 500e-15
    cut: float = 1e12

    def __post_init__(self) -> None:
        check_real("full_well", self.full_well, 100, 1e9)
        check_real("swing", self.swing, 0.01, 0.7)
        check_real("level", self.level, 0.5, 0.9)
        check_real("gain", self.gain, 100, 1e9)
        check_real("bandwidth", self.bandwidth, 1e6, 1e11)
        check_real("line_resistance", self.line_resistance, 0.1, 1e5)
        check_real("line_capacitance", self.line_capacitance, 1e-17, 1e-11)
        check_real("column_capacitance", self.column_capacitance, 1e-16, 1e-10)
        check_real("hold", self.hold, 1e-15, 1e-11)
        check_real("cut", self.cut, 1e9, 1e15)

    @property
    def well(self) -> float:
        """Capacitance of a well, and of an amplifier's capacitor, F."""
        return self.full_well * ELEMENTARY_CHARGE / self.swing


def pixel(well: float, role: str = "n", length: float = LENGTH) -> Circuit:
    """Two wells of ``well`` F, their transistors. Pins: a b column_a column_b reset read level vss."""
    small = role, 0.42, length
    return Circuit(
        "pixel",
        ("a", "b", "column_a", "column_b", "reset", "read", "level", "vss"),
        tuple(
            one
            for d in ("a", "b")
            for one in (
                Transistor(f"reset_{d}", d, "reset", "level", "vss", *small),
                Transistor(f"read_{d}", d, "read", f"column_{d}", "vss", *small),
            )
        ),
        tuple(Capacitor(f"well_{d}", d, "vss", well) for d in ("a", "b")),
    )


def amplifier(sizes: PixelSizes) -> list[str]:
    """Lines of the subcircuit `charge`: pins in out clear level vss."""
    return [
        ".subckt charge in out clear level vss",
        f"Cline in vss {sizes.column_capacitance:g}",
        f"Cback in out {sizes.well:g}",
        f"Gamp vss first level in {STAGE:g}",
        f"Rfirst first vss {sizes.gain / STAGE:g}",
        f"Cfirst first vss {STAGE / (2 * math.pi * sizes.bandwidth):g}",
        "Eout out vss first vss 1",
        "Xclear in clear out vss charge_clear",
        ".ends charge",
    ]


def clear() -> Circuit:
    """Return the switch across an amplifier's capacitor. Pins: a on b vss."""
    return Circuit(
        "charge_clear", ("a", "on", "b", "vss"), (Transistor("n", "a", "on", "b", "vss", "n", 0.65, LENGTH),)
    )


def sampler() -> Circuit:
    """Return the switch of a sample. Pins: a b on vdd vss; of transistors that leak little: a row converts in 10 us.

    What a switch leaves depends on the value: 0.34 % of it on 500 fF. Transistors of half its width, with both ends at
    the sample and the opposite gate, take it.
    """
    through = (
        Transistor("n", "a", "on", "b", "vss", "n", 0.84, LENGTH),
        Transistor("p", "a", "off", "b", "vdd", "p", 1.68, LENGTH),
        Transistor("takes_n", "b", "off", "b", "vss", "n", 0.42, LENGTH),
        Transistor("takes_p", "b", "on", "b", "vdd", "p", 0.84, LENGTH),
    )
    off = Instance("off", inverter(), ("on", "off", "vdd", "vss"))
    return Circuit("sampler", ("a", "b", "on", "vdd", "vss"), through, instances=(off,))


def lines(
    diodes: Mapping[int, Mapping[int, tuple[float, float]]],
    forms: Mapping[str, tuple[float, Mapping[str, float]]],
    integration: float,
    sizes: PixelSizes,
    cols: int,
    swapped: frozenset[int] = frozenset(),
    cut: int | None = None,
) -> list[str]:
    """Lines of the deck. Their drive: nodes reset_row, read_row, clear_row, light0..3, tap0..3.

    diodes: (a, b) in LSB of each column and tap. forms: what a column samples, by name: V of the value 0, and V for
    each LSB of its diodes a and b. integration: s. cols: that the row's lines pass. swapped: columns whose diodes
    are on each other's line. cut: column from which on the row's read line is open.
    """
    places = (DARK, *map(str, range(cols)))  # the dark pixel is at the row's driver
    deck = [*row_line("reset", places, sizes), *row_line("read", places, sizes, str(cut))]
    deck += [f"Vlevel level 0 {sizes.level:g}", *_column(DARK, ("a", "b"))]
    unit = DIODE / sizes.swing
    for column, taps in diodes.items():
        names = ("b", "a") if column in swapped else ("a", "b")
        deck += _column(str(column), names)
        for tap, pair in taps.items():
            for diode, value in zip("ab", pair, strict=True):
                ampere = value / DIODE * sizes.full_well * ELEMENTARY_CHARGE / integration
                deck.append(f"Gphoto{diode}{column}_{tap} well_{diode}{column} 0 light{tap} 0 {ampere:.9g}")
        for form, (zero, volts) in forms.items():
            own = f"{form}{column}"
            parts = (f"{v * unit:+.9g}*(v(out_{d}{column})-v(out_{d}{DARK}))" for d, v in volts.items())
            deck.append(f"Bvalue{own} value{own} 0 v={zero:.9g}{''.join(parts)}")
            for tap in taps:
                deck += [
                    f"Xsampler{own}_{tap} value{own} held{own}_{tap} tap{tap} vdd 0 sampler",
                    f"Chold{own}_{tap} held{own}_{tap} 0 {sizes.hold:g}",
                    f"Ebuffer{own}_{tap} column{own}_{tap} 0 held{own}_{tap} 0 1",
                ]
    return deck


def row_line(name: str, places: Sequence[str], sizes: PixelSizes, cut: str = "") -> list[str]:
    """Return a line of the row from <name>_row on, with a node <name><place> at each pixel; open before ``cut``."""
    deck, before = [], f"{name}_row"
    for place in places:
        ohm, near, before = sizes.cut if place == cut else sizes.line_resistance, before, f"{name}{place}"
        deck += [f"R{before} {near} {before} {ohm:g}", f"C{before} {before} 0 {sizes.line_capacitance:g}"]
    return deck


def _column(column: str, names: tuple[str, str]) -> list[str]:
    """Return a pixel and the amplifiers of its two lines; names: of the lines that its diodes a and b are on."""
    a, b = (f"line_{name}{column}" for name in names)
    return [
        f"Xpixel{column} well_a{column} well_b{column} {a} {b} reset{column} read{column} level 0 pixel",
        *(f"Xcharge{d}{column} line_{d}{column} out_{d}{column} clear_row level 0 charge" for d in "ab"),
    ]
