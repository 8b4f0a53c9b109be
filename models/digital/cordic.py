"""CORDIC in vectoring mode, bit true: an alternative to the divider, with the same result.

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
import numpy.typing as npt

from talbot.models.digital.divider import QuadResult, fold, operands, unfold
from talbot.models.parameters import check_int
from talbot.models.parameters.divider import ITERATIONS_MAX, ITERATIONS_MIN, cordic_angles

Ints = npt.NDArray[np.integer]


def cordic(x: npt.ArrayLike, y: npt.ArrayLike, iterations: int = 10, noise_floor: int = 0) -> QuadResult:
    """Phase of vectors by CORDIC.

    x, y: -256..255, broadcastable. iterations: steps, 4..16, and as many fraction bits. noise_floor: amplitude below
    which a phase is not valid, 0..255. Returns QuadResult: of the broadcast shape, with ratio 0. Raises ParameterError
    for an argument out of range.
    """
    check_int("iterations", iterations, ITERATIONS_MIN, ITERATIONS_MAX)
    octant, larger, smaller = fold(*operands(x, y, noise_floor))
    state = larger << iterations, smaller << iterations, np.zeros_like(larger)
    for i, angle in enumerate(cordic_angles(iterations), start=1):
        state = rotate(*state, i, angle)
    return unfold(octant, larger, np.zeros_like(larger), nearest_even(state[2], iterations), noise_floor)


def rotate(x: Ints, y: Ints, z: Ints, i: int, angle: int) -> tuple[Ints, Ints, Ints]:
    """Turn (x, y) by atan(2^-i) towards the x axis and count the angle in z.

    x, y, z: state. i: number of the step, from 1. angle: angle of the step in LSB of z. Returns state after the step.
    """
    up = y >= 0
    return (
        np.where(up, x + (y >> i), x - (y >> i)),
        np.where(up, y - (x >> i), y + (x >> i)),
        np.where(up, z + angle, z - angle),
    )


def nearest_even(z: Ints, fraction: int) -> Ints:
    """Round z / 2^fraction to the nearest integer, ties to even.

    z: fixed-point values. fraction: fraction bits, 1 or more. Returns shape of ``z``.
    """
    whole, half = z >> fraction, 1 << fraction - 1
    return whole + ((z & 2 * half - 1) + (whole & 1) > half)
