"""Four-tap time of flight [Jayasuriya2017, Ch. 5, with the signs and units that agree with each other].

i(tau) = (albedo / 2) cos(2 pi f_mod tau + phase)          taps at 2 pi f_mod tau = 0, pi/2, pi, 3 pi/2
phase = atan2(i_270 - i_90, i_0 - i_180)     albedo = hypot(i_270 - i_90, i_0 - i_180)
depth = c phase / (4 pi f_mod)

Coded: the light is an m-sequence of chips, and each tap is the correlation with it, a chip later than the one before. A
tap then sees what is within a chip of it, and nothing else [Tadano2015].
"""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ElectricalParameters

SPEED_OF_LIGHT = 299_792_458.0  # m/s
TAPS = (0.0, np.pi / 2, np.pi, 3 * np.pi / 2)


def phase_of(depth: npt.ArrayLike, f_mod: float) -> npt.NDArray[np.float64]:
    """Phase of an echo.

    depth: in m. f_mod: modulation frequency in Hz. Returns float64: in rad, not wrapped. Source: [Jayasuriya2017], Ch.
    5, with f_mod in Hz.
    """
    return 4 * np.pi * f_mod / SPEED_OF_LIGHT * np.asarray(depth, float)


def depth_of(phase: npt.ArrayLike, f_mod: float) -> npt.NDArray[np.float64]:
    """Depth of an echo.

    phase: in rad, taken modulo 2 pi. f_mod: modulation frequency in Hz. Returns float64: in m, 0..c / (2 f_mod).
    Source: [Jayasuriya2017], Ch. 5, with f_mod in Hz.
    """
    return SPEED_OF_LIGHT * np.mod(phase, 2 * np.pi) / (4 * np.pi * f_mod)


def tap_gains(phase: npt.ArrayLike, contrast: float = 1.0, ambient: float = 0.0) -> npt.NDArray[np.floating]:
    """Share of light of mean 1 that each tap collects: (1 + contrast cos(tap + phase)) / 2 + ambient.

    phase: (...), in rad. contrast: of the demodulation, 0..1. ambient: light that is not modulated, 0 or more. Returns
    (4, ...), 0..1, and what is ambient.
    """
    return np.stack([(1 + contrast * np.cos(tap + np.asarray(phase))) / 2 + ambient for tap in TAPS])


def code_correlation(delay: npt.ArrayLike, chips: int, rate: float) -> npt.NDArray[np.float64]:
    """Correlation of an m-sequence with itself: a triangle of two chips.

    delay: in s. chips: of the sequence. rate: chips a second. Returns 1 at no delay and after every sequence, -1/chips
    from one chip on. Source: [Tadano2015].
    """
    off = np.asarray(delay, float) * rate
    off = np.abs((off + chips / 2) % chips - chips / 2)
    return np.maximum(1 - off * (1 + 1 / chips), -1 / chips)


def tap_depths(electrical: ElectricalParameters) -> npt.NDArray[np.float64]:
    """Depths at which the taps of a code see most.

    electrical: with a code. Returns (4,), in m.
    """
    return SPEED_OF_LIGHT / 2 * (electrical.code_delay + np.arange(4) / electrical.chip_rate)


def tap_functions(electrical: ElectricalParameters) -> list[Callable[[npt.ArrayLike], npt.NDArray[np.floating]]]:
    """Share that each tap collects of light from a depth, of mean 1.

    electrical: modulation, contrast and ambient light. Returns four functions of a depth in m.
    """
    e = electrical

    def _tap(number: int) -> Callable[[npt.ArrayLike], npt.NDArray[np.floating]]:
        if not e.code:
            return lambda depth: tap_gains(phase_of(depth, e.f_mod), e.contrast, e.ambient)[number]
        start = e.code_delay + number / e.chip_rate

        def _gain(depth: npt.ArrayLike) -> npt.NDArray[np.floating]:
            delay = 2 / SPEED_OF_LIGHT * np.asarray(depth, float) - start
            return (1 + e.contrast * code_correlation(delay, e.code, e.chip_rate)) / 2 + e.ambient

        return _gain

    return [_tap(number) for number in range(len(TAPS))]


def quadrature(taps: npt.NDArray[np.floating]) -> tuple[npt.NDArray[np.floating], npt.NDArray[np.floating]]:
    """Quadrature components of four taps.

    taps: (4, ...), at 0, 90, 180 and 270 degrees. Returns x ((...), i_0 - i_180), y ((...), i_270 - i_90). Source:
    [Jayasuriya2017], Eq. 5.3, with the signs that agree with Eq. 5.2.
    """
    return taps[0] - taps[2], taps[3] - taps[1]


def demodulate(taps: npt.NDArray[np.floating]) -> tuple[npt.NDArray[np.floating], npt.NDArray[np.floating]]:
    """Phase and albedo of four taps; both 0 where the taps are equal.

    taps: (4, ...), at 0, 90, 180 and 270 degrees. Returns phase ((...), in rad, 0..2 pi), albedo ((...), in the unit of
    the taps). Source: [Jayasuriya2017], Eq. 5.3, with both signs.
    """
    x, y = quadrature(taps)
    return np.mod(np.arctan2(y, x), 2 * np.pi), np.hypot(x, y)
