"""From photocurrent to what the analog front end samples, in SI units, and the noise on the way."""

from dataclasses import dataclass

import numpy as np

from models.parameters import ELEMENTARY_CHARGE, ParameterError, check_int, check_real

from .shot import photon_count

NOISE_MAX = 100.0
PHOTONS_MAX = 1e15  # electrons a diode and interval: far beyond any well


@dataclass(frozen=True)
class Exposure:
    """How the array is exposed.

    electrical: ElectricalParameters. timing: AmpTiming. f_clk: Hz.
    noise: 0..100 times the physical noise of every kind; 0 is none, 1 physical.
    seed: 0..2**32-1, of the fixed pattern and of the noise in time, which are drawn from separate streams.
    """

    electrical: object
    timing: object
    f_clk: float = 10e6
    noise: float = 1.0
    seed: int = 1

    def __post_init__(self):
        check_real("f_clk", self.f_clk, 1e3, 1e9)
        check_real("noise", self.noise, 0, NOISE_MAX)
        check_int("seed", self.seed, 0, 2**32 - 1)

    @property
    def interval(self):
        """Seconds between common-mode resets."""
        return self.timing.t_int / self.f_clk

    def generator(self, stream):
        return np.random.default_rng([self.seed, stream])


def expose(pair, exposure, balance=None, tap=0):
    """Diode pairs as the amplifier leaves them for conversion: (rows, cols, 2), in LSB of an 8-bit sum.

    pair: relative photocurrents (2, rows, cols), 0.. (1 = a diode of a flat white scene). Its type is kept.
    balance: capacitor ratio g of every pixel, (rows, cols), of the common-mode reset; None is 1 everywhere.
    tap: 0..3, which sub-frame of a time-of-flight frame this is: its noise is drawn anew.
    a + b = 255 where both wells are full. Noise may carry a sample past 0..255; the converter clips.

    Each of n_cm + 1 intervals adds photocurrent and dark current with shot noise, up to the full well. Each reset
    between them takes what both diodes collected alike, so that the difference of a whole exposure, a - g b, outlasts
    wells that would have filled. Read noise and the fixed pattern's offset are added once, at the end.
    """
    if pair.ndim != 3 or pair.shape[0] != 2 or not pair.min() >= 0 or not np.isfinite(pair.max()):
        raise ParameterError(f"pair = {pair.dtype} {pair.shape}: must be (2, rows, cols), finite and not negative")
    e, n = exposure.electrical, exposure.noise
    dtype = pair.dtype
    fixed, moving = exposure.generator(0), exposure.generator(1 + tap)

    def normal(generator, rms):
        """Draws of this rms, or nothing to add: the streams are separate, so that skipping one moves no other."""
        return generator.standard_normal(pair.shape, dtype) * dtype.type(rms * n) if rms and n else dtype.type(0)

    gain = np.maximum(1 + normal(fixed, e.gain_fpn), 0)
    offset = normal(exposure.generator(101), e.offset_fpn)
    per_white = e.white_current * exposure.interval / ELEMENTARY_CHARGE
    dark = e.dark_current * exposure.interval / ELEMENTARY_CHARGE
    mean = np.minimum(pair * dtype.type(per_white) * gain + dtype.type(dark), dtype.type(PHOTONS_MAX))

    g = dtype.type(1) if balance is None else np.asarray(balance, dtype)
    wells = np.zeros_like(pair)
    for interval in range(exposure.timing.n_cm + 1):
        if interval:
            alike = np.minimum(wells[0] / g, wells[1])
            wells[0] -= g * alike
            wells[1] -= alike
        collected = mean
        if n:
            shot = photon_count(mean, moving.standard_normal(pair.shape, dtype)) - mean
            collected = np.maximum(mean + dtype.type(n) * shot, 0)
        np.clip(wells + collected, 0, dtype.type(e.full_well), out=wells)
    wells += offset + normal(exposure.generator(201 + tap), e.read_noise)
    return np.ascontiguousarray(np.moveaxis(wells / dtype.type(e.lsb_electrons), 0, -1))
