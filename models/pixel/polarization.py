"""The gratings as a weak polarizer [Jayasuriya2017, Ch. 4].

A grating at gamma passes  A/2 (S0 - d (S1 cos 2 gamma + S2 sin 2 gamma))  of the common mode.
The angle of polarization psi then follows from the 0, 45, 90 and 135 degree pixels:
S1 ~ I90 - I0, S2 ~ I135 - I45, psi = atan2(S2, S1) / 2. (The thesis prints psi without the factor 1/2.)
"""

import numpy as np


def transmission(polarization, gamma, diattenuation):
    """Factor on the photocurrent against unpolarized light of the same S0.

    polarization: S1/S0 and S2/S0, (2, ...). gamma: rad, broadcast against the rest. diattenuation: 0..1.
    Returns 0..2.
    """
    s1, s2 = polarization
    return np.maximum(1 - diattenuation * (s1 * np.cos(2 * gamma) + s2 * np.sin(2 * gamma)), 0)


def stokes(i0, i45, i90, i135, diattenuation):
    """S1/S0 and S2/S0, (2, ...), from the common modes at four orientations; 0 where there is no light.

    diattenuation: above 0, to 1.
    """
    s1, s2 = i90 - i0, i135 - i45
    total = (i0 + i45 + i90 + i135) / 2
    lit = total > np.finfo(np.result_type(total, 0.0)).tiny  # denormal light has no ratios
    return np.where(lit, np.stack([s1, s2]) / np.where(lit, total, 1) / diattenuation, 0.0)


def angle(s1, s2):
    """psi = atan2(S2, S1) / 2 in rad, modulo pi: in (-pi/2, pi/2]."""
    return 0.5 * np.arctan2(s2, s1)
