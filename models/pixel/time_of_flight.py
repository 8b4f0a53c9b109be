"""Four-tap time of flight [Jayasuriya2017, Ch. 5, with the signs and units that agree with each other].

i(tau) = (albedo / 2) cos(2 pi f_mod tau + phase)          taps at 2 pi f_mod tau = 0, pi/2, pi, 3 pi/2
phase = atan2(i_270 - i_90, i_0 - i_180)     albedo = hypot(i_270 - i_90, i_0 - i_180)
depth = c phase / (4 pi f_mod)
"""

import numpy as np

SPEED_OF_LIGHT = 299_792_458.0  # m/s
TAPS = (0.0, np.pi / 2, np.pi, 3 * np.pi / 2)


def phase_of(depth, f_mod):
    """Phase in rad (not wrapped) of an echo from ``depth`` (m) at ``f_mod`` (Hz)."""
    return 4 * np.pi * f_mod / SPEED_OF_LIGHT * np.asarray(depth, float)


def depth_of(phase, f_mod):
    """Depth in m of ``phase`` (rad, any turn taken modulo 2 pi): 0..c / (2 f_mod)."""
    return SPEED_OF_LIGHT * np.mod(phase, 2 * np.pi) / (4 * np.pi * f_mod)


def tap_gains(phase):
    """What each tap collects of a light of mean 1: (1 + cos(tap + phase)) / 2, (4, ...), 0..1."""
    return np.stack([(1 + np.cos(tap + phase)) / 2 for tap in TAPS])


def quadrature(taps):
    """x = i_0 - i_180 and y = i_270 - i_90 of four taps (4, ...)."""
    return taps[0] - taps[2], taps[3] - taps[1]


def demodulate(taps):
    """(phase in rad 0..2 pi, albedo) of four taps (4, ...), each in the taps' unit; both 0 where they are all alike."""
    x, y = quadrature(taps)
    return np.mod(np.arctan2(y, x), 2 * np.pi), np.hypot(x, y)
