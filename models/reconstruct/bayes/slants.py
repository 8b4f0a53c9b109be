"""Slanted planes of a scene: which slants its disparity has, and values that follow a plane.

A hypothesis of a slant is a plane's disparity at the middle of each block. A pixel off the middle sees another
disparity, and a neighbour with the same plane has a third: values move between hypotheses, linearly.
"""

import math

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter, gaussian_filter1d

from talbot.models.reconstruct.bayes.evidence import REACH

Floats = npt.NDArray[np.floating]
Slant = tuple[float, float]
AROUND = 6.0  # px, standard deviation of the weights of the pixels that tell a slant
STEP = 0.04  # of a slant down or across: over a window it is half a disparity
STEEP = 6  # steps at most
SHARE = 0.02  # of the pixels that a slant must have
RIDGE = 1e-3  # px^2, of arrays of one row or column
ROUGH = 0.1  # px, rms distance from the plane above which pixels give none


def slants_of(disparity: Floats, spread: Floats, most: int) -> list[Slant]:
    """Slants that a share of the pixels have, the most frequent first; none where planes face the camera.

    disparity, spread: (rows, cols), mean of the disparity's probability and its standard deviation, px per view step.
    most: how many slants are given, 0 or more. Returns list of tuple: by how much the disparity grows a pixel down and
    across: whole numbers of STEP.
    """
    weight = 1 / (np.square(spread) + ROUGH**2)
    y, x = (p - p.mean() for p in np.indices(disparity.shape, float))

    def mean(values: Floats) -> Floats:
        return np.asarray(gaussian_filter(weight * values, AROUND) / total)

    total = gaussian_filter(weight, AROUND)
    values = y, x, disparity
    means = [mean(v) for v in values]
    yy, yx, yd, xx, xd, dd = (mean(values[i] * values[j]) - means[i] * means[j] for i in range(3) for j in range(i, 3))
    yy, xx = yy + RIDGE, xx + RIDGE
    over = yy * xx - yx**2
    down, across = (yd * xx - xd * yx) / over, (xd * yy - yd * yx) / over
    residual = dd - down * yd - across * xd
    told = residual < ROUGH**2
    steps = np.rint(np.stack([down, across])[:, told] / STEP).astype(int)
    kinds, counts = np.unique(steps, axis=1, return_counts=True)
    order = np.argsort(-counts, kind="stable")
    kept = (kinds[:, k] for k in order if counts[k] >= SHARE * disparity.size)
    slants = [(float(STEP * a), float(STEP * b)) for a, b in kept if (a or b) and max(abs(a), abs(b)) <= STEEP]
    return slants[:most]


def moved(values: Floats, steps: Floats | float) -> Floats:
    """Values at other places along the first axis, linear between, the ends repeated.

    values: (n, rows, cols), the values. steps: (rows, cols), by how many to go up. Returns (n, rows, cols), at each
    index plus ``steps``.
    """
    whole = np.floor(steps).astype(int)
    part = (steps - whole).astype(values.dtype)
    index, last = np.arange(len(values))[:, None, None] + whole, len(values) - 1
    if index.shape[1:] == (1, 1):
        low, high = (values[np.clip(index.ravel() + k, 0, last)] for k in (0, 1))
    else:
        low, high = (np.take_along_axis(values, np.clip(index + k, 0, last), 0) for k in (0, 1))
    return low + part * (high - low)


def along(values: Floats, pool: float, axis: int, slope: float) -> Floats:
    """Gaussian mean along an axis of the picture that goes up with a plane; the weights as in `evidence.pooled`.

    values: (disparities, rows, cols), by the pixel's disparity. pool: standard deviation of the weights, px. axis: 1 is
    down, 2 across. slope: disparities a pixel. Returns (disparities, rows, cols), the means.
    """
    if not slope:
        return np.asarray(gaussian_filter1d(values, pool, axis, truncate=REACH))
    reach = math.floor(REACH * pool + 0.5)
    out, total = np.zeros_like(values), np.zeros(values.shape[axis], values.dtype)
    size = values.shape[axis]
    for tap in range(max(-reach, 1 - size), min(reach, size - 1) + 1):
        weight = values.dtype.type(math.exp(-((tap / pool) ** 2) / 2))
        here = [slice(None)] * 3
        there = [slice(None)] * 3
        here[axis], there[axis] = slice(max(-tap, 0), size - max(tap, 0)), slice(max(tap, 0), size - max(-tap, 0))
        out[tuple(here)] += weight * moved(values[tuple(there)], slope * tap)
        total[here[axis]] += weight
    shape = [1, 1, 1]
    shape[axis] = size
    return out / total.reshape(shape)
