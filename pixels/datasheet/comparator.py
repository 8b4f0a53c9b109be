"""The comparator: time and energy of a decision, offset by Monte Carlo."""

from dataclasses import dataclass
from math import sqrt

import numpy as np
import numpy.typing as npt

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Points
from talbot.pixels.circuits.comparator import comparator
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.datasheet.datasheet import RELATIVE
from talbot.pixels.datasheet.deck import EDGE, Setup, clock, deck, simulator

LOAD = 5e-15  # F at the decision
BATCH = 10  # comparators of a deck of the Monte Carlo run
REACH = 4.0  # LSB: offsets are searched up to it on both sides
STEPS = 8  # bisections: REACH / 2**7 is what an offset is known to
FAST_PERIOD = 8e-9  # s, of decisions whose outcome alone counts


@dataclass(frozen=True)
class Decisions:
    """At one corner. right: all are. delay: s, the longest. energy: J, mean. repeated: of the runs, with a retry."""

    right: bool
    delay: float
    energy: float
    runs: int
    repeated: int


def decisions(setup: Setup, sizes: LaneSizes, corner: Corner, circuit: Circuit | None = None) -> Decisions:
    """Four decisions of half an LSB at the lane's input, their signs alternating, after one of the other sign.

    circuit: instead of the comparator of ``sizes``, with its pins.
    """
    spec, vdd = setup.spec, corner.supply
    period, count = 1 / spec.f_clk, 5
    step = 0.5 * spec.lsb * sizes.attenuation / 2
    signs = [(-1) ** k for k in range(count)]
    up = [(0.0, spec.vcm + signs[0] * step)]
    for k in range(1, count):
        up += [(k * period, spec.vcm + signs[k - 1] * step), (k * period + EDGE, spec.vcm + signs[k] * step)]
    down = [(t, 2 * spec.vcm - v) for t, v in up]
    lines = deck(circuit or comparator(sizes.comparator), setup, corner)
    with simulator(lines, ("inp", "inn", "strobe"), ("q",), corner) as spice:
        stimulus = {"inp": up, "inn": down, "strobe": clock(count, period, vdd)}
        wave = spice.transient(stimulus, {"q": LOAD}, count * period, period / 10)
    right, delay = True, 0.0
    for k in range(1, count):
        right &= (wave.at("q", (k + 1) * period - EDGE) > vdd / 2) == (signs[k] > 0)
        start = (k + 0.5) * period + EDGE / 2
        inside = (wave.time > start) & (wave.time < (k + 1) * period)
        wrong = (wave.voltage["q"][inside] > vdd / 2) != (signs[k] > 0)
        delay = max(delay, float(wave.time[inside][wrong].max(initial=start) - start))
    energy = wave.charge("vdd", period, count * period) * vdd / (count - 1)
    return Decisions(bool(right), delay, energy, spice.runs, spice.repeated)


def offsets(setup: Setup, sizes: LaneSizes, corner: Corner, seed: int) -> list[float]:
    """Return offsets of BATCH comparators with mismatch, LSB at the lane's input: V(inn) above V(inp) at balance.

    One beyond REACH is +-REACH.
    """
    spec, vdd = setup.spec, corner.supply
    numbers = range(BATCH)
    lines = deck(
        comparator(sizes.comparator),
        setup,
        corner,
        [(f"p{k}", f"n{k}", "strobe", f"q{k}", "vdd", "vss") for k in numbers],
        seed,
    )
    inputs = [*(f"p{k}" for k in numbers), *(f"n{k}" for k in numbers), "strobe"]
    lsb = spec.lsb * sizes.attenuation
    low, high = np.full(BATCH, -REACH), np.full(BATCH, REACH)
    strobe = [(0.0, 0.0), (FAST_PERIOD / 2, 0.0), (FAST_PERIOD / 2 + EDGE, vdd), (FAST_PERIOD, vdd)]
    with simulator(lines, inputs, [f"q{k}" for k in numbers], corner) as spice:
        for _ in range(STEPS):
            middle = (low + high) / 2
            stimulus: dict[str, Points] = {"strobe": strobe}
            for k in numbers:
                stimulus[f"p{k}"] = [(0.0, spec.vcm + middle[k] * lsb / 2)]
                stimulus[f"n{k}"] = [(0.0, spec.vcm - middle[k] * lsb / 2)]
            wave = spice.transient(stimulus, {f"q{k}": LOAD for k in numbers}, FAST_PERIOD, FAST_PERIOD / 10)
            ones = np.array([wave.at(f"q{k}", FAST_PERIOD) > vdd / 2 for k in numbers])
            low, high = np.where(ones, low, middle), np.where(ones, middle, high)
    return [float(x) for x in (low + high) / 2]


def interval(values: npt.ArrayLike) -> tuple[float, float, float]:
    """Rms of offsets about their mean, and its 95 % interval: rms (1 -+ RELATIVE / sqrt(2 (n - 1)))."""
    found = np.asarray(values, float)
    rms = float(found.std(ddof=1))
    error = RELATIVE / sqrt(2 * (found.size - 1))
    return rms, rms * (1 - error), rms * (1 + error)
