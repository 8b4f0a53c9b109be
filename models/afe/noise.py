"""Noise without a generator's state: a hash of (seed, sample, decision), the same in NumPy and in Verilog.

The order of evaluation does not matter: a simulator that skips, repeats or reorders decisions sees the same noise.
"""

import numpy as np
import numpy.typing as npt

DECISIONS = 16  # numbers of a sample: 0..14 are comparator decisions
KTC_DECISION = DECISIONS - 1  # the number of the sampling capacitor
NOISE_SCALE = float(1 / np.sqrt(4 * (256**2 - 1) / 12))  # a count -> unit variance
MOST = 4 * 255 // 2  # counts either way


def mix(x: npt.NDArray[np.uint32]) -> npt.NDArray[np.uint32]:
    """Bijection of uint32 arrays with low bias: C. Wellons, "Prospecting for hash functions", lowbias32 (2018)."""
    x = x ^ (x >> np.uint32(16))
    x = x * np.uint32(0x7FEB352D)
    x = x ^ (x >> np.uint32(15))
    x = x * np.uint32(0x846CA68B)
    return x ^ (x >> np.uint32(16))


def noise_counts(seed: int, index: npt.ArrayLike, decision: npt.ArrayLike) -> npt.NDArray[np.int32]:
    """Noise of some decisions: the sum of the four bytes of mix(mix(seed) ^ (16 * index + decision)), less 510.

    seed: 0..2**32-1. index: sample number, 0..2**28-1. decision: 0..15, broadcastable to ``index``. Returns -510..510,
    variance 1 / NOISE_SCALE**2, close to Gaussian up to 3.45 sigma, where it ends.
    """
    key = mix(np.array([seed], np.uint32))
    word = np.atleast_1d(np.asarray(index)).astype(np.uint32) * np.uint32(DECISIONS)
    h = mix(key ^ (word + np.asarray(decision).astype(np.uint32)))
    total = (h & 255) + (h >> 8 & 255) + (h >> 16 & 255) + (h >> 24)
    return total.astype(np.int32).reshape(np.broadcast_shapes(np.shape(index), np.shape(decision))) - MOST
