"""The flat-field trim: a 10-bit signed register sets the ratio of the difference amplifier's two capacitors.

difference = a - g * b with g = 1 + code / 512: the second diode's capacitor is a unit array of 1..1023 units next to
512 fixed ones. Types need g = (1 + k) / (1 - k), which spans 0.54..1.86 for k in -0.3..0.3; the register
reaches 0..1.998. Half a step leaves gain * b / 1024 in the difference of a flat area: at the default gain
of 4 and a full well (b = 127.5) 0.498 LSB, less than half a code. With 9 bits the residual would exceed that; an
eleventh bit would bring nothing.
"""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError

TRIM_BITS = 10
TRIM_UNITY = 512  # steps of the register in a ratio of 1
TRIM_MIN, TRIM_MAX = -(1 << TRIM_BITS - 1), (1 << TRIM_BITS - 1) - 1


def trim_codes(g: npt.ArrayLike) -> npt.NDArray[np.int64]:
    """Register values nearest to some capacitor ratios.

    g: ratios; those beyond the register's range (below 0, above 1.998, infinity) take its end. Returns -512..511, shape
    of ``g``. Raises ParameterError for NaN.
    """
    g = np.asarray(g, np.float64)
    if np.isnan(g).any():
        raise ParameterError("trim ratio = nan: must be a number")
    limited = np.clip(g, 0.0, 2.0)  # before the multiplication: a huge ratio must not overflow
    return np.clip(np.rint((limited - 1.0) * TRIM_UNITY), TRIM_MIN, TRIM_MAX).astype(np.int64)


def trim_gain(code: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Capacitor ratios of some register values.

    code: -512..511. Returns g, exact, shape of ``code``. Raises ParameterError for a value out of range.
    """
    code = np.asarray(code, np.int64)
    if code.size and (code.min() < TRIM_MIN or code.max() > TRIM_MAX):
        raise ParameterError(f"trim = {code.min()}..{code.max()}: must be in {TRIM_MIN}..{TRIM_MAX}")
    return 1.0 + code / TRIM_UNITY
