"""The linear estimate of one scene: covariances of all disparities, weighted as the windows around show them.

Windows that show like disparities are taken together: their covariance is the mean over the disparities, each with its
share of them, and gives one filter for all. The estimate is linear in the samples but for these shares.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve
from scipy.ndimage import gaussian_filter

from talbot.models.reconstruct.bayes.evidence import Residuals

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]
Factor = tuple[Floats, bool]  # of Cholesky, and whether it is the lower one
ANY = 0.01  # of a window: counts as being at any of the disparities
AROUND = 0.7  # standard deviation of the weights of the windows around, in windows
CLASSES = 20  # of windows with like shares, where a group is most of the frame
ROUNDS = 4  # of moving windows to the class that is nearest
ROUNDING = 1e-6  # of a sample's variance: what float32 leaves, so that no covariance is singular


class Ways(NamedTuple):
    """Covariances of a group of windows at every disparity.

    shared: (disparities, samples, samples), covariance of the samples.
    mean: (samples, samples), mean of these over the disparities.
    field: (disparities, pixels * views**2, samples), covariance of the block's views with them.
    residuals: for the evidence.
    read: differences of the block that are read, 1 or more.
    """

    shared: Floats
    mean: Floats
    field: Floats
    residuals: list[Residuals]
    read: int

    def estimate(self, samples: Floats, shares: Floats, parallax: float, views: int, whole: int) -> Floats:
        """Estimate the blocks from the samples of their windows.

        samples: (samples, windows), of all windows. shares: (disparities, windows), of every disparity in a window, of
        sum 1. parallax: factor on what differs between views. views: along the pupil's diameter. whole: windows of all
        groups. Returns (pixels * views**2, windows), the views of the blocks.
        """
        kinds = classes(shares, math.ceil(CLASSES * math.sqrt(samples.shape[1] / whole)))
        masks = [kinds == kind for kind in np.unique(kinds)]
        out = np.empty((self.field.shape[1], samples.shape[1]), np.float32)
        means = np.stack([shares[:, mine].mean(1) for mine in masks])
        for mine, solver in zip(masks, self.mixed(means, parallax, views), strict=True):
            out[:, mine] = solver(samples[:, mine])
        return out

    def mixed(self, shares: Floats, parallax: float, views: int) -> Iterator["Solver"]:
        """Make the estimators of windows whose disparities have some shares.

        shares: (classes, disparities), each of sum 1. parallax, views: as of `estimate`. Yields Solver: from samples to
        the views of a block, for each.
        """
        weights = shares.astype(np.float32)
        shared, field = (
            (weights @ part.reshape(len(part), -1)).reshape(-1, *part.shape[1:]) for part in (self.shared, self.field)
        )
        for view, other in zip(shared, raised(field, parallax, views), strict=True):
            yield Solver(factor(view), other)


class Solver(NamedTuple):
    """An estimator of windows of one covariance.

    factor: `factor` of the samples' covariance.
    field: (pixels * views**2, samples), covariance of the block's views with them.
    """

    factor: Factor
    field: Floats

    def __call__(self, samples: Floats) -> Floats:
        """Estimate the blocks.

        samples: (samples, windows), of the windows. Returns (pixels * views**2, windows), their views.
        """
        return self.field @ cho_solve(self.factor, samples, check_finite=False)


def factor(shared: Floats) -> Factor:
    """Factor a covariance of samples.

    shared: (samples, samples), the covariance; written over. Returns tuple: as of `scipy.linalg.cho_factor`.
    """
    diagonal = np.arange(len(shared))
    shared[diagonal, diagonal] *= 1 + ROUNDING
    return cho_factor(shared, overwrite_a=True, check_finite=False)


def raised(field: Floats, parallax: float, views: int) -> Floats:
    """Raise what differs between the views, in place.

    field: (..., pixels * views**2, samples), covariances of views with samples. parallax: factor. views: along the
    pupil's diameter. Returns ``field``.
    """
    each = field.reshape(*field.shape[:-2], -1, views**2, field.shape[-1])
    middle = (1 - parallax) * each.mean(-2, keepdims=True)
    each *= np.float32(parallax)
    each += middle
    return field


def shares_of(chance: Floats, contrast: Floats) -> Floats:
    """Shares of the disparities in every window, from the windows around, as their contrast weighs them.

    chance: (disparities, block rows, block cols), probability of each, of sum 1. contrast: (block rows, block cols),
    variance of a window. Returns (disparities, block rows, block cols), of sum 1, none of them 0.
    """
    weight = contrast + 1e-9 + 1e-3 * contrast.mean()
    pooled = np.stack([gaussian_filter(part * weight, AROUND) for part in chance])
    return (1 - ANY) * pooled / pooled.sum(0) + ANY / len(pooled)


def classes(shares: Floats, count: int) -> Ints:
    """Put windows into classes of like shares: k-means of their square roots, begun far apart.

    shares: (disparities, windows), of sum 1. count: of the classes at most, 1 or more. Returns (windows,), number of
    each window's class.
    """
    places = np.sqrt(shares.T)
    middles, away = places.mean(0)[None], np.full(len(places), np.inf)
    for _ in range(count - 1):
        away = np.minimum(away, np.square(places - middles[-1]).sum(1))
        middles = np.concatenate([middles, places[None, away.argmax()]])
    kinds = np.zeros(len(places), np.int64)
    for _ in range(ROUNDS if count > 1 else 0):
        kinds = np.argmax(2 * places @ middles.T - np.square(middles).sum(1), 1)
        for kind in np.unique(kinds):
            middles[kind] = places[kinds == kind].mean(0)
    return kinds
