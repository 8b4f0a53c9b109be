"""The gratings as a weak polarizer [Jayasuriya2017, Ch. 4].

A grating at gamma passes  A/2 (S0 - d (S1 cos 2 gamma + S2 sin 2 gamma))  of the common mode.
The angle of polarization psi then follows from the 0, 45, 90 and 135 degree pixels:
S1 ~ I90 - I0, S2 ~ I135 - I45, psi = atan2(S2, S1) / 2. (The thesis prints psi without the factor 1/2.)
"""

import numpy as np
import numpy.typing as npt


def transmission(
    polarization: npt.NDArray[np.floating], gamma: npt.ArrayLike, diattenuation: float
) -> npt.NDArray[np.floating]:
    """Factor on the photocurrent relative to unpolarized light of the same S0.

    polarization: (2, ...), S1/S0 and S2/S0. gamma: grating orientation in rad, broadcastable to ``polarization[0]``.
    diattenuation: 0..1. Returns (...), 0..2. Source: [Jayasuriya2017], Ch. 4.
    """
    s1, s2 = polarization
    angle = 2 * np.asarray(gamma)
    return np.maximum(1 - diattenuation * (s1 * np.cos(angle) + s2 * np.sin(angle)), 0)


def stokes(
    i0: npt.NDArray[np.floating],
    i45: npt.NDArray[np.floating],
    i90: npt.NDArray[np.floating],
    i135: npt.NDArray[np.floating],
    diattenuation: float,
) -> npt.NDArray[np.floating]:
    """Relative Stokes parameters from the common modes at four orientations.

    i0, i45, i90, i135: (...), common modes of the pixels at 0, 45, 90 and 135 degrees. diattenuation: greater than 0,
    at most 1. Returns (2, ...), S1/S0 and S2/S0; 0 where there is no light. Source: [Jayasuriya2017], Ch. 4.
    """
    s1, s2 = i90 - i0, i135 - i45
    total = (i0 + i45 + i90 + i135) / 2
    lit = total > np.finfo(np.result_type(total, 0.0)).tiny  # denormal light has no ratios
    return np.where(lit, np.stack([s1, s2]) / np.where(lit, total, 1) / diattenuation, 0.0)


def angle(s1: npt.ArrayLike, s2: npt.ArrayLike) -> npt.NDArray[np.floating]:
    """Angle of linear polarization, psi = atan2(S2, S1) / 2.

    s1, s2: Stokes parameters, broadcastable. Returns array: in rad, (-pi/2, pi/2]. Source: [Jayasuriya2017], Ch. 4,
    with the factor 1/2 that the thesis leaves out.
    """
    return 0.5 * np.arctan2(s2, s1)
