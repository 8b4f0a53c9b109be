"""The analog half of the successive-approximation lanes: DAC levels, comparator and sampling capacitor."""

from dataclasses import dataclass

import numpy as np

from models.parameters import ConverterParameters, check_int

from .noise import KTC_DECISION, NOISE_SCALE, noise_counts

CODES = 256


@dataclass(frozen=True, eq=False)
class Converter:
    """The lanes as drawn from ConverterParameters. Everything is in LSB.

    levels: float64 (2, lanes, 256): comparator thresholds of every DAC code; [0] bipolar (code - 128), [1] unipolar.
    offset: float64 (lanes,), the comparator's, referred to its input.
    noise_scale, ktc_scale: LSB a count of `noise_counts`.  seed: of the noise, 0..2**32-1.
    """

    levels: np.ndarray
    offset: np.ndarray
    noise_scale: float
    ktc_scale: float
    seed: int

    @classmethod
    def draw(cls, parameters, lanes):
        """Draw ``lanes`` converters; the first lanes of a wider bank are those of a narrower one.

        The DAC's error is `inl` times a parabola that is 0 at both ends and 1 at mid-scale, up or down at random,
        plus a random walk of step `dnl` with its ends pinned to zero. It is the DAC's own: the same for
        both ranges. Raises ParameterError for lanes outside 1..32.
        """
        check_int("lanes", lanes, 1, 32)
        x = np.arange(CODES) / (CODES - 1)
        error, offset = np.empty((lanes, CODES)), np.empty(lanes)
        for lane in range(lanes):
            rng = np.random.default_rng((parameters.seed, lane))
            bow = rng.choice((-1.0, 1.0)) * parameters.inl
            walk = np.concatenate(([0.0], np.cumsum(rng.standard_normal(CODES - 1)) * parameters.dnl))
            error[lane] = bow * 4 * x * (1 - x) + (walk - x * walk[-1])
            offset[lane] = rng.standard_normal() * parameters.offset
        ideal = np.arange(CODES) - np.array([[128.5], [0.5]])
        return cls(
            ideal[:, None] + error,
            offset,
            parameters.noise * NOISE_SCALE,
            parameters.ktc * NOISE_SCALE,
            parameters.seed,
        )

    @classmethod
    def ideal(cls, lanes):
        """Lanes without any imperfection."""
        return cls.draw(ConverterParameters(), lanes)

    @property
    def lanes(self):
        return self.offset.size

    def held(self, v, lane, index):
        """What lies on the sampling capacitor after the hold: float64, of the broadcast shape.

        v: value in LSB.  lane: 0..lanes-1.  index: sample number, 0..2**28-1.
        """
        kt = self.ktc_scale * noise_counts(self.seed, index, KTC_DECISION)
        return (np.asarray(v, np.float64) + kt) + self.offset[lane]

    def compare(self, held, dac, unsigned, lane, index, decision):
        """The comparator: True where held + noise >= level(dac).

        dac: 0..255, offset binary when bipolar.  unsigned: take the unipolar range.
        decision: number of this decision since the hold, 0..14.
        """
        noise = self.noise_scale * noise_counts(self.seed, index, decision)
        return held + noise >= self.levels[int(unsigned), lane, dac]
