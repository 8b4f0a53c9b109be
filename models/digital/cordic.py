"""CORDIC in vectoring mode, bit true: the divider's peer, with the same result.

The folded vector (larger, smaller), at 0 to 45 degrees, is turned onto the x axis in ``iterations`` steps of
atan(2^-1), atan(2^-2), ... State, with F = ``iterations`` fraction bits in each:

| state | format | range |
|---|---|---|
| x | unsigned 9 + F | 0..421.6 (256 * sqrt 2 * the gain of 1.165), in LSB of the samples |
| y | signed 10 + F | -128..256 |
| z | signed 7 + F | -8..40, in LSB of the phase |

Shifts round down (arithmetic shift right). The angles are rounded to nearest. The phase is z, rounded to nearest, ties
to even.
"""

import numpy as np

from models.parameters import check_int
from models.parameters.divider import ITERATIONS_MAX, ITERATIONS_MIN, cordic_angles

from .divider import fold, operands, unfold


def cordic(x, y, iterations=10, noise_floor=0):
    """Phase by CORDIC; returns QuadResult with ratio 0.

    x, y: integers in -256..255, broadcastable.  iterations: 4..16.  noise_floor: 0..255.  Raises ParameterError.
    """
    check_int("iterations", iterations, ITERATIONS_MIN, ITERATIONS_MAX)
    octant, larger, smaller = fold(*operands(x, y, noise_floor))
    state = larger << iterations, smaller << iterations, np.zeros_like(larger)
    for i, angle in enumerate(cordic_angles(iterations), start=1):
        state = rotate(*state, i, angle)
    return unfold(octant, larger, np.zeros_like(larger), nearest_even(state[2], iterations), noise_floor)


def rotate(x, y, z, i, angle):
    """One step: turn (x, y) by atan(2^-i) towards the x axis and count the angle in z."""
    up = y >= 0
    return (
        np.where(up, x + (y >> i), x - (y >> i)),
        np.where(up, y - (x >> i), y + (x >> i)),
        np.where(up, z + angle, z - angle),
    )


def nearest_even(z, fraction):
    """z / 2^fraction rounded to nearest, ties to even (``fraction`` at least 1)."""
    whole, half = z >> fraction, 1 << fraction - 1
    return whole + ((z & 2 * half - 1) + (whole & 1) > half)
