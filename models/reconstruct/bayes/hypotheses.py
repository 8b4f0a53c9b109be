"""All disparities of one slant as hypotheses: how probable the samples make each, and its solvers."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from talbot.models.reconstruct.bayes.blocks import Blocks, Kind, Pair, kind
from talbot.models.reconstruct.bayes.evidence import Residuals, badness, pooled
from talbot.models.reconstruct.bayes.prior import FieldPrior
from talbot.models.reconstruct.bayes.scene import Solver
from talbot.models.reconstruct.bayes.slants import Slant, along, moved
from talbot.models.reconstruct.bayes.windows import Windows

Floats = npt.NDArray[np.floating]


# Of the disparity's number, in a group's windows
Make = Callable[[int, Pair], Solver]


class Hypotheses:
    """The hypotheses of a slant.

    slant: by how much the disparity grows a pixel down and across.
    blocks: of the array.
    prior: what is known before.
    read: (rows, cols), share of the pixels around each that are read.
    residuals: of every disparity, in every group.
    make: gives a disparity's solver.
    """

    def __init__(
        self,
        slant: Slant,
        blocks: Blocks,
        prior: FieldPrior,
        read: Floats,
        residuals: list[list[Residuals]],
        make: Make,
    ) -> None:
        self.slant, self.blocks, self.prior, self.read, self.make = slant, blocks, prior, read, make
        self._residuals = residuals
        certain = np.stack([blocks.map(r.certain for r in groups) for groups in residuals])
        self._certain = self._around(certain)
        self._solvers: dict[tuple[int, Kind], Solver] = {}

    def scores(self, groups: Windows) -> Floats:
        """Return -2 log p of every disparity, times trust.

        groups: samples that tell the disparity. Returns (disparities, rows, cols), by the disparity of the pixel.
        """
        errors = np.stack(
            [
                self.blocks.map(
                    residual.squares(samples) for (*_, samples), residual in zip(groups, residuals, strict=True)
                )
                for residuals in self._residuals
            ]
        )
        errors = badness(self._around(errors), self._certain, self.blocks.pooled_errors(self.prior.width))
        return np.asarray(self.prior.trust * errors, np.float32)

    def solver(self, number: int, group: Pair) -> Solver:
        """Return the map of a group's samples to the views of its blocks, cached.

        number: of the disparity. group: down and across. Returns the estimator, of views as they are, not
        `scene.raised`.
        """
        key = number, kind(*group)
        if key not in self._solvers:
            self._solvers[key] = self.make(number, group)
        return self._solvers[key]

    def at_blocks(self, values: Floats) -> Floats:
        """Values by the disparity at the window's middle, of those by the pixel's.

        values: (disparities, rows, cols), by the disparity of the pixel. Returns (disparities, rows, cols), 0 beyond
        the ends.
        """
        if self.slant == (0.0, 0.0):
            return values
        return moved(np.pad(values, ((1, 1), (0, 0), (0, 0))), self._ahead)[1:-1]

    def _around(self, values: Floats) -> Floats:
        """Mean around each pixel along the plane that it is on, by its disparity, of values by that of the window."""
        pool, step = self.prior.width, self.prior.fine_step
        if self.slant == (0.0, 0.0):
            return np.stack([pooled(part, pool) for part in values]) / self.read
        values = moved(values, -self._ahead)
        for axis, slope in enumerate(self.slant, 1):
            values = along(values, pool, axis, slope / step)
        return values / self.read

    @property
    def _ahead(self) -> Floats:
        """Disparities, in steps, by which a pixel is before the middle of its window."""
        ahead = np.tensordot(np.array(self.slant, np.float32), self.blocks.from_middle, 1)
        return np.asarray(ahead / np.float32(self.prior.fine_step))
