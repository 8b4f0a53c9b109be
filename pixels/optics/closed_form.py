"""Closed forms, for comparison with the rigorous solution [Jayasuriya2017, Sec. 2.2]."""

import numpy as np


def talbot_depth(period: float, wavelength: float, index: float) -> float:
    """Depth 2 n d^2 / wavelength at which a grating's image repeats itself; lengths in one unit."""
    return 2 * index * period**2 / wavelength


def angular_frequency(gap: float, period: float, index: float) -> float:
    """Angle sensitivity beta = 2 pi z / (n d) of gratings a distance ``gap`` apart, for small angles; one unit."""
    return 2 * np.pi * gap / (index * period)
