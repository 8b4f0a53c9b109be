"""Noise of the comparator's decisions, by transient noise and by the integrator's closed form."""

import re
from dataclasses import dataclass
from math import sqrt

import numpy as np
from scipy.special import ndtri

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Points
from talbot.models.parameters import ParameterError
from talbot.models.parameters.electrical import BOLTZMANN, ELEMENTARY_CHARGE
from talbot.pixels.circuits.comparator import comparator
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.datasheet.deck import Setup, clock, deck, patient, simulator

LOAD = 5e-15  # F at the decision
PERIOD = 8e-9  # s, of decisions whose outcome alone counts: half of it decides
NOISY = 48  # decisions at each of two inputs
NOISE_STEP = 20e-12  # s between the noise's samples: 25 GHz of bandwidth
SENSE = 10.0  # ohm between the tail and vss
THRESHOLD = 0.6  # V below vdd at which the latch's n transistors begin to conduct
GAMMA = 2 / 3  # of the channel's noise, long channel: 4 k T gamma gm


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
    gm = current / (1.3 * BOLTZMANN * kelvin / ELEMENTARY_CHARGE)  # weak inversion, slope factor 1.3: an upper bound
    density = 4 * BOLTZMANN * kelvin * GAMMA / gm
    closed = sqrt(2 * density / (2 * discharge)) / lsb
    lines = _noisy(deck(comparator(sizes.comparator), setup, corner), sqrt(density / (2 * NOISE_STEP)), seed)
    period, ones = PERIOD, []
    with simulator(lines, ("inp", "inn", "strobe"), ("q",), corner, settings=patient(2000)) as spice:
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
        stimulus["strobe"] = clock(1, PERIOD, vdd)
        wave = spice.transient(stimulus, {"q": LOAD}, PERIOD, PERIOD / 100)
    start = PERIOD / 2
    end = wave.cross(drain, vdd - THRESHOLD, False, start)
    if end is None:
        raise ParameterError(f"comparator at {corner.name}: its pair does not discharge")
    inside = np.linspace(start + (end - start) / 4, end, 50)
    volts = np.interp(inside, wave.time, wave.voltage[sense])
    return float(volts.mean()) / SENSE / 2, end - start


def _noisy(lines: list[str], rms: float, seed: int) -> list[str]:
    """Return the deck with a source of white noise at the gates of the strong-arm's pair and n latch."""
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
    if slope <= 0:
        raise ParameterError(f"decisions = {ones} of {NOISY}: must be more at the greater input")
    density = [float(np.exp(-(ndtri(p) ** 2) / 2) / sqrt(2 * np.pi)) for p in (low_share, high_share)]
    variance = sum(p * (1 - p) / NOISY / d**2 for p, d in zip((low_share, high_share), density, strict=True))
    error = 1.96 * sqrt(variance) / (2 * step)
    return 1 / slope, 1 / (slope + error), 1 / max(slope - error, 1e-3)
