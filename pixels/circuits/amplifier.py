"""The difference amplifier of a lane: switched capacitors, with a 10-bit trim of the second diode's.

Pins of `amplifier`: column_a column_b reset g9 g8 g7 g6 g5 g4 g3 g2 g1 g0 out vref ibias vdd vss.

While reset is 1 the columns carry their reference level and the amplifier is a follower at vref: its offset, and the
columns' level, are stored. After its fall the columns go to their signals, a and b below that level, and

    out - vref = (Ca a - Cb b) / Cf,    Ca = 512 units, Cb = code of g9..g0, Cf = 512 / gain

The code is the register `balance` with its top bit inverted: g = Cb / Ca = code / 512. Units of Cb that are off stand
at vref, so that both inputs see the same total; what both columns have in common moves both inputs alike. `ibias`
takes BIAS amperes from outside.
"""

from dataclasses import dataclass
from typing import Self

from talbot.models.parameters import EnergyParameters, SensorParameters, check_real

from .gates import inverter
from .netlist import Capacitor, Circuit, Instance, Transistor

TRIM_BITS = 10
UNITS = 512  # of the first diode's capacitor
BIAS = 10e-6  # A
PINS = ("column_a", "column_b", "reset", *(f"g{k}" for k in reversed(range(TRIM_BITS))))
PINS += ("out", "vref", "ibias", "vdd", "vss")


@dataclass(frozen=True)
class AmplifierSpec:
    """What the amplifier must do.

    vref: V, its output's zero, and lane_b, 0.3..1.5. reset_level: V of a column without light, 0.3..1.8. swing: V of a
    full well, 0.01..1.5. hold: s, one cycle of the chip: the time for its output. settling: LSB that may be left then.
    gain: relative, by which it may be off: common to all columns of a lane. inl: LSB, peak, over three quarters of the
    range. ktc: LSB, rms, of what the reset's end leaves. ambient: LSB by which a difference may change where ambient
    light is 100 times it. trim: steps, peak error of a step of the trim. energy: J a sample, Table 6.1's.
    """

    vref: float = 0.8
    reset_level: float = 1.2
    swing: float = 1.0
    hold: float = 100e-9
    settling: float = 0.5
    gain: float = 0.05
    inl: float = 0.5
    ktc: float = 0.15
    ambient: float = 0.5
    trim: float = 1.0
    energy: float = 203e-12

    def __post_init__(self) -> None:
        check_real("vref", self.vref, 0.3, 1.5)
        check_real("reset_level", self.reset_level, 0.3, 1.8)
        check_real("swing", self.swing, 0.01, 1.5)
        check_real("hold", self.hold, 1e-9, 1e-3)
        check_real("gain", self.gain, 1e-3, 1)
        for name in ("settling", "inl", "ktc", "ambient", "trim"):
            check_real(name, getattr(self, name), 0.01, 16)
        check_real("energy", self.energy, 1e-15, 1e-6)

    @classmethod
    def of(cls, sensor: SensorParameters | None = None, energy: EnergyParameters | None = None) -> Self:
        """The amplifier of a sensor: its swing, the chip's clock, Table 6.1's power."""
        sensor, energy = sensor or SensorParameters(), energy or EnergyParameters()
        return cls(
            swing=sensor.electrical.swing,
            hold=1 / sensor.chip.f_clk,
            energy=energy.amplifiers / (energy.frame_rate * energy.pixels),
        )


@dataclass(frozen=True)
class AmplifierSizes:
    """Sizes; unit: F, of a capacitor. gain: of a column's volts, 0.1..16. scale: of widths and currents, 0.1..1.

    At scale 1 the input pair has 185 uA a side at the typical corner, each output branch 60 uA.
    """

    unit: float = 0.7833e-15
    gain: float = 2.4
    scale: float = 1.0

    def __post_init__(self) -> None:
        check_real("unit", self.unit, 1e-16, 1e-13)
        check_real("gain", self.gain, 0.1, 16)
        check_real("scale", self.scale, 0.1, 1)

    @property
    def feedback(self) -> float:
        """Capacitance of Cf in units."""
        return UNITS / self.gain


def ota(scale: float) -> Circuit:
    """A folded cascode with p inputs. Pins: inp inn out ibias vdd vss; the input range begins at vss.

    Tail and sinks are long: where they are not, the tail's current grows with the supply until the sinks do not carry
    it any more (ff, 1.98 V). The mirror's upper transistors are of the regular threshold, so that its cascode stays
    saturated in the branch where the mirror's gate is its drain (ff, 125 degrees).
    """
    s = scale

    def n(name: str, drain: str, gate: str, source: str, w: float, length: float = 0.5) -> Transistor:
        return Transistor(name, drain, gate, source, "vss", "n_lvt", w, length)

    def p(
        name: str, drain: str, gate: str, source: str, w: float, length: float = 0.5, role: str = "p_lvt"
    ) -> Transistor:
        return Transistor(name, drain, gate, source, "vdd", role, w, length)

    return Circuit(
        "ota",
        ("inp", "inn", "out", "ibias", "vdd", "vss"),
        (
            # Bias: mirrors of ibias, and a stack's worth of overdrive for each cascode's gate
            n("bias_n", "ibias", "ibias", "vss", 3.9, 1.0),
            n("bias_to_p", "vbp", "ibias", "vss", 4.5, 1.0),
            p("bias_p", "vbp", "vbp", "vdd", 10, 1.0),
            p("bias_to_n", "vcn", "vbp", "vdd", 5, 1.0),
            n("cascode_n", "vcn", "vcn", "vss", 1, 2.0),
            n("bias_to_pc", "vcp", "ibias", "vss", 2.25, 1.0),
            p("cascode_p", "vcp", "vcp", "vdd", 3.5, 2.0),
            # Input pair and its tail
            *(p(f"tail_{k}", "tail", "vbp", "vdd", 97 * s, 1.0) for k in range(3)),
            *(p(f"inp_{k}", "fold_p", "inp", "tail", 75 * s, 0.35) for k in range(2)),
            *(p(f"inn_{k}", "fold_n", "inn", "tail", 75 * s, 0.35) for k in range(2)),
            # Folding: each sink carries the pair's and the branch's current
            n("sink_p", "fold_p", "ibias", "vss", 100 * s, 1.0),
            n("sink_n", "fold_n", "ibias", "vss", 100 * s, 1.0),
            n("up_p", "mirror", "vcn", "fold_p", 60 * s),
            n("up_n", "out", "vcn", "fold_n", 60 * s),
            # Cascoded mirror
            p("top_p", "high_p", "mirror", "vdd", 60 * s, 0.5, "p"),
            p("top_n", "high_n", "mirror", "vdd", 60 * s, 0.5, "p"),
            p("down_p", "mirror", "vcp", "high_p", 80 * s),
            p("down_n", "out", "vcp", "high_n", 80 * s),
        ),
    )


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


def amplifier(sizes: AmplifierSizes) -> Circuit:
    """Pins as PINS."""
    u = sizes.unit
    capacitors = [
        Capacitor("a", "xm", "column_a", UNITS * u, UNITS),
        Capacitor("a_rest", "xm", "vref", UNITS * u, UNITS),
        Capacitor("f", "xm", "out", sizes.feedback * u, round(sizes.feedback)),
        Capacitor("b_rest", "xp", "vref", (sizes.feedback + 1) * u, round(sizes.feedback)),
    ]
    instances = [
        Instance("ota", ota(sizes.scale), ("xp", "xm", "out", "ibias", "vdd", "vss")),
        Instance("reset_n", inverter(2), ("reset", "resetn", "vdd", "vss")),
    ]
    for k in range(TRIM_BITS):
        units = 1 << k
        capacitors.append(Capacitor(f"b{k}", "xp", f"bottom{k}", units * u, units))
        instances.append(Instance(f"not{k}", inverter(), (f"g{k}", f"g{k}n", "vdd", "vss")))
        chosen = _selector(max(0.5, units / 64))
        nodes = (f"bottom{k}", "column_b", f"g{k}", f"g{k}n", "vref", "vdd", "vss")
        instances.append(Instance(f"select{k}", chosen, nodes))
    switches = tuple(
        Transistor(name, a, gate, b, bulk, role, w, length)
        for name, a, b, gate, bulk, role, w, length in (
            ("follow_n", "xm", "out", "reset", "vss", "n", 2.0, 0.15),
            ("follow_p", "xm", "out", "resetn", "vdd", "p_lvt", 2.0, 0.35),
            ("zero_n", "xp", "vref", "reset", "vss", "n", 2.0, 0.15),
            ("zero_p", "xp", "vref", "resetn", "vdd", "p_lvt", 2.0, 0.35),
        )
    )
    return Circuit("amplifier", PINS, switches, tuple(capacitors), instances=tuple(instances))
