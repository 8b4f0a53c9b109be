"""The comparator: time and energy of a decision, offset by Monte Carlo, noise of its decisions."""

import re
from dataclasses import dataclass
from math import sqrt

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Points
from talbot.models.parameters import ParameterError
from talbot.models.parameters.electrical import BOLTZMANN
from talbot.pixels.circuits.comparator import comparator
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.netlist import Circuit

from .deck import EDGE, Setup, clock, deck, patient, simulator

LOAD = 5e-15  # F at the decision
BATCH = 10  # comparators of a deck of the Monte Carlo run
REACH = 4.0  # LSB: offsets are searched up to it on both sides
STEPS = 8  # bisections: REACH / 2**7 is what an offset is known to
FAST_PERIOD = 8e-9  # s, of decisions whose outcome alone counts
NOISY = 256  # decisions of a noise run
NOISE_STEP = 10e-12  # s between the noise's samples: 50 GHz of bandwidth
SENSE = 10.0  # ohm between the tail and vss
THRESHOLD = 0.6  # V below vdd at which the latch's n transistors begin to conduct
GAMMA = 2 / 3  # of the channel's noise, long channel: 4 k T gamma gm


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

    circuit: in place of the comparator of ``sizes``, with its pins.
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


def offsets(setup: Setup, sizes: LaneSizes, corner: Corner, seed: int, circuit: Circuit | None = None) -> list[float]:
    """Offsets of BATCH comparators with the models' mismatch, LSB at the lane's input: V(inn) above V(inp) at balance.

    One beyond REACH is +-REACH.
    """
    spec, vdd = setup.spec, corner.supply
    numbers = range(BATCH)
    lines = deck(
        circuit or comparator(sizes.comparator),
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


@dataclass(frozen=True)
class Noise:
    """Rms of a decision's noise, LSB at the lane's input. low, high: 95 % interval. closed: integrator's formula."""

    rms: float
    low: float
    high: float
    closed: float
    ones: list[int]
    decisions: int


def noise(setup: Setup, sizes: LaneSizes, corner: Corner, seed: int = 1) -> Noise:
    """Noise of the decisions by transient noise: white sources at the gates of the pair and the n latch.

    Each has the density 4 k T gamma / gm; gm is that of the current with which its drain is discharged. Decisions at
    two inputs, symmetrical, give the rms by the normal distribution. Latch transistors count in full, although they
    begin to conduct when the pair has amplified already.
    """
    spec, vdd = setup.spec, corner.supply
    lsb = spec.lsb * sizes.attenuation
    current, discharge = _discharge(setup, sizes, corner)
    kelvin = corner.temperature + 273.15
    gm = current / (1.3 * BOLTZMANN * kelvin / 1.602e-19)  # weak inversion, slope factor 1.3: an upper bound
    density = 4 * BOLTZMANN * kelvin * GAMMA / gm
    closed = sqrt(2 * density / (2 * discharge)) / lsb
    lines = _noisy(deck(comparator(sizes.comparator), setup, corner), sqrt(density / (2 * NOISE_STEP)), seed)
    period, ones = 2 * FAST_PERIOD, []
    with simulator(lines, ("inp", "inn", "strobe"), ("q",), corner, settings=patient(1200)) as spice:
        for sign in (-1, 1):
            step = sign * closed * lsb / 2
            stimulus: dict[str, Points] = {"inp": [(0.0, spec.vcm + step)], "inn": [(0.0, spec.vcm - step)]}
            stimulus["strobe"] = clock(NOISY, period, vdd)
            wave = spice.transient(stimulus, {"q": LOAD}, NOISY * period, period / 10)
            ends = (np.arange(NOISY) + 1) * period
            ones.append(int((np.interp(ends, wave.time, wave.voltage["q"]) > vdd / 2).sum()))
    rms, low, high = _probit(ones, closed)
    return Noise(rms, low, high, closed, ones, NOISY)


def _discharge(setup: Setup, sizes: LaneSizes, corner: Corner) -> tuple[float, float]:
    """Current of one transistor of the pair (A) while it discharges its drain, and how long that takes (s)."""
    spec, vdd = setup.spec, corner.supply
    lines = []
    for line in deck(comparator(sizes.comparator), setup, corner):
        tail = line.startswith("Xtail ")
        lines += [line.replace(" vss ", " sense ", 1), f"Rsense sense vss {SENSE:g}"] if tail else [line]
    drain, sense = "xcell.xarm.xp", "xcell.xarm.sense"
    with simulator(lines, ("inp", "inn", "strobe"), ("q", drain, sense), corner) as spice:
        stimulus: dict[str, Points] = {"inp": [(0.0, spec.vcm + 1e-3)], "inn": [(0.0, spec.vcm - 1e-3)]}
        stimulus["strobe"] = clock(1, 2 * FAST_PERIOD, vdd)
        wave = spice.transient(stimulus, {"q": LOAD}, 2 * FAST_PERIOD, FAST_PERIOD / 50)
    start = FAST_PERIOD
    end = wave.cross(drain, vdd - THRESHOLD, False, start)
    if end is None:
        raise ParameterError(f"comparator at {corner.name}: its pair does not discharge")
    inside = np.linspace(start + (end - start) / 4, end, 50)
    volts = np.interp(inside, wave.time, wave.voltage[sense])
    return float(volts.mean()) / SENSE / 2, end - start


def _noisy(lines: list[str], rms: float, seed: int) -> list[str]:
    """The deck with a source of white noise at the gates of the strong-arm's pair and n latch."""
    found, inside = [f".option seed={seed}"], False
    for line in lines:
        inside = line.startswith(".subckt strong_arm") or inside and not line.startswith(".ends")
        named = re.match(r"X(inp|inn|latch_np|latch_nn) (\S+) (\S+) (.*)", line)
        if inside and named:
            found.append(f"X{named[1]} {named[2]} gate_{named[1]} {named[4]}")
            found.append(f"Vn{named[1]} gate_{named[1]} {named[3]} dc 0 trnoise({rms:.6g} {NOISE_STEP:g} 0 0)")
        else:
            found.append(line)
    return found


def _probit(ones: list[int], step: float) -> tuple[float, float, float]:
    """Rms noise in the unit of ``step`` from decisions at -step and +step, and its 95 % interval."""
    low_share, high_share = ((n + 0.5) / (NOISY + 1) for n in ones)  # never 0 or 1
    slope = float(ndtri(high_share) - ndtri(low_share)) / (2 * step)
    density = [float(np.exp(-(ndtri(p) ** 2) / 2) / sqrt(2 * np.pi)) for p in (low_share, high_share)]
    variance = sum(p * (1 - p) / NOISY / d**2 for p, d in zip((low_share, high_share), density, strict=True))
    error = 1.96 * sqrt(variance) / (2 * step)
    return 1 / slope, 1 / (slope + error), 1 / max(slope - error, 1e-3)


def spread(values: npt.ArrayLike) -> tuple[float, float, float]:
    """Rms of offsets about their mean, and its 95 % interval: rms (1 -+ 1.96 / sqrt(2 (n - 1)))."""
    found = np.asarray(values, float)
    rms = float(found.std(ddof=1))
    error = 1.96 / sqrt(2 * (found.size - 1))
    return rms, rms * (1 - error), rms * (1 + error)
