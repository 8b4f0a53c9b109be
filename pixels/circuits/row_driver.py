"""The driver of a row: which row it is, whether it integrates, all phases lifted from the chip's level to the pixels'.

    high, mid, low of amp_row ---- nand3 --- amp_on ---+-- shutter, read, tap0, tap1 --- lift --- the row's lines
    high, mid, low of reset_row -- nand3 --- reset_on -+-- pixel_reset -------------- lift --- its line
                                             expose ---+-- set   open --+
                                   pixel_reset, integrate --- clear     +------------ lift --- integrate's line

Predecoded lines (`predecoder`) run along all rows; a row takes one of each group. The latch `open` is set by `expose`
and cleared by `pixel_reset` or its own `integrate`, which win: the integrate line is high while it is set, and with
`integrate`. `lift` has one input and no complement: its second transistor is switched at its source.

Pins of `row`: ROW_INPUTS, ROW_LINES, vdd (the chip's level) vddr (of the lines) vss.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import log, pi
from typing import Self

from talbot.models.parameters import (
    ArrayParameters,
    ParameterError,
    SensorParameters,
    check_int,
    check_real,
    drawn_lines,
)
from talbot.pixels.circuits.gates import LENGTH, UNIT, inverter, nand
from talbot.pixels.circuits.netlist import Capacitor, Circuit, Instance, Resistor, Transistor

GROUPS = {"high": (6, 10), "mid": (3, 6), "low": (0, 3)}  # bits of a row's number, from the lowest on
SIDES = "amp", "reset"
PHASES = ("reset", "pixel_reset"), ("amp", "shutter"), ("amp", "read"), ("amp", "tap0"), ("amp", "tap1")
CONTROLS = "pixel_reset", "shutter", "integrate", "read", "tap0", "tap1", "expose"
ROW_INPUTS = (*(f"{side}_{group}" for side in SIDES for group in GROUPS), *CONTROLS)
ROW_LINES = tuple(f"{name}_row" for name in ("pixel_reset", "shutter", "integrate", "read", "tap0", "tap1"))
SUPPLIES = "vdd", "vddr", "vss"
FAR = 0.01  # of a line's level, from it: settled
SETTLING = 4 / pi**2 * log(4 / (pi * FAR))  # s of a driven line's far end, for each ohm and farad of the whole line
SECTIONS = 32  # of a line's ladder; its delay is within 0.2 % of that of an infinite number
GATE = 1.7e-15  # F, of a pixel's thick-oxide transistor of 1.0 x 0.5 um (`make pixel-circuit`)
THICK = 0.5  # um, shortest gate of thick oxide
PULL, HOLD, HOLD_LENGTH = 3.0, 0.42, 2.0  # um: what must win in a level shifter, and what it wins against
DRIVE = 3.0, 6.0  # um, n and p of what drives a line


@dataclass(frozen=True)
class RowDriverSpec:
    """The specification of a row's driver.

    Attributes
    ----------
    cols : int
        Pixels at a line, 1..100000.
    ohm, farad : float
        Of a line for each, 0.01..1e5 ohm, 1e-17..1e-11 F: metal of the drawn array, as extracted, and two gates.
    supply, high : float
        V of the chip, 1.2..2, and of the lines, 2..5.5; limits hold for 10 % around each, in any combination.
    settle : float
        S from a phase's edge until the line's far end has its level: a cycle, the shortest guard.
    slew : float
        S at the far end from 10 to 90 %.
    idle : float
        A of a row in which nothing changes.
    """

    cols: int = ArrayParameters().cols
    ohm: float = drawn_lines().row_ohm
    farad: float = drawn_lines().row_farad + 2 * GATE
    supply: float = 1.8
    high: float = 5.0
    settle: float = 100e-9
    slew: float = 50e-9
    idle: float = 1e-6

    def __post_init__(self) -> None:
        check_int("cols", self.cols, 1, 100_000)
        check_real("ohm", self.ohm, 0.01, 1e5)
        check_real("farad", self.farad, 1e-17, 1e-11)
        check_real("supply", self.supply, 1.2, 2.0)
        check_real("high", self.high, 2.0, 5.5)
        for name in ("settle", "slew"):
            check_real(name, getattr(self, name), 1e-12, 1e-3)
        check_real("idle", self.idle, 1e-12, 1e-3)

    @classmethod
    def of(cls, sensor: SensorParameters | None = None) -> Self:
        """Return the specification for a sensor: columns and pitch of its array, the cycle of its chip.

        Raises ParameterError for a row whose lines alone do not settle within a cycle.
        """
        sensor = sensor or SensorParameters()
        array, cycle = sensor.array, 1 / sensor.chip.f_clk
        lines = drawn_lines(array.pitch_um)
        ohm, farad = lines.row_ohm, lines.row_farad + 2 * GATE
        if array.cols > (most := int((cycle / (SETTLING * ohm * farad)) ** 0.5)):
            raise ParameterError(
                f"array.cols = {array.cols}: must be at most {most} for a row's lines to settle in a cycle "
                f"(array.pitch = {array.pitch:g}, chip.f_clk = {sensor.chip.f_clk:g})"
            )
        return cls(cols=array.cols, ohm=ohm, farad=farad, settle=cycle, slew=cycle / 2)


def row_line(spec: RowDriverSpec) -> Circuit:
    """Return a line as a ladder of T sections. Pins near far vss."""
    ohm, farad = spec.ohm * spec.cols / SECTIONS, spec.farad * spec.cols / SECTIONS
    nodes = ["near", *(f"n{k}" for k in range(1, SECTIONS)), "far"]
    resistors, capacitors = [], []
    for k, (a, b) in enumerate(zip(nodes, nodes[1:], strict=False)):
        resistors += [Resistor(f"a{k}", a, f"m{k}", ohm / 2), Resistor(f"b{k}", f"m{k}", b, ohm / 2)]
        capacitors.append(Capacitor(f"c{k}", f"m{k}", "vss", farad))
    return Circuit("row_line", ("near", "far", "vss"), (), tuple(capacitors), tuple(resistors))


def nand_of(inputs: int) -> Circuit:
    """Pins a b c ... y vdd vss: 2 to 4 inputs."""
    check_int("inputs", inputs, 2, 4)
    names = "abcd"[:inputs]
    nodes = ["y", *(f"m{k}" for k in range(1, inputs)), "vss"]
    w = 2 * UNIT
    return Circuit(
        f"nand{inputs}",
        (*names, "y", "vdd", "vss"),
        (
            *(Transistor(f"n{a}", nodes[k], a, nodes[k + 1], "vss", "n", w, LENGTH) for k, a in enumerate(names)),
            *(Transistor(f"p{a}", "y", a, "vdd", "vdd", "p", w, LENGTH) for a in names),
        ),
    )


def lift() -> Circuit:
    """A level shifter and the line's driver. Pins a line vdd vddr vss; the line is at vddr where a is at vdd."""

    def n(name: str, drain: str, gate: str, source: str, w: float) -> Transistor:
        return Transistor(name, drain, gate, source, "vss", "n_thick", w, THICK)

    def p(name: str, drain: str, gate: str, w: float, length: float) -> Transistor:
        return Transistor(name, drain, gate, "vddr", "vddr", "p_thick", w, length)

    return Circuit(
        "lift",
        ("a", "line", *SUPPLIES),
        (
            n("na", "low", "a", "vss", PULL),
            n("nb", "high", "vdd", "a", PULL),
            p("pa", "low", "high", HOLD, HOLD_LENGTH),
            p("pb", "high", "low", HOLD, HOLD_LENGTH),
            n("n", "line", "low", "vss", DRIVE[0]),
            p("p", "line", "low", DRIVE[1], THICK),
        ),
    )


def row() -> Circuit:
    """All of a row. Pins ROW_INPUTS, ROW_LINES, SUPPLIES."""
    rails = "vdd", "vss"
    parts = []
    for side in SIDES:
        lines = (f"{side}_{group}" for group in GROUPS)
        parts.append(Instance(f"{side}_n", nand_of(3), (*lines, f"{side}_off", *rails)))
        parts.append(Instance(f"{side}_s", inverter(2), (f"{side}_off", f"{side}_on", *rails)))
    for side, phase in PHASES:
        parts.append(Instance(f"{phase}_n", nand(), (f"{side}_on", phase, f"{phase}_off", *rails)))
        parts.append(Instance(f"{phase}_s", inverter(2), (f"{phase}_off", f"{phase}_on", *rails)))
    parts += [
        Instance("expose_n", nand(), ("reset_on", "expose", "expose_off", *rails)),
        Instance("integrate_n", nand(), ("amp_on", "integrate", "integrate_off", *rails)),
        Instance("open_s", nand(), ("expose_off", "closed", "open", *rails)),
        Instance("open_n", nand_of(3), ("pixel_reset_off", "integrate_off", "open", "closed", *rails)),
        Instance("integrate_s", nand(2), ("closed", "integrate_off", "integrate_on", *rails)),
    ]
    parts += [
        Instance(f"{line.removesuffix('_row')}_l", lift(), (f"{line.removesuffix('_row')}_on", line, *SUPPLIES))
        for line in ROW_LINES
    ]
    return Circuit("row", (*ROW_INPUTS, *ROW_LINES, *SUPPLIES), instances=tuple(parts))


ADDRESS = 10  # bits
CODES = {"high": 6, "mid": 8, "low": 8}  # lines of a group: the highest of 384 rows is in the sixth group of 64
BANK_INPUTS = (*(f"{side}_row{bit}" for side in SIDES for bit in range(ADDRESS)), *CONTROLS, "ref_ctl")
LATE, LATE_LENGTH = 4, 1.0  # slow inverters, um of their gates: `read` comes after `ref_ctl`, with which it rises
BANK_OUTPUTS = (
    *(f"{side}_{group}{code}" for side in SIDES for group, count in CODES.items() for code in range(count)),
    *(f"{name}_line" for name in CONTROLS),
)


def bank() -> Circuit:
    """Return the drivers of the lines that cross all rows: predecoders of both addresses, buffers of the controls.

    Pins BANK_INPUTS, BANK_OUTPUTS, vdd vss. `<side>_<group><code>` is high where the group's bits are the code.
    `read_line` waits for the end of `ref_ctl`: until then the columns are reset, and what a well gave is lost.
    """
    rails, parts = ("vdd", "vss"), list[Instance]()
    for side in SIDES:
        for bit in range(ADDRESS):
            parts.append(Instance(f"{side}_i{bit}", inverter(2), (f"{side}_row{bit}", f"{side}_row{bit}n", *rails)))
        for group, (first, last) in GROUPS.items():
            for code in range(CODES[group]):
                bits = (f"{side}_row{first + k}{'' if code >> k & 1 else 'n'}" for k in range(last - first))
                name = f"{side}_{group}{code}"
                parts.append(Instance(f"{name}_n", nand_of(last - first), (*bits, f"{name}n", *rails)))
                parts.append(Instance(f"{name}_s", inverter(6), (f"{name}n", name, *rails)))
    parts.append(Instance("ref_ctl_n", inverter(), ("ref_ctl", "ref_ctln", *rails)))
    late = ["read", *(f"read_late{k}" for k in range(LATE))]
    for k, (a, y) in enumerate(pairwise(late)):
        parts.append(Instance(f"read_l{k}", inverter(1, LATE_LENGTH), (a, y, *rails)))
    for name in CONTROLS:
        kind, *inputs = (nand(3), late[-1], "ref_ctln") if name == "read" else (inverter(3), name)
        parts.append(Instance(f"{name}_n", kind, (*inputs, f"{name}n", *rails)))
        parts.append(Instance(f"{name}_s", inverter(12), (f"{name}n", f"{name}_line", *rails)))
    return Circuit("row_bank", (*BANK_INPUTS, *BANK_OUTPUTS, *rails), instances=tuple(parts))


def taken(row: int) -> dict[str, int]:
    """Return the code of each group that a row takes."""
    return {group: row >> first & (1 << last - first) - 1 for group, (first, last) in GROUPS.items()}
