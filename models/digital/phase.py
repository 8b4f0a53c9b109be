"""The phase path: four time-of-flight taps -> (phase, amplitude), through the quadrature divider, bit true."""

import numpy as np

from models.digital.cordic import cordic
from models.digital.divider import quad_divide


def divide(variant, n_frac, iterations, x, y, noise_floor=0):
    """QuadResult that ``variant`` must give; arguments as in `quad_divide` and `cordic`."""
    if variant == "cordic":
        return cordic(x, y, iterations, noise_floor)
    return quad_divide(x, y, n_frac, noise_floor)


def phase_samples(taps, chip, noise_floor=0):
    """Phase and amplitude of every pixel; returns two int16 arrays (...).

    taps: integers 0..255, (..., 4), at 0, 90, 180 and 270 degrees. chip: ChipParameters.
    phase: 8-bit binary angle of atan2(i270 - i90, i0 - i180) [Jayasuriya2017, Eq. 5.3 with both signs].
    amplitude: max(|x|, |y|), 1..255, or 0 where it is under ``noise_floor`` or there is no phase at all.
    """
    taps = np.asarray(taps, np.int32)
    x, y = taps[..., 0] - taps[..., 2], taps[..., 3] - taps[..., 1]
    found = divide(chip.divider, chip.n_frac, chip.cordic_iterations, x, y, noise_floor)
    return found.phase.astype(np.int16), np.where(found.amp_valid, found.amp, 0).astype(np.int16)
