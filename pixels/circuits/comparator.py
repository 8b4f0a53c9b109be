"""The clocked comparator: a strong-arm latch, sized by its offset, and the latch that holds its decision.

Pins of `comparator`: inp inn strobe q vdd vss. While strobe is low both outputs of the strong-arm latch rest at vdd
and q keeps its value; after strobe's rise q is 1 where V(inp) > V(inn). `strong_arm` alone: inp inn strobe outp outn
vdd vss.
"""

from dataclasses import dataclass
from math import ceil
from types import ModuleType

from talbot.models.parameters import check_real
from talbot.pixels.circuits.gates import inverter, nor
from talbot.pixels.circuits.netlist import Circuit, Instance, Transistor
from talbot.pixels.circuits.specification import LaneSpec

PAIR_SHARE = 0.5  # of the offset's variance for the input pair; the latch behind it has the rest
INPUT_LENGTH = 0.5  # um: at 0.15 um the same area is three times as wide, and its drains take the energy
LATCH_LENGTH = 0.25  # um, of tail and latch: at 0.15 um they leak 4 uA at ff, 125 degrees, 1.98 V
GATE_CAPACITANCE = 8.3e-15  # F/um2, oxide of 4.148 nm


@dataclass(frozen=True)
class ComparatorSizes:
    """Widths and lengths, 0.15..100 um. role: of the input pair."""

    input_w: float
    input_l: float = INPUT_LENGTH
    tail_w: float = 1.0
    latch_n_w: float = 16.0
    latch_p_w: float = 4.0
    precharge_w: float = 2.0
    role: str = "n_lvt"

    def __post_init__(self) -> None:
        for name in ("input_w", "input_l", "tail_w", "latch_n_w", "latch_p_w", "precharge_w"):
            check_real(name, getattr(self, name), 0.15, 100)

    @property
    def input_capacitance(self) -> float:
        """F, about: the oxide of one input transistor."""
        return GATE_CAPACITANCE * self.input_w * self.input_l


def size(spec: LaneSpec, process: ModuleType, attenuation: float = 1.0) -> ComparatorSizes:
    """Sizes for the offset of ``spec``. attenuation: of the lane's input up to the comparator's, 0..1.

    Pelgrom: the pair's offset is sqrt(2) A / sqrt(w l) with the process's A of a gate-source voltage.
    """
    check_real("attenuation", attenuation, 0.05, 1)
    allowed = 1e3 * spec.offset * spec.lsb * attenuation * PAIR_SHARE**0.5  # mV
    area = 2 * (process.AREA[ComparatorSizes.role] / allowed) ** 2
    return ComparatorSizes(input_w=ceil(2 * area / INPUT_LENGTH) / 2)


def strong_arm(sizes: ComparatorSizes) -> Circuit:
    """Pins inp inn strobe outp outn vdd vss; outn falls where V(inp) > V(inn)."""
    s = sizes
    pair = (s.role, s.input_w, s.input_l)
    latch_n, latch_p, reset = (
        (role, w, LATCH_LENGTH) for role, w in (("n", s.latch_n_w), ("p", s.latch_p_w), ("p", s.precharge_w))
    )
    return Circuit(
        "strong_arm",
        ("inp", "inn", "strobe", "outp", "outn", "vdd", "vss"),
        (
            Transistor("tail", "tail", "strobe", "vss", "vss", "n", s.tail_w, LATCH_LENGTH),
            Transistor("inp", "xp", "inp", "tail", "vss", *pair),
            Transistor("inn", "xn", "inn", "tail", "vss", *pair),
            Transistor("latch_np", "outn", "outp", "xp", "vss", *latch_n),
            Transistor("latch_nn", "outp", "outn", "xn", "vss", *latch_n),
            Transistor("latch_pp", "outn", "outp", "vdd", "vdd", *latch_p),
            Transistor("latch_pn", "outp", "outn", "vdd", "vdd", *latch_p),
            Transistor("reset_outn", "outn", "strobe", "vdd", "vdd", *reset),
            Transistor("reset_outp", "outp", "strobe", "vdd", "vdd", *reset),
            Transistor("reset_xp", "xp", "strobe", "vdd", "vdd", *reset),
            Transistor("reset_xn", "xn", "strobe", "vdd", "vdd", *reset),
        ),
    )


def comparator(sizes: ComparatorSizes) -> Circuit:
    """Pins inp inn strobe q vdd vss.

    Inverters are between the strong-arm latch and the one that holds q: a gate whose other input is q loads its input
    by what q is, and the decision before would shift the next by 0.2 LSB.
    """
    arm, gate, buffer = strong_arm(sizes), nor(), inverter()
    return Circuit(
        "comparator",
        ("inp", "inn", "strobe", "q", "vdd", "vss"),
        instances=(
            Instance("arm", arm, ("inp", "inn", "strobe", "outp", "outn", "vdd", "vss")),
            Instance("buffer_n", buffer, ("outn", "set", "vdd", "vss")),
            Instance("buffer_p", buffer, ("outp", "clear", "vdd", "vss")),
            Instance("hold_n", gate, ("set", "q", "qn", "vdd", "vss")),
            Instance("hold", gate, ("clear", "qn", "q", "vdd", "vss")),
        ),
    )
