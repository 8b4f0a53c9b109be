"""Disparity without highlights: a mirror image is at another depth than the surface that shows it."""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError

Floats = npt.NDArray[np.floating]
Bools = npt.NDArray[np.bool_]
AROUND = 3.0  # px, standard deviation of the weights of what is around a highlight
REACH = 4.0  # standard deviations, beyond which nothing counts
SPREAD_MIN = 0.05  # px per view step: no disparity is surer


def without_highlights(disparity: Floats, spread: Floats, tags: Bools, sure: float = 0.5) -> tuple[Floats, Floats]:
    """Replace the disparity of tagged pixels by that of the reliable ones around them.

    disparity: (rows, cols), in px per view step. spread: (rows, cols), its standard deviation, 0 or more; infinite
    where it is not known. tags: (rows, cols), pixels that are not to be believed, as of `polarization.specular_tags`.
    sure: greatest spread of a pixel that counts, greater than 0. Returns (rows, cols), disparity and spread; others are
    unchanged. Where no reliable pixel is around, the disparity stays and its spread is infinite. Raises ParameterError
    for shapes that differ, or a ``sure`` that is not positive. Source: [Jayasuriya2017], Sec. 4.2.
    """
    if not disparity.shape == spread.shape == tags.shape:
        raise ParameterError(f"tags shape = {tags.shape}: must be {disparity.shape}, as disparity and spread")
    if not sure > 0:
        raise ParameterError(f"sure = {sure:g}: must be greater than 0")
    weight = np.where(tags | (spread > sure), 0, 1 / np.maximum(spread, SPREAD_MIN) ** 2)
    values = np.where(weight > 0, disparity, 0)
    total, first, second = (_around(weight * values**power) for power in (0, 1, 2))
    known = total > 1e-6 / sure**2
    safe = np.where(known, total, 1)
    mean = first / safe
    width = np.sqrt(np.maximum(second / safe - mean**2, SPREAD_MIN**2))
    filled = np.where(known, mean, disparity), np.where(known, width, np.inf)
    return np.where(tags, filled[0], disparity), np.where(tags, filled[1], spread)


def _around(values: Floats) -> Floats:
    from scipy.ndimage import gaussian_filter  # it imports for long

    return gaussian_filter(values, AROUND, truncate=REACH, mode="constant")
