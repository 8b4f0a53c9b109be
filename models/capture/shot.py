"""Photons and electrons of one pixel, independent of its neighbours.

The Poisson draws of a generator consume more or fewer random bits depending on the mean: leaving one pixel out would
change the noise of all that follow. Here every count is a function of one normal deviate.
"""

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit, vectorize

FEW = 60.0  # electrons
PHOTONS_MAX = 1e15  # electrons per diode and interval: far beyond any well

Floats = npt.NDArray[np.floating]


@njit(cache=True, nogil=True)
def _count(mean: Any, z: Any) -> Any:
    if mean > FEW:
        return max(0.0, math.floor(mean + math.sqrt(mean) * z + (z * z - 1) / 6 + 0.5))
    target = 0.5 * math.erfc(-z / math.sqrt(2.0))
    term = math.exp(-mean)
    total, k = term, 0.0
    while total < target and k < 4 * FEW:
        k += 1
        term *= mean / k
        total += term
    return k


@vectorize(["float32(float32, float32)", "float64(float64, float64)"], cache=True)
def photon_count(mean: Any, z: Any) -> Any:  # arrays outside, scalars inside
    """Poisson count at the quantile of a standard normal deviate.

    Few photons: the distribution function is inverted. Many: the Cornish-Fisher expansion, rounded.

    mean: expected electrons, 0..1e15; broadcastable. z: standard normal deviate; broadcastable. Returns whole
    electrons.
    """
    return _count(mean, z)


class Pixels(NamedTuple):
    """The diodes of an array, all of one type: float32 or float64.

    gain, offset: (2, rows, cols), of each diode: factor of its photocurrent, and electrons.
    numbers: (7,), electrons/s of a photocurrent of 1, electrons/s of dark current, electrons of a full well, electrons
        an LSB, factor of the shot noise, RMS of the read noise in electrons, PHOTONS_MAX.
    """

    gain: Floats
    offset: Floats
    numbers: Floats


@njit(cache=True, nogil=True)
def collect(wells: Floats, pair: Floats, pixels: Pixels, seconds: Any, z: Floats) -> None:
    """Add what the diodes collect in an interval, up to the full well, in place.

    wells: (2, rows, cols), electrons. pair: (2, rows, cols), relative photocurrents. pixels: the diodes. seconds: of
    the interval, of the arrays' type. z: (2, rows, cols), standard normal deviates; of no element where there is no
    noise.
    """
    unit, dark, full, _, noise, _, most = pixels.numbers
    zero = noise - noise
    counted = np.empty(1, wells.dtype)  # a count of the arrays' type
    for d in range(wells.shape[0]):
        for y in range(wells.shape[1]):
            for x in range(wells.shape[2]):
                mean = min((pair[d, y, x] * unit * pixels.gain[d, y, x] + dark) * seconds, most)
                if z.size:
                    counted[0] = _count(mean, z[d, y, x])
                    mean = max((counted[0] - mean) * noise + mean, zero)
                wells[d, y, x] = min(max(wells[d, y, x] + mean, zero), full)


@njit(cache=True, nogil=True)
def read(
    out: Floats, wells: Floats, pixels: Pixels, z: Floats, pink: Floats, rms: float, columns: Floats, noise: float
) -> None:
    """Read the electrons through the pixels and the columns' amplifiers.

    out: (rows, cols, 2), receives it, in LSB. wells: (2, rows, cols), electrons. pixels: the diodes. z: (2, rows,
    cols), standard normal deviates of the read noise; of no element where there is none. pink: (2, rows or more, cols),
    1/f noise of the columns, RMS 1; of no element where the columns add nothing. rms: of the 1/f noise in electrons.
    columns: (2, 1, cols), offsets of the columns in electrons. noise: factor of what the columns add.
    """
    lsb, read_noise = pixels.numbers[3], pixels.numbers[5]
    added = np.zeros(1, wells.dtype)  # a number of the arrays' type
    for d in range(wells.shape[0]):
        for y in range(wells.shape[1]):
            for x in range(wells.shape[2]):
                value = pixels.offset[d, y, x]
                if z.size:
                    value = value + z[d, y, x] * read_noise
                value = wells[d, y, x] + value
                if pink.size:
                    added[0] = (pink[d, y, x] * rms + columns[d, 0, x]) * noise
                    value = value + added[0]
                out[y, x, d] = value / lsb
