"""The linear estimate of one scene: the covariances of all disparities, each weighted with its share of the scene."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve

from .evidence import Residuals, badness, pooled, probability, whitener
from .prior import FieldPrior

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]
ANY = 0.1  # of the scene: counts as being at any of the disparities


class Scene:
    """Makes the filters of a group of windows from the disparities that their samples show.

    Parameters
    ----------
    ways : sequence of (float64 (samples, samples), float64 (pixels * views**2, samples))
        For each disparity the covariance of the samples, and that of the block's views with them.
    rows, places, pixels
        As of `Residuals.of`.
    prior : FieldPrior
        The prior.
    """

    def __init__(
        self, ways: Sequence[tuple[Floats, Floats]], rows: Ints, places: Ints, pixels: int, prior: FieldPrior
    ) -> None:
        self.prior, self.pixels, self.read = prior, pixels, max(len(places), 1)
        self.shared, self.field = (np.stack(part).astype(np.float32) for part in zip(*ways, strict=True))
        self.residuals = [Residuals.of(whitener(shared), rows, places, pixels) for shared, _ in ways]

    def filters(self, samples: Floats, blocks: tuple[int, int]) -> Floats:
        """Make the filters for this scene.

        Parameters
        ----------
        samples : float32 (samples, windows)
            Of all windows.
        blocks : (int, int)
            Down and across: windows in all.

        Returns
        -------
        float32 (pixels * views**2, samples)
            From samples to the views of a block.
        """
        share = self.share(samples, blocks).astype(np.float32)
        shared, field = (np.tensordot(share, part, 1) for part in (self.shared, self.field))
        return cho_solve(cho_factor(shared), field.T).T

    def share(self, samples: Floats, blocks: tuple[int, int]) -> Floats:
        """Share of each disparity in the scene, as its contrast weighs it.

        Parameters
        ----------
        samples, blocks
            As of `filters`.

        Returns
        -------
        float64 (disparities,)
            Of sum 1.
        """
        size = self.pixels**0.5  # of a block, px
        scores = []
        for residual in self.residuals:
            squares = np.square(residual.matrix @ samples).sum(0).reshape(blocks) / self.read
            certain = np.full(blocks, residual.certain.sum() / self.read, np.float32)
            scores.append(badness(pooled(squares, self.prior.pool / size), certain, 4 * np.pi * self.prior.pool**2))
        chance = probability(self.prior.trust * np.stack(scores), 0.0).reshape(len(scores), -1)
        weight = samples[: len(samples) // 2].var(0)
        found = chance @ weight / max(float(weight.sum()), 1e-12)
        return (1 - ANY) * found + ANY / len(found)
