"""The quadrature divider, bit true: (x, y) -> octant, ratio, amplitude and phase (docs/chip.md, DivReq and DivResp).

Angles are counter-clockwise from +x. The phase is a binary angle: 256 is one turn, 32 an octant.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_int
from talbot.models.parameters.divider import (
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
    """Results of a division, arrays of the operands' common shape.

    octant: 0..7, floor(angle / 45 degrees); an axis or a diagonal belongs to the octant that starts there.
    ratio: floor(2^n_frac * min/max) of (|x|, |y|), saturated to 2^n_frac - 1; CORDIC: 0.
    zero: True where x = y = 0; octant, ratio and phase are then 0.
    phase: binary angle.
    amp_valid: max(|x|, |y|) >= the noise floor, and not zero (a zero vector has no phase).
    amp: max(|x|, |y|), saturated to 255.
    """

    octant: npt.NDArray[np.integer]
    ratio: npt.NDArray[np.integer]
    zero: npt.NDArray[np.bool_]
    phase: npt.NDArray[np.integer]
    amp_valid: npt.NDArray[np.bool_]
    amp: npt.NDArray[np.integer]


def quad_divide(x: npt.ArrayLike, y: npt.ArrayLike, n_frac: int = 8, noise_floor: int = 0) -> QuadResult:
    """Divide the smaller component by the larger one and look the phase up.

    x, y: -256..255, broadcastable. n_frac: fraction bits of the ratio, 4..16. noise_floor: amplitude below which a
    phase is not valid, 0..255. Returns QuadResult: of the broadcast shape. Raises ParameterError for an argument out of
    range.
    """
    check_int("n_frac", n_frac, N_FRAC_MIN, N_FRAC_MAX)
    octant, larger, smaller = fold(*operands(x, y, noise_floor))
    ratio = np.minimum((smaller << n_frac) // np.maximum(larger, 1), 2**n_frac - 1)
    index = np.searchsorted(phase_thresholds(n_frac), ratio, side="right")
    return unfold(octant, larger, ratio, index, noise_floor)


def operands(x: npt.ArrayLike, y: npt.ArrayLike, noise_floor: int) -> tuple[npt.NDArray[np.int32], ...]:
    """Check and broadcast the operands.

    x, y: -256..255, broadcastable. noise_floor: 0..255. Returns tuple of int32: x and y, of one shape. Raises
    ParameterError unless all operands are integers in range.
    """
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
    return tuple(np.broadcast_arrays(*checked))


def fold(
    x: npt.NDArray[np.int32], y: npt.NDArray[np.int32]
) -> tuple[npt.NDArray[np.integer], npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """Fold vectors into one octant.

    A quadrant holds the axis it starts at. Turned back by its quadrant, a vector other than zero has u > 0, v >= 0.

    x, y: vectors, of one shape. Returns octant (0..7), larger, smaller (|x| and |y| in order of size).
    """
    lower = (y < 0) | ((y == 0) & (x < 0))
    odd = (y != 0) & np.where(lower, x >= 0, x <= 0)
    u, v = np.where(odd, (abs(y), abs(x)), (abs(x), abs(y)))
    second = (v >= u) & (u != 0)
    octant = 4 * lower + 2 * odd + second
    return octant, np.maximum(u, v), np.minimum(u, v)


def unfold(
    octant: npt.NDArray[np.integer],
    larger: npt.NDArray[np.integer],
    ratio: npt.NDArray[np.integer],
    index: npt.NDArray[np.integer],
    noise_floor: int,
) -> QuadResult:
    """Turn a result in the folded octant back.

    Odd octants run from their diagonal to the axis where the next one starts.

    octant, larger: results of `fold`. ratio: fixed-point ratio. index: angle from the octant's own axis, in LSB of the
    phase. noise_floor: 0..255. Returns QuadResult: of the shape of ``octant``.
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


def phase_error(phase: npt.ArrayLike, x: npt.ArrayLike, y: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Error of a binary angle against atan2(y, x).

    phase: binary angle, 0..255. x, y: vectors, broadcastable. Returns -128..128 LSB, of the common shape; 0 where x = y
    = 0.
    """
    exact = np.arctan2(y, x) * (TURN / (2 * np.pi))
    error = (np.asarray(phase) - exact + TURN / 2) % TURN - TURN / 2
    return np.where((np.asarray(x) == 0) & (np.asarray(y) == 0), 0.0, error)
