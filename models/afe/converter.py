"""The analog half of the successive-approximation lanes: DAC levels, comparator and sampling capacitor."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from talbot.models.afe.noise import KTC_DECISION, NOISE_SCALE, noise_counts
from talbot.models.afe.search import BIPOLAR, search
from talbot.models.parameters import ConverterParameters, check_int
from talbot.models.parameters.electrical import AMPLIFIER

CODES = 256


def _binary(rng: np.random.Generator) -> npt.NDArray[np.float64]:
    """Error of every code in LSB, for units that are off by 1 (rms, relative): first order, its ends at zero."""
    weights = 2.0 ** np.arange(CODES.bit_length() - 1)
    off = np.sqrt(weights) * rng.standard_normal(weights.size)
    error = (np.arange(CODES)[:, None] >> np.arange(weights.size) & 1) @ off
    return error - np.arange(CODES) / (CODES - 1) * error[-1]


@dataclass(frozen=True, eq=False)
class Converter:
    """Converters with imperfections drawn from ConverterParameters, in LSB.

    levels: (2, lanes, 256), comparator thresholds of every DAC code; [0] bipolar (code - 128), [1] unipolar.
    offset: (lanes,), offset of the comparator, input-referred.
    noise_scale, ktc_scale: LSB per count of `noise_counts`.
    seed: seed of the noise, 0..2**32-1.
    amplifier: LSB that the amplifier adds, times 1, x, x**2, x**3.
    """

    levels: npt.NDArray[np.float64]
    offset: npt.NDArray[np.float64]
    noise_scale: float
    ktc_scale: float
    seed: int
    amplifier: tuple[float, ...] = (0.0,) * len(AMPLIFIER)

    @classmethod
    def draw(cls, parameters: ConverterParameters, lanes: int) -> Self:
        """Draw converters; the first lanes of a wider bank are those of a narrower one.

        The DAC's error is `inl` times a parabola that is 0 at both ends and 1 at mid-scale, up or down at random,
        plus a random walk of step `dnl` with its ends pinned to zero, plus what `unit_mismatch` makes of eight binary
        capacitors and a terminator, less its gain: 0 at both ends. It is the same for both ranges.

        parameters: sizes of the imperfections, and the seed. lanes: converters, 1..32. Returns the bank. Raises
        ParameterError for lanes out of range.
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
            error[lane] += parameters.unit_mismatch * _binary(rng)
        ideal = np.arange(CODES) - np.array([[128.5], [0.5]])
        return cls(
            ideal[:, None] + error,
            offset,
            parameters.noise * NOISE_SCALE,
            parameters.ktc * NOISE_SCALE,
            parameters.seed,
            tuple(getattr(parameters, name) for name in AMPLIFIER),
        )

    @classmethod
    def ideal(cls, lanes: int) -> Self:
        """Converters without any imperfection.

        lanes: converters, 1..32. Returns the bank.
        """
        return cls.draw(ConverterParameters(), lanes)

    @property
    def lanes(self) -> int:
        """Converters of the bank."""
        return self.offset.size

    def amplified(self, v: npt.ArrayLike, unsigned: bool) -> npt.NDArray[np.float64]:
        """Values as the amplifier gives them.

        v: values in LSB. unsigned: the unipolar range, whose middle is the amplifier's zero. Returns float64: in LSB,
        shape of ``v``.
        """
        v = np.asarray(v, np.float64)
        if not any(self.amplifier):
            return v
        offset, gain, square, cube = self.amplifier
        x = (v - (CODES // 2 if unsigned else 0)) / (CODES // 2)
        return v + (offset + x * (gain + x * (square + x * cube)))

    def held(self, v: npt.ArrayLike, lane: npt.ArrayLike, index: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Value on the sampling capacitor after the hold, plus the comparator's offset.

        v: sampled value in LSB. lane: 0..lanes-1. index: sample number, 0..2**28-1. Returns float64: in LSB, of the
        broadcast shape.
        """
        kt = self.ktc_scale * noise_counts(self.seed, index, KTC_DECISION)
        return (np.asarray(v, np.float64) + kt) + self.offset[np.asarray(lane)]

    def compare(
        self,
        held: npt.NDArray[np.float64],
        dac: npt.ArrayLike,
        unsigned: bool,
        lane: npt.ArrayLike,
        index: npt.ArrayLike,
        decision: int,
    ) -> npt.NDArray[np.bool_]:
        """Compare held values with the DAC.

        held: result of `held`. dac: DAC code, 0..255, offset binary when bipolar. unsigned: the unipolar range. lane:
        0..lanes-1. index: sample number, 0..2**28-1. decision: number of this decision since the hold, 0..14. Returns
        True where held + noise >= level(dac).
        """
        noise = self.noise_scale * noise_counts(self.seed, index, decision)
        return held + noise >= self.levels[int(unsigned), np.asarray(lane), np.asarray(dac)]

    def search(
        self, v: npt.NDArray[np.float64], unsigned: bool, window: int, lane: npt.ArrayLike, index: npt.ArrayLike
    ) -> tuple[npt.NDArray[np.int16], npt.NDArray[np.bool_]]:
        """Hold and search many values: what `held` and `compare` give one decision after another.

        v: values in LSB. unsigned: the unipolar range. window: 0..127; 0 searches for every code. lane: 0..lanes-1,
        broadcastable to ``v``. index: sample number, 0..2**28-1, broadcastable to ``v``. Returns codes (of the shape of
        ``v``; 0 where the window comparison gives them, otherwise as found), converted (where the search ran).
        """
        codes, converted = np.empty(v.size, np.int16), np.empty(v.size, bool)
        lane, index = (np.broadcast_to(x, v.shape).astype(np.int64).ravel() for x in (lane, index))
        scales = float(self.noise_scale), float(self.ktc_scale)
        levels, low = np.ascontiguousarray(self.levels[int(unsigned)], np.float64), 0 if unsigned else -BIPOLAR
        search(v.ravel(), lane, index, levels, self.offset, scales, np.uint32(self.seed), window, low, codes, converted)
        return codes.reshape(v.shape), converted.reshape(v.shape)

    def window(
        self, v: npt.NDArray[np.float64], threshold: int, lane: npt.ArrayLike, index: npt.ArrayLike
    ) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
        """Hold and compare with both ends of the window alone: `held`, and `compare` twice.

        v: values in LSB. threshold: T, 0..127. lane: 0..lanes-1, broadcastable to ``v``. index: sample number,
        0..2**28-1, broadcastable to ``v``. Returns above (True where held + noise >= level(T)), not_below (True where
        held + noise >= level(1 - T)).
        """
        held = self.held(v, lane, index)
        above = self.compare(held, BIPOLAR + threshold, False, lane, index, 0)
        return above, self.compare(held, BIPOLAR + 1 - threshold, False, lane, index, 1)
