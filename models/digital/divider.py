"""The quadrature divider, bit true: (x, y) -> octant, ratio, amplitude and phase (docs/chip.md, DivReq and DivResp).

Angles are counter-clockwise from +x. The phase is a binary angle: 256 is one turn, 32 an octant.
"""

from dataclasses import dataclass

import numpy as np

from models.parameters import ParameterError, check_int
from models.parameters.divider import (
    AMP_MAX,
    N_FRAC_MAX,
    N_FRAC_MIN,
    OCTANT,
    SAMPLE_MAX,
    SAMPLE_MIN,
    TURN,
    phase_thresholds,
)


@dataclass(frozen=True, eq=False)
class QuadResult:
    """Arrays of the operands' common shape.

    octant: uint8, 0..7, floor(angle / 45 degrees); an axis or a diagonal belongs to the octant that starts there.
    ratio: uint16, floor(2^n_frac * min/max) of (|x|, |y|), saturated to 2^n_frac - 1; CORDIC: 0.
    zero: bool, x = y = 0; octant, ratio and phase are then 0.
    phase: uint8, binary angle.
    amp_valid: bool, max(|x|, |y|) >= the noise floor, and not zero (a zero vector has no phase).
    amp: uint8, max(|x|, |y|), saturated to 255.
    """

    octant: np.ndarray
    ratio: np.ndarray
    zero: np.ndarray
    phase: np.ndarray
    amp_valid: np.ndarray
    amp: np.ndarray


def quad_divide(x, y, n_frac=8, noise_floor=0):
    """Divide and look the phase up; returns QuadResult.

    x, y: integers in -256..255, broadcastable.  n_frac: 4..16 fraction bits.  noise_floor: 0..255.
    Raises ParameterError.
    """
    check_int("n_frac", n_frac, N_FRAC_MIN, N_FRAC_MAX)
    octant, larger, smaller = fold(*operands(x, y, noise_floor))
    ratio = np.minimum((smaller << n_frac) // np.maximum(larger, 1), 2**n_frac - 1)
    index = np.searchsorted(phase_thresholds(n_frac), ratio, side="right")
    return unfold(octant, larger, ratio, index, noise_floor)


def operands(x, y, noise_floor):
    """x, y as int32 arrays of one shape. Raises ParameterError unless all operands are integers in range."""
    check_int("noise_floor", noise_floor, 0, AMP_MAX)
    checked = []
    for field, value in (("x", x), ("y", y)):
        value = np.asarray(value)
        if value.dtype.kind not in "iu":
            raise ParameterError(f"{field} of type {value.dtype}: must be integers in {SAMPLE_MIN}..{SAMPLE_MAX}")
        outside = (value < SAMPLE_MIN) | (value > SAMPLE_MAX)
        if outside.any():
            raise ParameterError(
                f"{field} = {value[outside].flat[0]}: must be an integer in {SAMPLE_MIN}..{SAMPLE_MAX}"
            )
        checked.append(value.astype(np.int32))
    return np.broadcast_arrays(*checked)


def fold(x, y):
    """(octant, larger, smaller): the octant of (x, y), and |x|, |y| in order of size; int32.

    A quadrant holds the axis it starts at. Turned back by its quadrant, a vector other than zero has u > 0, v >= 0.
    """
    lower = (y < 0) | ((y == 0) & (x < 0))
    odd = (y != 0) & np.where(lower, x >= 0, x <= 0)
    u, v = np.where(odd, (abs(y), abs(x)), (abs(x), abs(y)))
    second = (v >= u) & (u != 0)
    octant = 4 * lower + 2 * odd + second
    return octant, np.maximum(u, v), np.minimum(u, v)


def unfold(octant, larger, ratio, index, noise_floor):
    """QuadResult from what `fold` gave, the ratio, and the index: the angle from the octant's own axis, in LSB.

    Odd octants run from their diagonal to the axis where the next one starts.
    """
    zero = larger == 0
    odd = octant & 1
    phase = OCTANT * (octant + odd) + np.where(odd, -index, index)
    return QuadResult(
        octant=octant.astype(np.uint8),
        ratio=np.where(zero, 0, ratio).astype(np.uint16),
        zero=zero,
        phase=np.where(zero, 0, phase % TURN).astype(np.uint8),
        amp_valid=~zero & (larger >= noise_floor),
        amp=np.minimum(larger, AMP_MAX).astype(np.uint8),
    )


def phase_error(phase, x, y):
    """``phase`` minus atan2(y, x), in LSB, -128..128: float64 of the common shape. 0 where x = y = 0."""
    exact = np.arctan2(y, x) * (TURN / (2 * np.pi))
    error = (phase - exact + TURN / 2) % TURN - TURN / 2
    return np.where((np.asarray(x) == 0) & (np.asarray(y) == 0), 0.0, error)
