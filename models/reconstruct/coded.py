"""Depth from taps of coded light; surfaces before the first tap and behind the last one are not seen.

A tap is  B + A R(z - z_k)  with the triangle R of two chips: around a tap and the next their difference tells where
between the two the light is from, and their sum how much. Light from elsewhere adds the same to all four.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ElectricalParameters, ParameterError
from talbot.models.pixel.time_of_flight import SPEED_OF_LIGHT, code_correlation, tap_depths

Floats = npt.NDArray[np.floating]
GRID = 600  # depths between two taps
SURE = 4.0  # standard deviations of the taps that the light from within the gate must have
CHUNK = 1 << 14  # pixels at once


class Coded(NamedTuple):
    """Depth of the light from within the gate.

    depth: (...), in m, from the first to the last tap.
    amplitude: (...), a, in the unit of the taps, 0 or more.
    sure: (...), where there is enough of it, and not at an end of the gate.
    """

    depth: Floats
    amplitude: Floats
    sure: npt.NDArray[np.bool_]


def coded_depth(taps: Floats, electrical: ElectricalParameters, noise: Floats | float) -> Coded:
    """Depth by the best fit of B + A R to the taps.

    taps: (4, ...), of light that `ElectricalParameters.code` modulates. electrical: the modulation. noise: (...),
    standard deviation of a tap, greater than 0. Returns finite everywhere. Raises ParameterError without a code, or for
    a noise that is not greater than 0. Source: [Jayasuriya2017], Sec. 5.6.4; [Tadano2015].
    """
    if not electrical.code:
        raise ParameterError("code = 0: must be the chips of the light's code")
    if not np.min(noise) > 0:
        raise ParameterError(f"noise = {np.min(noise):g}: must be greater than 0")
    ends = tap_depths(electrical)
    depths = np.linspace(ends[0], ends[-1], 3 * GRID + 1)
    delays = 2 / SPEED_OF_LIGHT * (depths[:, None] - ends)
    shapes = code_correlation(delays, electrical.code, electrical.chip_rate)
    shapes = shapes - shapes.mean(1, keepdims=True)
    size = np.linalg.norm(shapes, axis=1)
    shapes = shapes / size[:, None]
    flat = np.reshape(np.asarray(taps, float), (4, -1))
    flat = flat - flat.mean(0)
    best, score = np.empty(flat.shape[1], int), np.empty(flat.shape[1])
    for start in range(0, flat.shape[1], CHUNK):
        part = slice(start, start + CHUNK)
        fits = shapes @ flat[:, part]
        best[part] = fits.argmax(0)
        score[part] = np.take_along_axis(fits, best[None, part], 0)[0]
    shape, inner = np.shape(taps)[1:], (best > 0) & (best < len(depths) - 1)
    score = np.maximum(score, 0).reshape(shape)
    residual = np.sqrt(np.maximum(np.sum(flat**2, 0).reshape(shape) - score**2, 0))
    sure = inner.reshape(shape) & (score > SURE * np.maximum(noise, residual / np.sqrt(2)))
    return Coded(depths[best].reshape(shape), score / size[best].reshape(shape), sure)
