"""Fixed-point formats and tables of the quadrature divider: the golden model and the RTL are both built from them.

The phase is a binary angle: 256 is one turn, 32 an octant.
"""

from functools import cache

import numpy as np

DIVIDERS = ("radix2", "radix4", "pipelined", "cordic")
NO_DIVIDER = "none"  # a chip without the phase path
SAMPLE_MIN, SAMPLE_MAX = -256, 255  # differences of two 8-bit samples fit 9 bits
N_FRAC_MIN, N_FRAC_MAX = 4, 16
ITERATIONS_MIN, ITERATIONS_MAX = 4, 16  # of CORDIC
TURN, OCTANT = 256, 32  # in LSB of the phase
AMP_MAX = 255


@cache
def phase_thresholds(n_frac: int) -> tuple[int, ...]:
    """Ratios at which the phase of an octant steps up: its index is the number of thresholds the ratio has reached.

    A ratio r represents the cell [r, r + 1) / 2^n_frac; its index is the phase of the cell's centre, rounded:
    r + 1/2 >= 2^n_frac * tan(2 pi (k - 1/2) / 256). No tangent there is rational, so there is no tie. The last
    thresholds saturate with the ratio, so that a ratio of 1 always reaches 32.

    n_frac: fraction bits of the ratio, 4..16. Returns T_1..T_32, ascending, 0..2^n_frac - 1.
    """
    k = np.arange(1, OCTANT + 1)
    edges = 2**n_frac * np.tan(2 * np.pi * (k - 0.5) / TURN) - 0.5
    return tuple(int(t) for t in np.minimum(np.ceil(edges), 2**n_frac - 1))


@cache
def cordic_angles(iterations: int) -> tuple[int, ...]:
    """Angles of the CORDIC steps, atan(2^-i) for i = 1..iterations.

    iterations: steps, 4..16, and as many fraction bits. Returns tuple of int: in LSB of the phase with ``iterations``
    fraction bits, rounded to nearest.
    """
    i = np.arange(1, iterations + 1)
    return tuple(int(a) for a in np.rint(np.arctan(2.0**-i) * (TURN / (2 * np.pi)) * 2**iterations))
