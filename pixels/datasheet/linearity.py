"""The lane's static and dynamic linearity from its capacitors' mismatch, in closed form; its sampled noise.

A level is where the charge on the common plate balances: (sum of the capacitors whose bit is 1 - half a unit) / (all
that sampled) of the range. `pixels/datasheet/test` compares it with ngspice for one drawn array.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.afe import NOISE_SCALE, Converter
from talbot.models.digital.sar import convert
from talbot.models.parameters.electrical import BOLTZMANN
from talbot.pixels.circuits.dac import BITS, PARASITIC, DacSizes
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.specification import CODES, LaneSpec

SAMPLES = 4096  # of the sine
PERIODS = 1021  # a prime: every sample at another phase
RAMP = 64  # samples a code


def drawn(mismatch: float, rng: np.random.Generator) -> npt.NDArray[np.float64]:
    """Capacitors in units: bits 0..7, terminator, half; mismatch: rms of a unit, relative."""
    units = np.array([*(1 << k for k in range(BITS)), 1, 0.5])
    return units * (1 + mismatch / np.sqrt(units) * rng.standard_normal(units.size))


def levels(capacitors: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Level of every code in LSB: code - 0.5 where all match."""
    codes = np.arange(CODES)
    on = (codes[:, None] >> np.arange(BITS) & 1) @ capacitors[:BITS]
    return CODES * (on - capacitors[-1]) / capacitors[:-1].sum()


def inl_dnl(level: npt.NDArray[np.float64]) -> tuple[float, float]:
    """Peak INL off the line through levels 1 and 255, and peak DNL, LSB."""
    steps = np.diff(level[1:])
    line = np.linspace(level[1], level[-1], CODES - 1)
    average = (level[-1] - level[1]) / (CODES - 2)
    return float(np.abs((level[1:] - line) / average).max()), float(np.abs(steps / average - 1).max())


def ktc(spec: LaneSpec, sizes: LaneSizes, kelvin: float) -> float:
    """Rms noise sampled on both common plates, in LSB at the input: sqrt(2 k T C) over the capacitance that samples."""
    total = sizes.dac.total * (1 + PARASITIC) + sizes.comparator.input_capacitance
    return sqrt(2 * BOLTZMANN * kelvin * total) / (CODES * sizes.dac.unit) / spec.lsb


def area(sizes: DacSizes) -> float:
    """Both arrays, m2."""
    return 2 * (CODES + 0.5) * sizes.area


class Bits(NamedTuple):
    """Return ENOB of a lane from a sine at 0.98 of the range, and INL and DNL (LSB) from a ramp's histogram."""

    enob: float
    inl: float
    dnl: float


def tested(level: npt.NDArray[np.float64], noise: float, sampled: float, seed: int) -> Bits:
    """A converter with these levels, noise of each decision and sampled noise (LSB rms), through sine and ramp."""
    lane = Converter(np.stack([level, level])[:, None], np.zeros(1), noise * NOISE_SCALE, sampled * NOISE_SCALE, seed)
    phase = 2 * np.pi * PERIODS * np.arange(SAMPLES) / SAMPLES
    sine = 127.5 + 125 * np.sin(phase)
    codes = convert(sine, True, 0, lane, 0, np.arange(SAMPLES)).codes.astype(float)
    basis = np.stack([np.sin(phase), np.cos(phase), np.ones(SAMPLES)], 1)
    fit = basis @ np.linalg.lstsq(basis, codes, rcond=None)[0]
    sinad = 10 * np.log10(np.var(fit) / np.mean((codes - fit) ** 2))
    # A ramp far longer than the noise: the histogram's edges are the levels
    ramp = (np.arange(CODES * RAMP) + 0.5) / RAMP - 0.5
    seen = convert(ramp, True, 0, lane, 0, SAMPLES + np.arange(ramp.size)).codes
    edges = np.cumsum(np.bincount(seen, minlength=CODES))[:-1] / RAMP - 0.5
    return Bits((sinad - 1.76) / 6.02, *inl_dnl(np.r_[edges[0] - 1, edges]))
