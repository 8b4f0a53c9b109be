"""The charge-redistribution DAC: eight binary capacitors that sample the input, a terminator, and half a unit.

Pins of `dac`: top in sample samplen d7 d6 d5 d4 d3 d2 d1 d0 refp refn vdd vss. While sample is 1 (samplen 0) the
bottom plates of 256 units are at `in`; afterwards those of bit k are at refp where d_k is 1, else at refn, and the
terminator's at refn. Half a unit samples refp and goes to refn: level(code) = code - 0.5. The top plate moves by
(refn - in + code LSB - LSB / 2) times `attenuation`, whatever is on it as a parasitic: only what it has there when it
is compared and when it sampled must be the same.

`balance` is the other input's array, of the same capacitance: it samples `in` and then is at the middle of the
references, 128 units at each. Pins: top in sample samplen refp refn vdd vss.
"""

from dataclasses import dataclass
from math import ceil
from types import ModuleType

from talbot.models.parameters import ParameterError, check_real
from talbot.pixels.circuits.gates import SWITCH_LENGTH, nand, nor
from talbot.pixels.circuits.netlist import Capacitor, Circuit, Instance, Transistor
from talbot.pixels.circuits.specification import CODES, LaneSpec

BITS = 8
PARASITIC = 0.1  # of the array's capacitance, at its top plate: assumed until there is a layout
WIDTH_PER_PF = 3.0  # um of each switch for a pF; 6.9 time constants are half a cycle at the slowest corner
LOW_SHARE, HIGH_SHARE = 0.5, 3.0  # of that width for refn's and refp's switch: about the same resistance, see `dac`
LEAST_ATTENUATION = 0.8  # below it the comparator's offset counts for too much


@dataclass(frozen=True)
class DacSizes:
    """Sizes of an array.

    unit: F, 1e-16..1e-12.
    unit_mismatch: rms, relative.
    kind, source: capacitor cell and the source of its figures.
    area: m2 of a unit.
    width_per_pf: um of each switch for a pF.
    """

    unit: float
    unit_mismatch: float
    kind: str
    source: str
    area: float
    width_per_pf: float = WIDTH_PER_PF

    def __post_init__(self) -> None:
        check_real("unit", self.unit, 1e-16, 1e-12)
        check_real("unit_mismatch", self.unit_mismatch, 0, 0.2)
        check_real("width_per_pf", self.width_per_pf, 0.1, 1000)

    @property
    def total(self) -> float:
        """Capacitance at the top plate, without parasitics, F."""
        return (CODES + 0.5) * self.unit

    def attenuation(self, load: float) -> float:
        """Volts at the top plate for a volt at the input, with ``load`` F there."""
        return CODES * self.unit / (self.total * (1 + PARASITIC) + load)

    def width(self, units: float) -> float:
        """Return the width (um) of a switch for ``units`` units."""
        return max(0.65, round(units * self.unit * 1e12 * self.width_per_pf / 0.05) * 0.05)


def size(spec: LaneSpec, process: ModuleType, load: float) -> DacSizes:
    """The unit of least area that matches well enough and is not attenuated too much by ``load`` (F, the comparator).

    Raises ParameterError where no cell of the process does.
    """
    least = LEAST_ATTENUATION * load / (CODES - LEAST_ATTENUATION * (CODES + 0.5) * (1 + PARASITIC))  # F a unit
    fitting = []
    for cell in process.unit_cells(spec.unit_mismatch):
        scale = max(1, ceil(least / cell.capacitance))  # more of the same cell side by side
        fitting.append(
            DacSizes(
                cell.capacitance * scale,
                cell.mismatch / scale**0.5,
                cell.kind,
                f"{scale} x {cell.source}" if scale > 1 else cell.source,
                cell.area * scale,
            )
        )
    if not fitting:
        raise ParameterError("unit_cells = none: the process must have a capacitor")
    return min(fitting, key=lambda sizes: sizes.area)


def _switches(name: str, width: float, *, fixed: str = "") -> Circuit:
    """Return the switches of a bottom plate. Pins: bottom in sample samplen d refp refn vdd vss.

    With ``fixed`` (refp or refn) there is no d: the plate samples `in` and then goes to this reference.
    """
    low = "n", max(0.65, round(LOW_SHARE * width / 0.05) * 0.05), SWITCH_LENGTH
    high = "p_lvt", round(HIGH_SHARE * max(width, 0.65) / 0.05) * 0.05, 0.35
    throughs = (
        Transistor("in_n", "bottom", "sample", "in", "vss", "n_lvt", 2 * width, SWITCH_LENGTH),
        Transistor("in_p", "bottom", "samplen", "in", "vdd", "p_lvt", 4 * width, 0.35),
    )
    to_low = Transistor("low", "bottom", "low", "refn", "vss", *low)
    to_high = Transistor("high", "bottom", "high", "refp", "vdd", *high)
    strength = max(1, min(8, round(width / 4)))
    if fixed:
        direct = {"refn": to_low._replace(gate="samplen"), "refp": to_high._replace(gate="sample")}
        ports = ("bottom", "in", "sample", "samplen", "refp", "refn", "vdd", "vss")
        return Circuit(name, ports, (*throughs, direct[fixed]))
    ports = ("bottom", "in", "sample", "samplen", "d", "refp", "refn", "vdd", "vss")
    gates = (
        Instance("off_high", nand(strength), ("samplen", "d", "high", "vdd", "vss")),
        Instance("on_low", nor(strength), ("sample", "d", "low", "vdd", "vss")),
    )
    return Circuit(name, ports, (*throughs, to_low, to_high), instances=gates)


def _half(name: str, width: float) -> Circuit:
    """Half a unit's bottom plate: refp while it samples, then refn. Pins: bottom sample samplen refp refn vdd vss."""
    return Circuit(
        name,
        ("bottom", "sample", "samplen", "refp", "refn", "vdd", "vss"),
        (
            Transistor("low", "bottom", "samplen", "refn", "vss", "n", width, SWITCH_LENGTH),
            Transistor("high", "bottom", "samplen", "refp", "vdd", "p_lvt", 2 * width, 0.35),
        ),
    )


def dac(sizes: DacSizes) -> Circuit:
    """Pins top in sample samplen d7 .. d0 refp refn vdd vss.

    The comparator's kick is over before the capacitors take it through their switches. Where those to refp have another
    resistance than those to refn it differs from the balance's by what the code is: with p transistors of twice the n
    width the decision was 0.26 LSB late at code 8 and 0.69 early at 250.
    """
    bits = [f"d{k}" for k in reversed(range(BITS))]
    supplies, control = ("refp", "refn", "vdd", "vss"), ("in", "sample", "samplen")
    capacitors, instances = [], []
    for k in reversed(range(BITS)):
        units = 1 << k
        capacitors.append(Capacitor(f"bit{k}", "top", f"b{k}", units * sizes.unit, units))
        switches = _switches(f"switch{k}", sizes.width(units))
        instances.append(Instance(f"switch{k}", switches, (f"b{k}", *control, f"d{k}", *supplies)))
    capacitors.append(Capacitor("terminator", "top", "bt", sizes.unit, 1))
    instances.append(
        Instance("switch_t", _switches("switch_t", sizes.width(1), fixed="refn"), ("bt", *control, *supplies))
    )
    capacitors.append(Capacitor("half", "top", "bh", sizes.unit / 2, 1))
    instances.append(Instance("switch_h", _half("switch_h", sizes.width(1)), ("bh", "sample", "samplen", *supplies)))
    capacitors.append(Capacitor("parasitic", "top", "vss", PARASITIC * sizes.total))
    return Circuit("dac", ("top", *control, *bits, *supplies), capacitors=tuple(capacitors), instances=tuple(instances))


def balance(sizes: DacSizes) -> Circuit:
    """Pins top in sample samplen refp refn vdd vss."""
    supplies, control = ("refp", "refn", "vdd", "vss"), ("in", "sample", "samplen")
    capacitors, instances = [], []
    for name in ("refp", "refn"):
        capacitors.append(Capacitor(name, "top", f"b_{name}", CODES / 2 * sizes.unit, CODES // 2))
        switches = _switches(f"balance_{name}", sizes.width(CODES / 2), fixed=name)
        instances.append(Instance(f"switch_{name}", switches, (f"b_{name}", *control, *supplies)))
    capacitors.append(Capacitor("half", "top", "refn", sizes.unit / 2, 1))
    capacitors.append(Capacitor("parasitic", "top", "vss", PARASITIC * sizes.total))
    return Circuit("balance", ("top", *control, *supplies), capacitors=tuple(capacitors), instances=tuple(instances))
