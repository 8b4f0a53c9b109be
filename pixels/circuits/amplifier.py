"""The difference amplifier of a lane: switched capacitors, with a 10-bit trim of the second diode's.

Pins of `amplifier`: column_a column_b wake reset g9 .. g0 mode1 mode0 sub0 out vref ibias vdd vss.

    clk        |‾|______|‾|______|‾|______|
    wake       |_/‾‾‾‾‾‾|_________________     the chip's: D of `hold`
    on         |_/‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾|________     inside: from `wake` on, until the reset begins again
    hold       |________|‾‾‾‾‾‾‾‾|________
    reset      |‾‾‾‾‾‾‾‾|________|‾‾‾‾‾‾‾‾     not hold, of the lane's interface
    columns    | reference | signal |          2 ns after the reset's end
    sample     |__________|__‾‾‾‾‾‾|           of the lane: its array is at `out` after its last decision

While reset is 1 the columns carry their reference level and the amplifier is a follower at vref: its offset, and the
columns' level, are stored. After its fall the columns go to their signals, a and b below that level, and

    out - vref = (Ca a - Cb b) / Cf,    Ca = 512 units, Cb = code of g9..g0, Cf = 512 / gain

The code is the register `balance` with its top bit inverted: g = Cb / Ca = code / 512. Units of Cb that are off stand
at vref, so that both inputs see the same total; what both columns have in common moves both inputs alike. `ibias`
takes BIAS amperes while `on` is 1, from the `bias` of support.py; while it is 0 no current flows.

In raw mode (mode1 and not mode0) half of Ca takes one diode's column, a or, where sub0 is 1, b; Cb and the other half
are at vref. A full well is the converter's whole range then: out - vref = (Ca / 2) a / Cf.
"""

from dataclasses import dataclass
from math import ceil, log
from types import ModuleType
from typing import Self

from talbot.models.parameters import EnergyParameters, SensorParameters, check_int, check_real
from talbot.pixels.circuits.gates import inverter, nand, nor
from talbot.pixels.circuits.netlist import Capacitor, Circuit, Instance, Transistor
from talbot.pixels.circuits.specification import one_digit

TRIM_BITS = 10
UNITS = 512  # of the first diode's capacitor
BIAS = 10e-6  # A
PICK = "mode1", "mode0", "sub0"  # of the chip: which diodes the amplifier takes
PINS = ("column_a", "column_b", "wake", "reset", *(f"g{k}" for k in reversed(range(TRIM_BITS))), *PICK)
PINS += ("out", "vref", "ibias", "vdd", "vss")
PAIR_PARTS = 2  # transistors in each of them
RANGE = 192.0  # LSB between the ends of three quarters of the range
SPLIT = 4  # parts of the pair: one steers the sinks, the others are at the folding
SINKS = 5  # times its diode, each sink
AWAKE = 0.18  # of the tail while the amplifier is reset: its load is not at the output then
LEG = 2  # times BIAS: the legs that drive the tail's gate, and after it the n cascodes', which have to be fast
# Roles and lengths (um): the pair, its tail, the sinks and legs, the cascodes, the mirror
PAIR, TAIL, SINK, LEGS = ("p_lvt", 0.5), ("p", 0.5), ("n_lvt", 0.5), ("n_lvt", 1.0)
CASCODE, CASCODE_P, TOP = ("n_lvt", 0.5), ("p_lvt", 0.5), ("p", 0.5)
STACK, TRIODE = 3.0, 8.0  # cascode's gate: parts of the sinks' and cascodes' widths; the lower is in triode
STACK_P = (3.0, ("p_lvt", 2.0))  # the diode that makes the p cascodes' gate
UNIT, CELLS, GAIN = 2.3499e-15, 3, 2.4  # F, of CELLS fringe cells; gain from a column's volts to the lane's
# Transconductance over current, 1/V: high where it is what is wanted, low where matching or a drain's level is
EFFICIENCY = {"pair": 13.6, "tail": 9.0, "sink": 15.3, "cascode": 18.7, "top": 12.0, "cascode_p": 12.0, "leg": 12.0}
SLEW = 10e-9  # s of the signal's time in which the output's current is at its limit
LEFT = 0.03  # of the specification's rest, at the typical corner: others are slower
LATE, LATE_UM = 4, 1.0  # inverters by which `wake` may end before the reset does, and the length of their gates
PICK_W = 24.0  # um, n transistor of the switches that pick a diode
STRAY = 0.3e-12  # F at the output in addition to the lane's array


@dataclass(frozen=True)
class AmplifierSpec:
    """The amplifier's specification.

    Attributes
    ----------
    vref : float
        V of its output's zero and of lane_b, 0.3..1.5.
    reset_level : float
        V of a column without light, 0.3..1.8.
    swing : float
        V of a full well, 0.01..1.5.
    hold : float
        S, a cycle of the chip: the time for its output.
    wake : float
        S from the cycle's start until `wake` is there.
    track : float
        S from the cycle's start until the lane's array, after its last decision, connects to the output.
    settling : float
        LSB that may remain at the cycle's end.
    gain : float
        Relative error, common to all columns of a lane.
    inl : float
        LSB, peak, over three quarters of the range.
    ktc : float
        LSB, rms, of the charge that the reset's end leaves.
    ambient : float
        LSB by which a difference may change where ambient light is 100 times it.
    trim : float
        Steps, peak error of a step of the trim.
    offset : float
        LSB, rms over lanes.
    noise : float
        LSB, rms, of both phases, as much as a decision may have.
    energy : float
        J a sample, Table 6.1's to one digit.
    sample : float
        S between two samples of a lane at the table's frame rate.
    lanes : int
        Number that share a bias, 1..32.
    """

    vref: float = 0.8
    reset_level: float = 1.2
    swing: float = 1.0
    hold: float = 100e-9
    wake: float = 12e-9
    track: float = 17e-9
    settling: float = 0.5
    gain: float = 0.05
    inl: float = 0.5
    ktc: float = 0.15
    ambient: float = 0.5
    trim: float = 1.0
    offset: float = 1.0
    noise: float = 0.25
    energy: float = 200e-12
    sample: float = 1.8e-6
    lanes: int = 8

    def __post_init__(self) -> None:
        check_real("vref", self.vref, 0.3, 1.5)
        check_real("reset_level", self.reset_level, 0.3, 1.8)
        check_real("swing", self.swing, 0.01, 1.5)
        check_real("hold", self.hold, 1e-9, 1e-3)
        check_real("wake", self.wake, 0, self.hold)
        check_real("track", self.track, self.wake, self.hold)
        check_real("gain", self.gain, 1e-3, 1)
        for name in ("settling", "inl", "ktc", "ambient", "trim", "offset", "noise"):
            check_real(name, getattr(self, name), 0.01, 16)
        check_real("energy", self.energy, 1e-15, 1e-6)
        check_real("sample", self.sample, 3 * self.hold, 1.0)
        check_int("lanes", self.lanes, 1, 32)

    @classmethod
    def of(cls, sensor: SensorParameters | None = None, energy: EnergyParameters | None = None) -> Self:
        """Return the amplifier of a sensor: its swing, the chip's clock, Table 6.1's power and frame rate."""
        sensor, energy = sensor or SensorParameters(), energy or EnergyParameters()
        rate = energy.frame_rate * energy.pixels
        return cls(
            swing=sensor.electrical.swing,
            hold=1 / sensor.chip.f_clk,
            energy=one_digit(energy.amplifiers / rate),
            sample=sensor.chip.lanes / rate,
            lanes=sensor.chip.lanes,
        )


@dataclass(frozen=True)
class OtaSizes:
    """Currents and widths of a side of the operational amplifier; widths in um, 0.42..2000.

    tails: parts of the tail, 1..1000, each with a current of LEG BIAS.
    pair: all parts of the input pair.
    tail: a part of the tail.
    sink: all parts of a sink.
    cascode, top, cascode_p: of these transistors.
    leg: the diode of BIAS.
    """

    tails: int
    pair: float
    tail: float
    sink: float
    cascode: float
    top: float
    cascode_p: float
    leg: float

    def __post_init__(self) -> None:
        check_int("tails", self.tails, 1, 1000)
        for name in ("pair", "tail", "sink", "cascode", "top", "cascode_p", "leg"):
            check_real(name, getattr(self, name), 0.42, 2000)


@dataclass(frozen=True)
class AmplifierSizes:
    """Sizes of the amplifier.

    unit: F, of a capacitor of ``cells`` cells.
    gain: of a column's voltage, 0.1..16.
    """

    ota: OtaSizes
    unit: float = UNIT
    gain: float = GAIN
    cells: int = CELLS

    def __post_init__(self) -> None:
        check_real("unit", self.unit, 1e-16, 1e-13)
        check_real("gain", self.gain, 0.1, 16)
        check_int("cells", self.cells, 1, 100)

    @property
    def feedback(self) -> float:
        """Capacitance of Cf in units."""
        return UNITS / self.gain


def size(spec: AmplifierSpec, load: float, process: ModuleType) -> AmplifierSizes:
    """Sizes for ``spec`` with ``load`` F, the lane's array, from the process's tables of gm/Id.

    The output has the signal's time without SLEW to come within LEFT of the allowed residue, in time constants
    C / (beta gm). A recycling folded cascode has 1 + (SPLIT - 1) / SPLIT times the transconductance of one side of its
    pair [Assaad2009]. Widths are currents over the densities at which each role has its EFFICIENCY.
    """
    feedback = UNITS / GAIN * UNIT
    inputs = (2 * UNITS + UNITS / GAIN) * UNIT
    constant = (spec.hold - spec.track - SLEW) / log(RANGE / (LEFT * spec.settling))
    pair = process.operating(*PAIR, EFFICIENCY["pair"])
    beta, current = feedback / inputs, 0.0
    for _ in range(20):
        gm = (load + STRAY + feedback * (1 - beta)) / (beta * constant)
        current = gm / (1 + (SPLIT - 1) / SPLIT) / EFFICIENCY["pair"]
        beta = feedback / (inputs + current / pair.density * pair.gate)

    def width(name: str, kind: tuple[str, float], amperes: float) -> float:
        return max(0.42, _drawn(amperes / process.operating(*kind, EFFICIENCY[name]).density))

    branch = current / SPLIT
    ota = OtaSizes(
        ceil(2 * current / (LEG * BIAS)),
        SPLIT * PAIR_PARTS * _drawn(width("pair", PAIR, current) / (SPLIT * PAIR_PARTS)),
        width("tail", TAIL, LEG * BIAS),
        width("sink", SINK, current / SPLIT),
        width("cascode", CASCODE, branch),
        width("top", TOP, branch),
        width("cascode_p", CASCODE_P, branch),
        width("leg", LEGS, BIAS),
    )
    return AmplifierSizes(ota)


def _drawn(um: float) -> float:
    """The width nearest to ``um`` of an even number of fingers of at most 5 um on a grid of 0.01 um; one below 2 um."""
    step = 0.01 * (2 * ceil(um / 10) if um >= 2 else 1)
    return round(round(um / step) * step, 3)


def _n(name: str, nodes: str, w: float, kind: tuple[str, float], parts: int = 1) -> list[Transistor]:
    """Return ``parts`` parallel n transistors of ``w`` um. nodes: drain gate source."""
    return _parts(name, (*nodes.split(), "vss"), w, kind, parts)


def _p(name: str, nodes: str, w: float, kind: tuple[str, float], parts: int = 1) -> list[Transistor]:
    """Return ``parts`` parallel p transistors of ``w`` um. nodes: drain gate source."""
    return _parts(name, (*nodes.split(), "vdd"), w, kind, parts)


def _parts(name: str, nodes: tuple[str, ...], w: float, kind: tuple[str, float], parts: int) -> list[Transistor]:
    drain, gate, source, bulk = nodes
    names = [name] if parts == 1 else [f"{name}_{k}" for k in range(parts)]
    return [Transistor(part_name, drain, gate, source, bulk, kind[0], _drawn(w), kind[1]) for part_name in names]


def ota(sizes: OtaSizes) -> Circuit:
    """Return a recycling folded cascode with p inputs. Pins: inp inn out ibias on off reset resetn vdd vss.

    A part of each side of the pair drives the diodes of the other side's sink: no second current has to fit the
    tail's, whatever the supply, and all currents end with the tail's. The diodes are cascoded as the sinks are. The
    mirror's upper transistors are of the regular threshold, so that its cascode stays saturated in the branch where
    the mirror's gate is its drain.
    """
    s, part, awake = sizes, sizes.pair / SPLIT / PAIR_PARTS, max(1, round(AWAKE * sizes.tails))
    small = ("n_lvt", 0.15)
    devices = [
        # Off: the bias is not taken, and the gates of its mirrors are at their rails
        *_n("take", "ibias on vbn", 4, small),
        *_n("off_n", "vbn off vss", 1, small),
        *_n("off_cascode", "vcn off vss", 1, small),
        *_p("off_p", "vbp on vdd", 2, ("p_lvt", 0.35)),
        # Mirrors of ibias, and a stack's worth of overdrive for each cascode's gate
        *_n("bias_n", "vbn vbn vss", s.leg, LEGS),
        *_n("bias_to_p", "vbp vbn vss", s.leg, LEGS, LEG),
        *_p("bias_p", "vbp vbp vdd", s.tail, TAIL),
        *_p("bias_to_n", "vcn vbp vdd", s.tail, TAIL),
        *_n("stack_n", "vcn vcn stack", LEG * s.cascode / STACK, CASCODE),
        *_n("stack_low", "stack vcn vss", max(0.42, LEG * s.sink / STACK / TRIODE), SINK),
        *_n("bias_to_pc", "vcp vbn vss", s.leg / 2, LEGS),
        *_p("cascode_p", "vcp vcp vdd", *STACK_P),
        # A part of the tail is on with the amplifier, the others not before the reset's end
        *_p("tail", "tail vbp vdd", s.tail, TAIL, awake),
        *_p("boost", "boost vbp vdd", s.tail, TAIL, s.tails - awake),
        *_p("boost_on", "tail reset boost", 20, ("p_lvt", 0.35), 2),
    ]
    for side, other in (("p", "n"), ("n", "p")):
        devices += [
            *_p(f"in{side}", f"fold_{side} in{side} tail", part, PAIR, PAIR_PARTS * (SPLIT - 1)),
            *_p(f"in{side}_steer", f"steer_{other} in{side} tail", part, PAIR, PAIR_PARTS),
            *_n(f"diode_cascode_{side}", f"steer_{side} vcn diode_{side}", s.cascode, CASCODE),
            *_n(f"diode_{side}", f"diode_{side} steer_{side} vss", s.sink, SINK),
            *_n(f"sink_{side}", f"fold_{side} steer_{side} vss", s.sink, SINK, SINKS),
        ]
    devices += [
        *_n("up_p", "mirror vcn fold_p", s.cascode, CASCODE),
        *_n("up_n", "out vcn fold_n", s.cascode, CASCODE),
        # Cascoded mirror
        *_p("top_p", "high_p mirror vdd", s.top, TOP),
        *_p("top_n", "high_n mirror vdd", s.top, TOP),
        *_p("down_p", "mirror vcp high_p", s.cascode_p, CASCODE_P),
        *_p("down_n", "out vcp high_n", s.cascode_p, CASCODE_P),
    ]
    pins = ("inp", "inn", "out", "ibias", "on", "off", "reset", "resetn", "vdd", "vss")
    return Circuit("ota", pins, tuple(devices))


def _selector(width: float) -> Circuit:
    """Pins: bottom column on off vref vdd vss; on (off its inverse) connects the column, else vref."""
    return Circuit(
        f"selector_w{round(100 * width)}",
        ("bottom", "column", "on", "off", "vref", "vdd", "vss"),
        (
            Transistor("n", "bottom", "on", "column", "vss", "n_lvt", width, 0.15),
            Transistor("p", "bottom", "off", "column", "vdd", "p_lvt", 2 * width, 0.35),
            Transistor("r", "bottom", "off", "vref", "vss", "n_lvt", width, 0.15),
        ),
    )


def pick() -> Circuit:
    """Return what connects the columns. Pins: column_a column_b mode1 mode0 sub0 whole half trim vref vdd vss.

    whole, half: the two parts of Ca; trim: the side of Cb's switches that is the column's. In raw mode half is at a
    column and the others are at vref, else half is at vref.
    """
    supplies = ("vdd", "vss")

    def through(name: str, a: str, b: str, on: str, off: str, w: float) -> tuple[Transistor, Transistor]:
        return (
            Transistor(f"{name}_n", a, on, b, "vss", "n_lvt", w, 0.15),
            Transistor(f"{name}_p", a, off, b, "vdd", "p_lvt", 2 * w, 0.35),
        )

    def rest(name: str, on: str, w: float) -> Transistor:
        return Transistor(f"{name}_r", name, on, "vref", "vss", "n_lvt", w, 0.15)

    gates = (
        Instance("not_mode", inverter(), ("mode0", "mode0n", *supplies)),
        Instance("plain", nand(2), ("mode1", "mode0n", "plain", *supplies)),
        Instance("raw", inverter(4), ("plain", "raw", *supplies)),
        Instance("not_sub", inverter(), ("sub0", "sub0n", *supplies)),
        Instance("nand_first", nand(2), ("raw", "sub0n", "firstn", *supplies)),
        Instance("drive_first", inverter(2), ("firstn", "first", *supplies)),
        Instance("nand_second", nand(2), ("raw", "sub0", "secondn", *supplies)),
        Instance("drive_second", inverter(2), ("secondn", "second", *supplies)),
    )
    return Circuit(
        "pick",
        ("column_a", "column_b", *PICK, "whole", "half", "trim", "vref", *supplies),
        (
            *through("whole", "whole", "column_a", "plain", "raw", PICK_W),
            *through("trim", "trim", "column_b", "plain", "raw", PICK_W),
            *through("first", "half", "column_a", "first", "firstn", PICK_W / 2),
            *through("second", "half", "column_b", "second", "secondn", PICK_W / 2),
            rest("whole", "raw", PICK_W / 2),
            rest("trim", "raw", PICK_W / 2),
            rest("half", "plain", PICK_W / 2),
        ),
        instances=gates,
    )


def amplifier(sizes: AmplifierSizes, chip: bool = False) -> Circuit:
    """Pins as PINS. chip: g9..g0 are the chip's `balance`, whose top bit is inverted."""
    u = sizes.unit
    capacitors = [
        Capacitor("a", "xm", "whole", UNITS * u, UNITS),
        Capacitor("a_half", "xm", "half", UNITS / 2 * u, UNITS // 2),
        Capacitor("a_rest", "xm", "vref", UNITS / 2 * u, UNITS // 2),
        Capacitor("f", "xm", "out", sizes.feedback * u, round(sizes.feedback)),
        Capacitor("b_rest", "xp", "vref", (sizes.feedback + 1) * u, round(sizes.feedback)),
    ]
    instances = [
        Instance("ota", ota(sizes.ota), ("xp", "xm", "out", "ibias", "on", "off", "reset", "resetn", "vdd", "vss")),
        Instance("on_n", inverter(2), ("on", "off", "vdd", "vss")),
        Instance("reset_n", inverter(4), ("reset", "resetn", "vdd", "vss")),
        Instance("pick", pick(), pick().ports),
        *(
            Instance(f"late{k}", inverter(1, LATE_UM), (f"wake_{k}" if k else "wake", f"wake_{k + 1}", "vdd", "vss"))
            for k in range(LATE)
        ),
        Instance("asleep", nor(), ("wake", f"wake_{LATE}", "asleep", "vdd", "vss")),
        Instance("awake", nand(3), ("asleep", "reset", "on", "vdd", "vss")),
    ]
    for k in range(TRIM_BITS):
        units = 1 << k
        capacitors.append(Capacitor(f"b{k}", "xp", f"bottom{k}", units * u, units))
        instances.append(Instance(f"not{k}", inverter(), (f"g{k}", f"g{k}n", "vdd", "vss")))
        chosen = _selector(max(0.5, units / 32))
        on, off = (f"g{k}n", f"g{k}") if chip and k == TRIM_BITS - 1 else (f"g{k}", f"g{k}n")
        nodes = (f"bottom{k}", "trim", on, off, "vref", "vdd", "vss")
        instances.append(Instance(f"select{k}", chosen, nodes))
    switches = tuple(
        Transistor(name, a, gate, b, bulk, role, w, length)
        for name, a, b, gate, bulk, role, w, length in (
            ("follow_n", "xm", "out", "reset", "vss", "n", 2.0, 0.15),
            ("follow_p", "xm", "out", "resetn", "vdd", "p_lvt", 10.0, 0.5),
            # While it is off its output stands at vref: it wakes there
            ("rest_n", "out", "vref", "off", "vss", "n", 2.0, 0.15),
            ("rest_p", "out", "vref", "on", "vdd", "p_lvt", 10.0, 0.35),
            ("zero_n", "xp", "vref", "reset", "vss", "n", 2.0, 0.15),
            ("zero_p", "xp", "vref", "resetn", "vdd", "p_lvt", 10.0, 0.5),
        )
    )
    return Circuit("amplifier", PINS, switches, tuple(capacitors), instances=tuple(instances))
