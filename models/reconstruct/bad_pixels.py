"""Pixels whose samples say nothing of the scene: dead ones, found from the samples alone."""

import numpy as np
import numpy.typing as npt
from scipy.ndimage import maximum_filter, median_filter

Floats = npt.NDArray[np.floating]
Bools = npt.NDArray[np.bool_]
NONE = 0.01  # of white: a dead pixel has less light
SOME = 0.1  # of white: the light around it, at least
AROUND = 7  # px, side of what is around: dead columns are less than half of it


def dead_pixels(pair: Floats) -> Bools:
    """Pixels without light amid light.

    pair: (2, rows, cols), both diodes of every pixel, 1 = the average diode in a flat white scene. Returns (rows,
    cols), the dead ones.
    """
    light = np.asarray(pair, float).mean(0)
    return (light < NONE) & (median_filter(light, AROUND) > SOME)


def repaired(pair: Floats, dead: Bools) -> Floats:
    """Samples with those of dead pixels replaced by the light around: a diode's share of a pixel without an angle.

    pair: (2, rows, cols), as for `dead_pixels`. dead: (rows, cols), pixels to replace. Returns (2, rows, cols), of the
    type of ``pair``.
    """
    if not dead.any():
        return pair
    light = np.asarray(pair, float).mean(0)
    return np.where(dead, median_filter(light, AROUND), pair).astype(pair.dtype)


def dilated(pixels: Bools, reach: int) -> Bools:
    """Dilate a mask of pixels.

    pixels: (..., rows, cols), pixels. reach: in px, along both axes. Returns (..., rows, cols), these, and all within
    reach.
    """
    size = 2 * reach + 1
    return np.asarray(maximum_filter(pixels, (1,) * (pixels.ndim - 2) + (size, size)), bool)
