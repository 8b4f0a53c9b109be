"""Evidence of a disparity: its prediction of each pixel's difference from the window's other samples, pooled.

A sample of a Gaussian window of precision P is predicted from the others with the error (P i)_j / P_jj, of variance
1 / P_jj. Errors of single pixels know where a surface ends, and their pool is as small as the noise lets it be.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import cholesky, solve_triangular
from scipy.ndimage import gaussian_filter

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]
REACH = 2.0  # standard deviations, of the pool
FLOOR = 0.05  # of a sample's variance, below which disparities count as equally good


class Residuals(NamedTuple):
    """The map of a window's samples to the errors of its block's differences, each over its standard deviation.

    matrix: (pixels * samples of each, samples), of the telling samples of a block's pixels, first of all pixels; 0 for
        one that is not read.
    certain: (pixels,), logarithm of 1 over each error's variance, sum over a pixel.
    """

    matrix: Floats
    certain: Floats

    @classmethod
    def of(cls, inverse: Floats, rows: Ints, places: Ints, pixels: int) -> "Residuals":
        """Take the block's differences out of a window's precision.

        inverse: (samples, samples), `whitener` of the samples' covariance. rows: (n,), which samples they are. places:
        (n,), their pixels in the block. pixels: of the block. Returns Residuals: for this window.
        """
        precision = inverse[:, rows].T @ inverse
        diagonal = precision[np.arange(len(rows)), rows]
        earlier = np.array([np.count_nonzero(places[:i] == place) for i, place in enumerate(places)], int)
        matrix = np.zeros((max(earlier.max(initial=0) + 1, 1), pixels, len(inverse)), np.float32)
        certain = np.zeros(pixels, np.float32)
        matrix[earlier, places] = precision / np.sqrt(diagonal)[:, None]
        np.add.at(certain, places, np.log(diagonal))
        return cls(matrix.reshape(-1, len(inverse)), certain)

    def squares(self, samples: Floats) -> Floats:
        """Return the squares of the errors, sum over each pixel.

        samples: (samples, windows), of the windows. Returns (pixels, windows), the squares.
        """
        return np.square(self.matrix @ samples).reshape(-1, len(self.certain), samples.shape[1]).sum(0)


def whitener(shared: Floats) -> Floats:
    """Matrix that makes samples white: the inverse of their covariance's Cholesky factor.

    shared: (samples, samples), the covariance. Returns (samples, samples), lower triangular.
    """
    return solve_triangular(cholesky(shared, lower=True), np.eye(len(shared)), lower=True)


def pooled(values: Floats, pool: float) -> Floats:
    """Mean around each pixel.

    values: (rows, cols), of the pixels. pool: standard deviation of the weights, px. Returns (rows, cols), the means.
    """
    return gaussian_filter(values, pool, truncate=REACH)


def badness(squares: Floats, certain: Floats, count: float) -> Floats:
    """-2 log p of errors of an unknown common scale: a Student's t.

    squares: mean square of the errors, each over its standard deviation. certain: mean logarithm of 1 over their
    variances. count: how many errors there are. Returns lower is more probable.
    """
    return count * (np.log(squares + FLOOR) - certain)


def probability(scores: Floats, unlikely: float) -> Floats:
    """Probabilities from scores.

    scores: (disparities, ...), -2 log p of each. unlikely: share of the sum below which a probability is 0. Returns
    (disparities, ...), of sum 1.
    """
    chance = np.exp(-(scores - scores.min(0)) / 2)
    chance[chance < unlikely * chance.sum(0)] = 0
    return chance / chance.sum(0)
