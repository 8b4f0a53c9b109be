"""Switch drivers and bias: gaps, currents, start-up at one corner."""

from dataclasses import dataclass

import numpy as np

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Simulator
from talbot.cells.spice.wave import Wave
from talbot.pixels.circuits.netlist import Circuit, Instance, Resistor
from talbot.pixels.circuits.support import SupportSpec, bias, non_overlap
from talbot.pixels.datasheet.deck import SETTINGS, Setup, clock, deck, simulator

RAMP, STARTED = 1e-6, 30e-6  # s, of the supply when the bias starts, and until which it is simulated
NEAR = 0.02  # of its last current: the bias has started
PIN = 0.62  # V at the amplifier's ibias
OPEN_OHM = 1e9  # of an output of the bias without an amplifier
QUARTER = 5e-9  # s, of the switch drivers' clock


@dataclass(frozen=True)
class SupportResult:
    """At one corner.

    gap, lost: s with both phases low, the shortest (below 0: both are high) and the longest. bias: A at the
    amplifier's pin. idle: A of the whole bias. start: s after the supply's ramp until the current is there.
    """

    gap: float
    lost: float
    bias: float
    idle: float
    start: float
    runs: int
    repeated: int


@dataclass(frozen=True)
class BiasResult:
    """A at an output, A of the whole, s after the supply's ramp until the current is there."""

    current: float
    idle: float
    start: float


def measure(setup: Setup, spec: SupportSpec, corner: Corner) -> SupportResult:
    """Both circuits."""
    gaps, one = phases(setup, spec, corner)
    bias_at, two = bias_measured(setup, corner)
    return SupportResult(
        gap=min(gaps),
        lost=max(gaps),
        bias=bias_at.current,
        idle=bias_at.idle,
        start=bias_at.start,
        runs=one.runs + two.runs,
        repeated=one.repeated + two.repeated,
    )


def phases(
    setup: Setup, spec: SupportSpec, corner: Corner, circuit: Circuit | None = None
) -> tuple[list[float], Simulator]:
    """Gaps (s) between the phases at half the supply, at three edges; circuit: instead of `non_overlap`."""
    period, high = 4 * QUARTER, corner.supply
    lines = deck(circuit or non_overlap(), setup, corner)
    with simulator(lines, ("clk",), ("phi1", "phi2"), corner) as spice:
        loads = {"phi1": spec.switches, "phi2": spec.switches}
        wave = spice.transient({"clk": clock(3, period, high)}, loads, 3 * period, period / 400)
    gaps = []
    for edge, first, second in ((0.5, "phi1", "phi2"), (1.0, "phi2", "phi1"), (1.5, "phi1", "phi2")):
        inside = (wave.time >= edge * period) & (wave.time < (edge + 0.45) * period)
        time = wave.time[inside]
        falls = float(time[wave.voltage[first][inside] > high / 2].max(initial=edge * period))
        rises = float(time[wave.voltage[second][inside] < high / 2].max(initial=edge * period))
        gaps.append(rises - falls)
    return gaps, spice


def bias_measured(setup: Setup, corner: Corner, circuit: Circuit | None = None) -> tuple[BiasResult, Simulator]:
    """Current and start of a bias; circuit: instead of `bias`, of several outputs the first is loaded."""
    wave, spice = started(setup, corner, circuit and first_output(circuit))
    current = -wave.current["ibias"]
    away = wave.time[np.abs(current - current[-1]) > NEAR * abs(current[-1])]
    idle = wave.charge("vdd", 0.9 * STARTED, STARTED) / (0.1 * STARTED)
    return BiasResult(float(current[-1]), idle, max(float(away.max(initial=RAMP)) - RAMP, 0.0)), spice


def first_output(circuit: Circuit) -> Circuit:
    """Return a bias whose outputs but the first are open."""
    first, *others = (pin for pin in circuit.ports if pin not in ("vdd", "vss"))
    nodes = tuple("ibias" if pin == first else pin for pin in circuit.ports)
    opened = tuple(Resistor(f"open_{pin}", pin, "vss", OPEN_OHM) for pin in others)
    inner = Instance("bias", circuit, nodes)
    return Circuit("first_output", ("ibias", "vdd", "vss"), resistors=opened, instances=(inner,))


def started(setup: Setup, corner: Corner, circuit: Circuit | None = None) -> tuple[Wave, Simulator]:
    """Return the bias while its supply rises from 0; circuit: instead of `bias`."""
    rails = {"vss": 0.0, "ibias": PIN}
    lines = deck(circuit or bias(), setup, corner)
    with Simulator(lines, ("vdd",), (), rails, corner.temperature, SETTINGS) as spice:
        wave = spice.transient({"vdd": [(0.0, 0.0), (RAMP, corner.supply)]}, {}, STARTED, STARTED / 1000)
    return wave, spice
