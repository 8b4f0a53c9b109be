"""Noise without a generator's state: a hash of (seed, sample, decision), the same in NumPy and in Verilog.

No order of evaluation matters, so a simulator that skips, repeats or reorders decisions sees the same noise.
"""

import numpy as np

DECISIONS = 16  # decision numbers of a sample: 0..14, and
KTC_DECISION = DECISIONS - 1  # the one that stands for the sampling capacitor
NOISE_SCALE = float(1 / np.sqrt(4 * (256**2 - 1) / 12))  # a count -> unit variance
_CENTRE = 4 * 255 // 2


def _mix(x):
    """Bijection of uint32 arrays with low bias: C. Wellons, "Prospecting for hash functions", lowbias32 (2018)."""
    x = x ^ (x >> np.uint32(16))
    x = x * np.uint32(0x7FEB352D)
    x = x ^ (x >> np.uint32(15))
    x = x * np.uint32(0x846CA68B)
    return x ^ (x >> np.uint32(16))


def noise_counts(seed, index, decision):
    """Sum of the four bytes of mix(mix(seed) ^ (16 * index + decision)), less 510: int32, -510..510.

    Variance 1 / NOISE_SCALE**2, close to Gaussian up to 3.45 sigma, where it ends.
    seed: 0..2**32-1.  index: sample number, 0..2**28-1, array.  decision: 0..15, broadcastable to index.
    """
    key = _mix(np.array([seed], np.uint32))
    word = np.atleast_1d(np.asarray(index)).astype(np.uint32) * np.uint32(DECISIONS)
    h = _mix(key ^ (word + np.asarray(decision).astype(np.uint32)))
    total = (h & 255) + (h >> 8 & 255) + (h >> 16 & 255) + (h >> 24)
    return total.astype(np.int32).reshape(np.broadcast_shapes(np.shape(index), np.shape(decision))) - _CENTRE
