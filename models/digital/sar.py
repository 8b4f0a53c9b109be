"""Successive approximation with a zero window: from held values to codes (docs/chip.md).

`convert` converts whole arrays; `decisions` is one lane's sequence, decision by decision.
"""

from collections.abc import Generator
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_int

BITS = 8
BIPOLAR = 128  # offset binary: DAC code = code + 128


class Conversion(NamedTuple):
    """Result of a conversion, arrays of one shape.

    codes: -128..127 or 0..255.
    converted: False where the window comparison alone gives the code.
    decisions: comparator decisions of each sample.
    """

    codes: npt.NDArray[np.int16]
    converted: npt.NDArray[np.bool_]
    decisions: npt.NDArray[np.uint8]


class _Lanes(Protocol):
    """The part of models.afe.Converter that a conversion needs."""

    def search(
        self, v: npt.NDArray[np.float64], unsigned: bool, window: int, lane: npt.ArrayLike, index: npt.ArrayLike
    ) -> tuple[npt.NDArray[np.int16], npt.NDArray[np.bool_]]: ...

    def window(
        self, v: npt.NDArray[np.float64], threshold: int, lane: npt.ArrayLike, index: npt.ArrayLike
    ) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]: ...


def decisions(unsigned: bool, threshold: int, ternary: bool = False) -> Generator[int, bool, tuple[int, bool]]:
    """Yield the DAC codes of a conversion; expects the comparator's decision on each.

    Edge mode (not unsigned) with a threshold T first compares v >= level(T) and v >= level(1 - T). Then follow 8
    decisions, MSB first. A code that is inside the window after these is set to zero. Ternary mode makes the first two
    alone, whatever the threshold.

    unsigned: codes 0..255 without a window, else -128..127 with it. threshold: T, 0..127; 0 converts every sample of
    edge mode. ternary: codes -1, 0 and 1; not with ``unsigned``. Yields DAC code, 0..255. Returns code (-128..127 or
    0..255), converted (False where the window comparison alone gives the code).
    """
    window = 0 if unsigned else threshold
    if window or ternary:
        above = yield BIPOLAR + window
        not_below = yield BIPOLAR + 1 - window
        if ternary:
            return (1 if above else 0 if not_below else -1), False
        if not_below and not above:
            return 0, False
    dac = 0
    for bit in range(BITS - 1, -1, -1):
        if (yield dac | 1 << bit):
            dac |= 1 << bit
    code = dac if unsigned else dac - BIPOLAR
    return (0 if abs(code) < window else code), True


def convert(
    v: npt.ArrayLike,
    unsigned: bool,
    threshold: int = 0,
    converter: _Lanes | None = None,
    lane: npt.ArrayLike = 0,
    index: npt.ArrayLike = 0,
    ternary: bool = False,
) -> Conversion:
    """Convert held values.

    v: values in LSB, finite. unsigned: codes 0..255 without a window, else -128..127 with it. threshold: 0..127;
    samples of a smaller magnitude become exact zeros; 0 converts every sample of edge mode. converter: imperfect lanes;
    None is ideal ones. lane: lane of each sample, 0..lanes-1, broadcastable to ``v``. index: number of each sample, for
    its noise, broadcastable to ``v``. ternary: codes -1, 0 and 1 by the window comparison alone; not with ``unsigned``.
    Returns Conversion: of arrays of the shape of ``v``. Raises ParameterError for a threshold out of range and for
    values that are not finite.
    """
    check_int("threshold", threshold, 0, 127)
    v = np.asarray(v, np.float64)
    if not np.isfinite(v).all():
        raise ParameterError("v = nan or infinity: must be finite")
    window = 0 if unsigned else threshold
    if ternary:
        if converter is None:
            above, not_below = v >= window - 0.5, v >= 0.5 - window
        else:
            above, not_below = converter.window(v, window, lane, index)
        codes = np.where(above, 1, np.where(not_below, 0, -1)).astype(np.int16)
        return Conversion(codes, np.zeros(v.shape, bool), np.full(v.shape, 2, np.uint8))
    if converter is None:
        codes, converted = _ideal(v, unsigned, window)
    else:
        codes, converted = converter.search(v, unsigned, window, lane, index)
    codes[np.abs(codes) < window] = 0
    first = 2 if window else 0
    taken = np.where(converted, first + BITS, first).astype(np.uint8)
    return Conversion(codes.reshape(v.shape), converted.reshape(v.shape), taken.reshape(v.shape))


def _ideal(
    v: npt.NDArray[np.float64], unsigned: bool, window: int
) -> tuple[npt.NDArray[np.int16], npt.NDArray[np.bool_]]:
    """Result of the search with levels at code - 0.5: floor(v + 0.5), clipped."""
    low = 0 if unsigned else -BIPOLAR
    limited = np.clip(v, low, low + 255)
    nearest = np.floor(limited + 0.5)
    nearest -= limited < nearest - 0.5  # where the sum is rounded up to the next integer
    codes = nearest.astype(np.int16)
    return codes, np.abs(codes) >= window
