"""All disparities of one slant as hypotheses: how probable the samples make each, and its filters."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .blocks import Blocks, Kind, Pair, kind
from .evidence import Residuals, badness, pooled, whitener
from .prior import FieldPrior
from .scene import Solver, raised
from .slants import Slant, along, moved
from .windows import Windows

Floats = npt.NDArray[np.floating]


class Covariance(NamedTuple):
    """Of one disparity in a group's windows.

    Attributes
    ----------
    shared : float64 (samples, samples)
        Of samples with samples, with noise.
    field : float32 (pixels * views**2, samples), or None
        Of the views of a block with samples.
    """

    shared: Floats
    field: Floats | None


# Of the disparity's number, in a group's windows, with its views or without
Make = Callable[[int, Pair, bool], Covariance]


class Hypotheses:
    """Of one slant.

    Parameters
    ----------
    slant : tuple of float
        By how much the disparity grows a pixel down and across.
    blocks : Blocks
        Of the array.
    prior : FieldPrior
        What is known before.
    read : array (rows, cols)
        Share of the pixels around each that are read.
    make : callable
        Gives a disparity's covariances.
    """

    def __init__(self, slant: Slant, blocks: Blocks, prior: FieldPrior, read: Floats, make: Make) -> None:
        self.slant, self.blocks, self.prior, self.read, self.make = slant, blocks, prior, read, make
        self.kinds = {kind(*group): group for group in blocks.groups}
        count = len(prior.fine)
        self._residuals = [self._evidence(number) for number in range(count)]
        certain = np.stack([blocks.map(r.certain for r in residuals) for residuals in self._residuals])
        self._certain = self._around(certain)
        self._filters: dict[tuple[int, Kind], Floats] = {}

    def _evidence(self, number: int) -> list[Residuals]:
        known: dict[tuple[int, int], Floats] = {}  # of windows that begin at the same place in a tile
        made = {}
        for key, group in self.kinds.items():
            if key[:2] not in known:
                known[key[:2]] = whitener(self.make(number, group, False).shared)
            made[key] = Residuals.of(known[key[:2]], *self.blocks.own(*group))
        return [made[kind(*group)] for group in self.blocks.groups]

    def scores(self, groups: Windows) -> Floats:
        """What trust leaves of -2 log p of every disparity.

        Parameters
        ----------
        groups : Windows
            Samples that tell the disparity.

        Returns
        -------
        float32 (disparities, rows, cols)
            By the disparity of the pixel.
        """
        found = np.stack(
            [
                self.blocks.map(
                    np.square(residual.matrix @ samples)
                    for (*_, samples), residual in zip(groups, residuals, strict=True)
                )
                for residuals in self._residuals
            ]
        )
        found = badness(self._around(found), self._certain, 4 * np.pi * self.prior.width**2)
        return np.asarray(self.prior.trust * found, np.float32)

    def filters(self, number: int, group: Pair, parallax: float, views: int) -> Floats:
        """From the samples of a group's windows to the views of their blocks, made where they are wanted, once.

        Parameters
        ----------
        number : int
            Of the disparity.
        group : tuple of Group
            Down and across.
        parallax, views
            As of `scene.Ways.estimate`.

        Returns
        -------
        float32 (pixels * views**2, samples)
            The filters.
        """
        key = number, kind(*group)
        if key not in self._filters:
            shared, field = self.make(number, group, True)
            assert field is not None
            self._filters[key] = Solver.of(shared.astype(np.float32), raised(field, parallax, views)).filters
        return self._filters[key]

    def at_blocks(self, values: Floats) -> Floats:
        """Values by the disparity at the window's middle, of those by the pixel's.

        Parameters
        ----------
        values : array (disparities, rows, cols)
            By the disparity of the pixel.

        Returns
        -------
        array (disparities, rows, cols)
            0 beyond the ends.
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
        ahead = np.tensordot(np.array(self.slant, np.float32), self.blocks.beside, 1)
        return np.asarray(ahead / np.float32(self.prior.fine_step))
