"""Support circuits of the lanes: non-overlapping switch drivers, bias with start-up. Rows have `row_driver`.

`non_overlap`: clk phi1 phi2 vdd vss; phi2 follows clk, phi1 is high while it is low, and both are low in between.
`bias`: ibias vdd vss; BIAS amperes and 8 % leave ibias (the amplifier's pin) at the typical corner. With several
outputs its pins are ibias_0, ibias_1 and so on: lanes convert side by side, each amplifier has a separate current.
"""

from dataclasses import dataclass
from itertools import pairwise

from talbot.models.parameters import check_int, check_real
from talbot.pixels.circuits.gates import inverter, nor
from talbot.pixels.circuits.netlist import Circuit, Instance, Resistor, Transistor

BIAS_OHM, BARS = 46e3, 4  # of the bias, in so many parts: 5.4 uA in each branch at 27 degrees
DELAYS = 4  # inverters in each loop of the switch drivers


@dataclass(frozen=True)
class SupportSpec:
    """Limits and loads of switch drivers and bias.

    gap: s, least between two phases.
    lost: s, longest gap.
    switches: F, 1e-17..1e-9, of the switches on each phase.
    bias: relative error of the current BIAS.
    start: s, longest start-up.
    """

    gap: float = 0.1e-9
    lost: float = 5e-9
    switches: float = 0.2e-12
    bias: float = 0.3
    start: float = 10e-6

    def __post_init__(self) -> None:
        for name in ("gap", "lost", "start"):
            check_real(name, getattr(self, name), 1e-12, 1e-3)
        check_real("bias", self.bias, 0.01, 1)
        check_real("switches", self.switches, 1e-17, 1e-9)


def non_overlap() -> Circuit:
    """Pins clk phi1 phi2 vdd vss."""
    supplies, instances = ("vdd", "vss"), [Instance("not", inverter(), ("clk", "clkn", "vdd", "vss"))]
    for name, start, other in (("phi1", "clk", "phi2"), ("phi2", "clkn", "phi1")):
        nodes = [f"{name}_0", *(f"{name}_{k}" for k in range(1, DELAYS)), name]
        instances.append(Instance(f"{name}_nor", nor(), (start, other, f"{name}_0", *supplies)))
        for k, (a, b) in enumerate(zip(nodes, nodes[1:], strict=False)):
            strength = (1, 2, 6, 12)[k]
            instances.append(Instance(f"{name}_delay{k}", inverter(strength), (a, b, *supplies)))
    return Circuit("non_overlap", ("clk", "phi1", "phi2", *supplies), instances=tuple(instances))


def bias(outputs: int = 1) -> Circuit:
    """The difference of two thresholds, and n kT/q ln 16, over r: a pair of 1 to 16, the wide one of the low threshold.

    The first falls with temperature, the second rises, and so does r: the current is nearly constant. Each of
    ``outputs``, 1..32, has as much as both branches together, and none where it is open. While no current flows,
    `start` is high and draws the mirror's gate down; the current then pulls `start` low.
    """

    def n(name: str, drain: str, gate: str, source: str, w: float, length: float, role: str = "n") -> Transistor:
        return Transistor(name, drain, gate, source, "vss", role, w, length)

    def p(name: str, drain: str, gate: str, w: float, length: float) -> Transistor:
        return Transistor(name, drain, gate, "vdd", "vdd", "p_lvt", w, length)

    check_int("outputs", outputs, 1, 32)
    pins = ("ibias",) if outputs == 1 else tuple(f"ibias_{k}" for k in range(outputs))
    return Circuit(
        "bias",
        (*pins, "vdd", "vss"),
        (
            n("one", "vbn", "vbn", "vss", 5, 4.0),
            *(n(f"four_{k}", "vbp", "vbn", "source", 20, 4.0, "n_lvt") for k in range(4)),
            p("mirror_one", "vbn", "vbp", 10, 4.0),
            p("mirror_four", "vbp", "vbp", 10, 4.0),
            *(p(pin.replace("ibias", "out") + f"_{k}", pin, "vbp", 10, 4.0) for pin in pins for k in range(2)),
            p("keep", "start", "vss", 0.42, 8.0),
            n("stop", "start", "vbn", "vss", 4, 0.5, "n_lvt"),
            n("start", "vbp", "start", "vss", 1, 0.5),
        ),
        resistors=tuple(
            Resistor(f"r{k}", a, b, BIAS_OHM / BARS, True)
            for k, (a, b) in enumerate(pairwise(("source", *(f"part_{k}" for k in range(1, BARS)), "vss")))
        ),
    )
