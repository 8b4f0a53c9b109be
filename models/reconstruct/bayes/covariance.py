"""Covariances of samples and of the light field that they are to give back, for one disparity.

A sample i at pixel x is the sum of W[i, v] I(x + v d) over the pupil, with I a plane of texture whose covariance is the
prior's. Two samples at a distance D then have the covariance  sum over s of G[s, i, j] C(D + s d),  with G the
correlation of their weights over the pupil: a table over distances and pairs of diodes is all that every window needs.
Where a sample is the mean of a square of pixels, C is that of such means.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from talbot.models.reconstruct.bayes.prior import FieldPrior

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


class Tables(NamedTuple):
    """Covariances for one disparity, or their mean over several.

    samples: (2 height - 1, 2 width - 1, diodes, diodes), of two samples, at their distance.
    field: (2 height - 1, 2 width - 1, views * views, diodes), of a pixel's views with a sample, at the distance from
        the pixel to the sample.
    """

    samples: Floats
    field: Floats


@dataclass(frozen=True, eq=False)
class Covariances:
    """Makes the tables.

    weights: (diodes, pupil, pupil), weights of all diodes of a tile over the pupil.
    views: of the light field that is to be given back, along the pupil's diameter.
    height, width: window in px.
    prior: the prior.
    side: side in px of the square that every sample is the mean of.
    """

    weights: Floats
    views: int
    height: int
    width: int
    prior: FieldPrior
    side: int = 1

    @cached_property
    def _correlations(self) -> Floats:
        """G, (shifts, diodes * diodes)."""
        diodes, pupil, _ = self.weights.shape
        size = 2 * pupil - 1
        waves = np.fft.fft2(self.weights, (size, size))
        pairs = np.fft.ifft2(np.conj(waves)[:, None] * waves[None]).real
        return np.ascontiguousarray(np.fft.fftshift(pairs, (2, 3)).reshape(diodes**2, size**2).T)

    def of(self, disparity: float) -> Tables:
        """Tables for a disparity.

        disparity: in px per view step. Returns the covariances.
        """
        diodes, pupil, _ = self.weights.shape
        step = disparity * self.views / pupil
        shift = np.arange(1 - pupil, pupil) * step
        samples = self._squares(shift, 2) @ self._correlations
        seen = (np.arange(pupil) - (pupil - 1) / 2) * step
        shifts = (np.arange(self.views) - (self.views - 1) / 2) * disparity
        ahead = (seen - shifts[:, None]).ravel()
        field = self._squares(ahead, 1)
        field = field.reshape(-1, self.views, pupil, self.views, pupil).transpose(0, 1, 3, 2, 4).reshape(-1, pupil**2)
        field = field @ self.weights.reshape(diodes, -1).T
        shape = 2 * self.height - 1, 2 * self.width - 1
        return Tables(samples.reshape(*shape, diodes, diodes), field.reshape(*shape, self.views**2, diodes))

    def _squares(self, shift: Floats, squares: int) -> Floats:
        """Covariance at all distances in a window plus all shifts (n,), (distances, n**2), of means over squares.

        squares: 1 where one of two points is such a mean, 2 where both are.
        """
        more = squares * (self.side - 1) // 2
        dy, dx = (np.arange(1 - n - more, n + more, dtype=float)[:, None] for n in (self.height, self.width))
        out = self._planes(dy + shift, dx + shift)
        if not more:
            return out
        out = out.reshape(len(dy), len(dx), -1)
        for _ in range(squares):
            out = sliding_window_view(out, (self.side, self.side), (0, 1)).mean((-2, -1))
        return out.reshape(-1, len(shift) ** 2)

    def _planes(self, y: Floats, x: Floats) -> Floats:
        """Covariance at all places y (n, a) by x (m, b): (n * m, a * b); equal distances are computed together."""
        (down, row), (across, col) = (np.unique(np.abs(place), return_inverse=True) for place in (y, x))
        out = self.prior.covariance(down[:, None], across)
        return out[row.reshape(y.shape)[:, None, :, None], col.reshape(x.shape)[None, :, None]].reshape(
            len(y) * len(x), -1
        )

    def mean(self) -> Tables:
        """Tables of a light field whose disparity is any of the prior's, each as likely.

        Returns the covariances.
        """
        every = [self.of(float(d)) for d in self.prior.grid]
        return Tables(sum(t.samples for t in every) / len(every), sum(t.field for t in every) / len(every))  # type: ignore
