"""Four-tap time of flight [Jayasuriya2017, Ch. 5, with the signs and units that agree with each other].

i(tau) = (albedo / 2) cos(2 pi f_mod tau + phase)          taps at 2 pi f_mod tau = 0, pi/2, pi, 3 pi/2
phase = atan2(i_270 - i_90, i_0 - i_180)     albedo = hypot(i_270 - i_90, i_0 - i_180)
depth = c phase / (4 pi f_mod)
"""

import numpy as np
import numpy.typing as npt

SPEED_OF_LIGHT = 299_792_458.0  # m/s
TAPS = (0.0, np.pi / 2, np.pi, 3 * np.pi / 2)


def phase_of(depth: npt.ArrayLike, f_mod: float) -> npt.NDArray[np.float64]:
    """Phase of an echo.

    Parameters
    ----------
    depth : array
        In m.
    f_mod : float
        Modulation frequency in Hz.

    Returns
    -------
    float64
        In rad, not wrapped.

    References
    ----------
    [Jayasuriya2017], Ch. 5, with f_mod in Hz.
    """
    return 4 * np.pi * f_mod / SPEED_OF_LIGHT * np.asarray(depth, float)


def depth_of(phase: npt.ArrayLike, f_mod: float) -> npt.NDArray[np.float64]:
    """Depth of an echo.

    Parameters
    ----------
    phase : array
        In rad, taken modulo 2 pi.
    f_mod : float
        Modulation frequency in Hz.

    Returns
    -------
    float64
        In m, 0..c / (2 f_mod).

    References
    ----------
    [Jayasuriya2017], Ch. 5, with f_mod in Hz.
    """
    return SPEED_OF_LIGHT * np.mod(phase, 2 * np.pi) / (4 * np.pi * f_mod)


def tap_gains(phase: npt.ArrayLike, contrast: float = 1.0, ambient: float = 0.0) -> npt.NDArray[np.floating]:
    """Share of light of mean 1 that each tap collects: (1 + contrast cos(tap + phase)) / 2 + ambient.

    Parameters
    ----------
    phase : array (...)
        In rad.
    contrast : float
        Of the demodulation, 0..1.
    ambient : float
        Light that is not modulated, 0 or more.

    Returns
    -------
    array (4, ...)
        0..1, and what is ambient.
    """
    return np.stack([(1 + contrast * np.cos(tap + np.asarray(phase))) / 2 + ambient for tap in TAPS])


def quadrature(taps: npt.NDArray[np.floating]) -> tuple[npt.NDArray[np.floating], npt.NDArray[np.floating]]:
    """Quadrature components of four taps.

    Parameters
    ----------
    taps : array (4, ...)
        At 0, 90, 180 and 270 degrees.

    Returns
    -------
    x : array (...)
        i_0 - i_180.
    y : array (...)
        i_270 - i_90.

    References
    ----------
    [Jayasuriya2017], Eq. 5.3, with the signs that agree with Eq. 5.2.
    """
    return taps[0] - taps[2], taps[3] - taps[1]


def demodulate(taps: npt.NDArray[np.floating]) -> tuple[npt.NDArray[np.floating], npt.NDArray[np.floating]]:
    """Phase and albedo of four taps; both 0 where the taps are equal.

    Parameters
    ----------
    taps : array (4, ...)
        At 0, 90, 180 and 270 degrees.

    Returns
    -------
    phase : array (...)
        In rad, 0..2 pi.
    albedo : array (...)
        In the unit of the taps.

    References
    ----------
    [Jayasuriya2017], Eq. 5.3, with both signs.
    """
    x, y = quadrature(taps)
    return np.mod(np.arctan2(y, x), 2 * np.pi), np.hypot(x, y)
