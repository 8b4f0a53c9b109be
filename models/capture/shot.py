"""Photon shot noise of one pixel, independent of its neighbours.

The Poisson draws of a generator consume more or fewer random bits depending on the mean: leaving one pixel out would
change the noise of all that follow. Here every count is a function of one normal deviate.
"""

import math
from typing import Any

from numba import vectorize

FEW = 60.0  # electrons


@vectorize(["float32(float32, float32)", "float64(float64, float64)"], cache=True)
def photon_count(mean: Any, z: Any) -> Any:  # arrays outside, scalars inside
    """Poisson count at the quantile of a standard normal deviate.

    Few photons: the distribution function is inverted. Many: the Cornish-Fisher expansion, rounded.

    Parameters
    ----------
    mean : float32 or float64
        Expected electrons, 0..1e15; broadcastable.
    z : float32 or float64
        Standard normal deviate; broadcastable.

    Returns
    -------
    float32 or float64
        Whole electrons.
    """
    if mean > FEW:
        return max(0.0, math.floor(mean + math.sqrt(mean) * z + (z * z - 1) / 6 + 0.5))
    target = 0.5 * math.erfc(-z / math.sqrt(2.0))
    term = math.exp(-mean)
    total, k = term, 0
    while total < target and k < 4 * FEW:
        k += 1
        term *= mean / k
        total += term
    return k
