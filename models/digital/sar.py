"""Successive approximation with a zero window: what a lane makes of a held value (docs/chip.md).

`convert` does whole arrays at once; `decisions` is one lane's sequence, decision by decision.
"""

from typing import NamedTuple

import numpy as np

from models.parameters import ParameterError, check_int

BITS = 8
BIPOLAR = 128  # offset binary: DAC code = code + 128


class Conversion(NamedTuple):
    """codes: int16, -128..127 or 0..255.  converted: bool, False where the window alone gave the zero.
    decisions: uint8, comparator decisions each sample took.
    """

    codes: np.ndarray
    converted: np.ndarray
    decisions: np.ndarray


def decisions(unsigned, threshold):
    """One conversion as a generator: yields DAC codes, is sent the comparator's answers, returns (code, converted).

    Edge mode (not unsigned) with a threshold first asks v >= level(T) and v >= level(1 - T). Then 8 decisions,
    MSB first. A code inside the window all the same is set to zero.
    """
    window = 0 if unsigned else threshold
    if window:
        above = yield BIPOLAR + window
        not_below = yield BIPOLAR + 1 - window
        if not_below and not above:
            return 0, False
    dac = 0
    for bit in range(BITS - 1, -1, -1):
        if (yield dac | 1 << bit):
            dac |= 1 << bit
    code = dac if unsigned else dac - BIPOLAR
    return (0 if abs(code) < window else code), True


def convert(v, unsigned, threshold=0, converter=None, lane=0, index=0):
    """Convert values; returns Conversion of arrays of v's shape.

    v: float64 in LSB, finite.  unsigned: 0..255 without a window, else -128..127 with it.
    threshold: 0..127; samples under it in magnitude become exact zeros; 0 converts everything.
    converter: models.afe.Converter, or None for ideal lanes; lane (0..lanes-1) and index (sample number) then say
    which lane converts which sample, broadcastable to v.
    Raises ParameterError for a threshold out of range and for values that are not finite.
    """
    check_int("threshold", threshold, 0, 127)
    v = np.asarray(v, np.float64)
    if not np.isfinite(v).all():
        raise ParameterError("v = nan or infinity: must be finite")
    window = 0 if unsigned else threshold
    if converter is None:
        codes, converted = _ideal(v, unsigned, window)
    else:
        lane, index = (np.broadcast_to(x, v.shape).ravel() for x in (lane, index))
        held = converter.held(v.ravel(), lane, index)
        codes, converted = _search(held, unsigned, window, converter, lane, index)
    codes[np.abs(codes) < window] = 0
    first = 2 if window else 0
    taken = np.where(converted, first + BITS, first).astype(np.uint8)
    return Conversion(*(x.reshape(v.shape) for x in (codes, converted, taken)))


def _ideal(v, unsigned, window):
    """What the search finds with levels at code - 0.5: floor(v + 0.5), clipped."""
    low = 0 if unsigned else -BIPOLAR
    limited = np.clip(v, low, low + 255)
    nearest = np.floor(limited + 0.5)
    nearest -= limited < nearest - 0.5  # where the sum was rounded up to the next integer
    codes = nearest.astype(np.int16)
    return codes, np.abs(codes) >= window


def _search(held, unsigned, window, converter, lane, index):
    """The decisions themselves, on flat arrays."""
    converted = np.ones(held.size, bool)
    if window:
        above = converter.compare(held, BIPOLAR + window, unsigned, lane, index, 0)
        converted = above | ~converter.compare(held, BIPOLAR + 1 - window, unsigned, lane, index, 1)
    at = np.flatnonzero(converted)
    held, lane, index = held[at], lane[at], index[at]
    dac = np.zeros(at.size, np.int16)
    for number, bit in enumerate(range(BITS - 1, -1, -1), start=2 if window else 0):
        trial = dac | 1 << bit
        dac = np.where(converter.compare(held, trial, unsigned, lane, index, number), trial, dac)
    codes = np.zeros(converted.size, np.int16)
    codes[at] = dac if unsigned else dac - BIPOLAR
    return codes, converted
