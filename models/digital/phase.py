"""The phase path, bit true: four time-of-flight taps to (phase, amplitude) through the quadrature divider."""

import numpy as np
import numpy.typing as npt

from talbot.models.digital.cordic import cordic
from talbot.models.digital.divider import QuadResult, quad_divide
from talbot.models.parameters import DIVIDERS, ChipParameters, check_choice


def divide(
    variant: str, n_frac: int, iterations: int, x: npt.ArrayLike, y: npt.ArrayLike, noise_floor: int = 0
) -> QuadResult:
    """Result of a divider variant, bit true.

    variant: one of DIVIDERS. n_frac: fraction bits of the ratio, 4..16; unused by CORDIC. iterations: steps of CORDIC,
    4..16. x, y: -256..255, broadcastable. noise_floor: amplitude below which a phase is not valid, 0..255. Returns
    QuadResult: of the broadcast shape. Raises ParameterError for an argument out of range.
    """
    check_choice("divider", variant, DIVIDERS)
    if variant == "cordic":
        return cordic(x, y, iterations, noise_floor)
    return quad_divide(x, y, n_frac, noise_floor)


def phase_samples(
    taps: npt.ArrayLike, chip: ChipParameters, noise_floor: int = 0
) -> tuple[npt.NDArray[np.int16], npt.NDArray[np.int16]]:
    """Phase and amplitude of every pixel.

    taps: (..., 4), 0..255, at 0, 90, 180 and 270 degrees. chip: variant and widths of the divider. noise_floor: 0..255.
    Returns phase ((...), 8-bit binary angle of atan2(i270 - i90, i0 - i180)), amplitude ((...), max(|x|, |y|), 1..255,
    or 0 where it is below ``noise_floor`` or both differences are 0). Source: [Jayasuriya2017], Eq. 5.3 with both
    signs.
    """
    taps = np.asarray(taps, np.int32)
    x, y = taps[..., 0] - taps[..., 2], taps[..., 3] - taps[..., 1]
    quotient = divide(chip.divider, chip.n_frac, chip.cordic_iterations, x, y, noise_floor)
    return quotient.phase.astype(np.int16), np.where(quotient.amp_valid, quotient.amp, 0).astype(np.int16)
