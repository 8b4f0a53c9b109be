"""Measured responses as tables, for pixels that are not of the form of Eq. 3.1: those of gratings in real metal.

The residual of Eq. 3.1 at the type's level is a Gaussian process over the two angles to the lines, whose
lengths and strength are those of greatest likelihood [RasmussenWilliams2006, Sec. 5.4.1]. Noise stays out of the table
as far as the samples tell it from the response, and a residual that is all noise leaves Eq. 3.1 alone.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from talbot.models.calibrate.sweep import Floats
from talbot.models.parameters import PixelType
from talbot.models.pixel.response import aperture
from talbot.models.pixel.table import TableResponse

ROUGH = 0.03  # RMS of difference over sum that Eq. 3.1 leaves, of the middle type, from which on types have tables
ALONG = 0.012, 0.02, 0.035, 0.06, 0.12  # rad: lengths over which a response changes, across and along its lines
ACROSS = 0.06, 0.12, 0.25, 0.5
STRENGTHS = 0.0, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5  # variance of the residual over that of the noise
GRID = 121, 13  # angles of a table
SOURCE = "CALIBRATION"


class Samples(NamedTuple):
    """The measurements of a type.

    theta: (n, 2), angles (y, x) of the rays in rad.
    diodes: (n, 2), signals over aperture and vignetting, in any unit that all types share.
    weight: (n,), inverse standard deviation of the signals, in any unit.
    """

    theta: Floats
    diodes: Floats
    weight: Floats


def tables(kinds: Sequence[PixelType], samples: Sequence[Samples], sigma: float) -> tuple[PixelType, ...]:
    """Return pixel types with a table each instead of Eq. 3.1.

    kinds: beta, gamma, alpha and m of Eq. 3.1 as fitted. samples: of the same types; none where a type was not seen.
    sigma: of the aperture in rad. Returns levels against the mean of all types; a type without samples stays as it is.
    """
    levels = [part.diodes.mean() for part in samples if len(part.theta)]
    level, reach = float(np.mean(levels)), max(float(np.abs(part.theta).max(initial=0)) for part in samples)
    return tuple(
        replace(kind, response=_response(kind, part._replace(diodes=part.diodes / level), sigma, reach))
        if len(part.theta)
        else kind
        for kind, part in zip(kinds, samples, strict=True)
    )


def _response(kind: PixelType, part: Samples, sigma: float, reach: float) -> TableResponse:
    turned = _turned(part.theta, kind.gamma)
    wave, level = _wave(kind, turned), part.diodes.mean()
    residual = part.diodes - level * wave
    axes = np.linspace(-reach, reach, GRID[0]), np.linspace(0, reach, GRID[1])
    along, across = (grid.ravel() for grid in np.meshgrid(*axes, indexing="ij"))
    points = np.stack([along, across], 1)
    rho = level * _wave(kind, points) + _interpolated(turned, residual, part.weight, points)
    tangents = np.tan(points)
    x, y = (
        np.arctan(tangents[:, 0] * np.cos(kind.gamma) - tangents[:, 1] * np.sin(kind.gamma)),
        np.arctan(tangents[:, 0] * np.sin(kind.gamma) + tangents[:, 1] * np.cos(kind.gamma)),
    )
    values = np.maximum(rho * aperture(x, y, sigma)[:, None], 0)
    return TableResponse(*axes, values.T.reshape(2, *GRID), kind.gamma, SOURCE)


def _turned(theta: Floats, gamma: float) -> Floats:
    """Angles (along the period, |along the lines|) of rays."""
    y, x = np.tan(theta).T
    across = np.abs(np.arctan(y * np.cos(gamma) - x * np.sin(gamma)))
    return np.stack([np.arctan(x * np.cos(gamma) + y * np.sin(gamma)), across], 1)


def _wave(kind: PixelType, turned: Floats) -> Floats:
    """Both diodes by Eq. 3.1 without the aperture, (n, 2)."""
    q = (kind.m or 0.0) * np.cos(kind.beta * turned[:, 0] + kind.alpha)
    return np.stack([1 + q, 1 - q], 1)


def _interpolated(at: Floats, residual: Floats, weight: Floats, points: Floats) -> Floats:
    """The residual at ``points``, (m, 2), from ``residual`` (n, 2) at ``at``, with likeliest lengths and strength."""
    scale = weight / weight.mean()  # with which all samples have one noise
    best, chosen = -np.inf, np.zeros((len(points), residual.shape[1]))
    for lengths in product(ALONG, ACROSS):
        values, vectors = np.linalg.eigh(scale[:, None] * _like(at, at, lengths) * scale)
        turned = vectors.T @ (scale[:, None] * residual)
        for strength in STRENGTHS:
            total = 1 + strength * np.maximum(values, 0)
            spread = max(float((turned**2 / total[:, None]).mean()), 1e-300)
            evidence = -residual.shape[1] / 2 * np.log(total).sum() - residual.size / 2 * np.log(spread)
            if evidence > best:
                solved = scale[:, None] * (vectors @ (turned / total[:, None]))
                best, chosen = evidence, strength * _like(points, at, lengths) @ solved
    return chosen


def _like(a: Floats, b: Floats, lengths: tuple[float, float]) -> Floats:
    """Likeness of responses at two sets of angles: once differentiable along the period, smooth along the lines."""
    along, across = (np.abs(np.subtract.outer(a[:, k], b[:, k])) / length for k, length in enumerate(lengths))
    return (1 + np.sqrt(3) * along) * np.exp(-np.sqrt(3) * along - across**2 / 2)
