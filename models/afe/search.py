"""Successive approximation of many held values at once: `Converter.held` and `Converter.compare`, compiled."""

from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.afe.noise import DECISIONS, KTC_DECISION, MOST
from talbot.models.compiled import njit

Floats, Ints = npt.NDArray[np.float64], npt.NDArray[np.int64]
BITS, BIPOLAR = 8, 128


@njit(cache=True, nogil=True)
def _mix(x: Any) -> Any:
    """As of models.afe.noise: here, too, since Numba's cache looks at changes of a function's own file alone."""
    x = np.uint32(x ^ (x >> np.uint32(16)))
    x = np.uint32(x * np.uint32(0x7FEB352D))
    x = np.uint32(x ^ (x >> np.uint32(15)))
    x = np.uint32(x * np.uint32(0x846CA68B))
    return np.uint32(x ^ (x >> np.uint32(16)))


@njit(cache=True, nogil=True)
def _counts(key: Any, index: int, decision: int) -> Any:
    h = _mix(np.uint32(key ^ np.uint32(DECISIONS * index + decision)))
    return np.int64(h & 255) + np.int64(h >> 8 & 255) + np.int64(h >> 16 & 255) + np.int64(h >> 24) - MOST


@njit(cache=True, nogil=True)
def _passes(held: float, level: float, scale: float, key: Any, index: int, decision: int) -> bool:
    """held + noise >= level; the noise is not drawn where it cannot change that."""
    noise, most = 0.0, scale * MOST
    if held - most < level <= held + most:
        noise = scale * _counts(key, index, decision)
    return held + noise >= level


@njit(cache=True, nogil=True)
def search(
    v: Floats,
    lane: Ints,
    index: Ints,
    levels: Floats,
    offset: Floats,
    scales: tuple[float, float],
    seed: Any,
    window: int,
    low: int,
    codes: npt.NDArray[np.int16],
    converted: npt.NDArray[np.bool_],
) -> None:
    """Decide, sample by sample, as models.digital.sar.decisions asks.

    v: (n,), values in LSB. lane, index: (n,), lane and number of each. levels: (lanes, 256), of every DAC code. offset:
    (lanes,), of the comparators. scales: LSB per count of a decision's noise and of the sampling capacitor's. seed: of
    the noise. window: codes of a smaller magnitude are not searched for; 0 searches for all. low: code of the DAC's 0.
    codes: (n,), receives the codes, 0 where the window gives them. converted: (n,), receives whether the search ran.
    """
    key = _mix(seed)
    scale, ktc = scales
    for n in range(v.size):
        i, level = index[n], levels[lane[n]]
        held = v[n] + ktc * _counts(key, i, np.int64(KTC_DECISION)) + offset[lane[n]]
        decision = np.int64(0)  # a literal would be a type, and `_passes` compiled again for each
        codes[n], converted[n] = 0, True
        if window:
            above = _passes(held, level[BIPOLAR + window], scale, key, i, decision)
            if not above and _passes(held, level[BIPOLAR + 1 - window], scale, key, i, decision + 1):
                converted[n] = False
                continue
            decision += 2
        dac = 0
        for bit in range(BITS - 1, -1, -1):
            if _passes(held, level[dac | 1 << bit], scale, key, i, decision):
                dac |= 1 << bit
            decision += 1
        codes[n] = dac + low
