"""Photon shot noise that a pixel draws by itself: what its neighbours see does not change it.

A generator's own Poisson draws take more or fewer random bits as the mean wants; then leaving one pixel out would
change the noise of all that follow. Here every count comes from one normal deviate.
"""

import math

from numba import vectorize

FEW = 60.0  # electrons


@vectorize(["float32(float32, float32)", "float64(float64, float64)"], cache=True)
def photon_count(mean, z):
    """The Poisson count of ``mean`` (0..1e15) at the quantile of the standard normal deviate ``z``: a whole number.

    Few photons: the distribution function is inverted. Many: Cornish and Fisher's expansion, rounded.
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
