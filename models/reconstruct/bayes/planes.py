"""Covariances of the samples of a window and of the views of its block, where both show a slanted plane of texture.

The texture is on the pixels' grid of the middle view, interpolated between them, so that samples and views are matrices
times texture: no covariance of theirs can be indefinite.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.reconstruct.bayes.prior import FieldPrior

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]
SHARP = -0.5  # of cubic convolution [Keys1981]
REACH = 2  # px from a point to the farthest that it is interpolated from
ROUNDED = 4  # px, to which the texture is enlarged: few sizes, whose roots are kept


class Plane(NamedTuple):
    """A plane of the scene, as the middle view sees it.

    disparity: at the middle of a window, px per view step.
    slant: by how much it grows a pixel down and across.
    """

    disparity: float
    slant: tuple[float, float] = (0.0, 0.0)

    def seen(self, y: Floats, x: Floats, dv: Floats, du: Floats) -> tuple[Floats, Floats]:
        """Places in the middle view of what other views see at pixels.

        y, x: (n, 1), pixels, from the middle of the window. dv, du: (views,), steps from the middle view. Returns (n,
        views), down and across.
        """
        down, across = self.slant
        grown = (self.disparity + down * y + across * x) / (1 - down * dv - across * du)
        return y + dv * grown, x + du * grown


@dataclass(frozen=True, eq=False)
class Window:
    """Samples of a window.

    size: its rows and columns.
    y, x: (samples,), pixel of each, in it.
    weights: (samples, pupil, pupil), of each over the pupil.
    block: first pixel of the block in it, down and across, then the block's pixels.
    views: that are to be given back along the pupil's diameter.
    side: side in px of the square around y, x that every sample is the mean of; odd.
    """

    size: tuple[int, int]
    y: Ints
    x: Ints
    weights: Floats
    block: tuple[int, int, int, int]
    views: int
    side: int = 1

    def covariances(
        self, plane: Plane, prior: FieldPrior, views: bool = True
    ) -> tuple[npt.NDArray[np.float64], Floats | None]:
        """Return the covariances of a plane.

        plane: what the window shows. prior: its texture. views: also those of the block's views. Returns (samples,
        samples), of samples with samples, without noise, and of the views of the block with samples; None without them.
        """
        seen, view_points, index, first, size = self.texture(plane)
        root = _root(size[0], size[1], prior)
        down, across = (self._taps(s - f, n) for s, f, n in zip(seen, first, size, strict=True))
        weights = self.weights.reshape(len(index), 1, -1).astype(np.float32)
        samples = np.matmul(weights * down.transpose(0, 2, 1)[index], across[index]).reshape(len(index), -1) @ root
        exact = samples.astype(float)  # float32 would leave variances below 0 where noise is little
        shared = exact @ exact.T
        if not views:
            return shared, None
        down, across = (_taps(w - f, n) for w, f, n in zip(view_points, first, size, strict=True))
        taps = (down[..., :, None] * across[..., None, :]).reshape(-1, size[0] * size[1])
        return shared, taps @ (root @ samples.T)

    def _taps(self, places: Floats, count: int) -> npt.NDArray[np.float32]:
        """Weights as of `_taps`, mean over the square: the plane counts as even within it."""
        more = self.side // 2
        return np.mean([_taps(places + step, count) for step in range(-more, more + 1)], 0)

    def texture(self, plane: Plane) -> tuple[Floats, Floats, Ints, list[int], list[int]]:
        """Find the part of the texture that a plane is seen in.

        plane: what the window shows. Returns tuple: where every ray of the window's pixels sees it, float64 (2, pixels,
        pupil**2), and every view of the block's, (2, block's pixels, views**2); the pixel of each sample; first pixel
        down and across, and size.
        """
        top, left, high, wide = self.block
        middle = (np.array(self.size)[:, None, None] - 1) / 2
        places, index = np.unique(np.stack([self.y, self.x]), axis=1, return_inverse=True)
        pupil = self.weights.shape[1]
        # From the middle for the plane, and back to the pixels' own places
        seen = plane.seen(*(places[..., None] - middle), *_steps(pupil, self.views / pupil)) + middle
        block = np.indices((high, wide)).reshape(2, -1, 1) + np.array([top, left])[:, None, None]
        view_points = plane.seen(*(block - middle), *_steps(self.views, 1.0)) + middle
        more = self.side // 2
        first = [math.floor(min(s.min() - more, w.min())) - 1 for s, w in zip(seen, view_points, strict=True)]
        last = [math.floor(max(s.max() + more, w.max())) + 3 for s, w in zip(seen, view_points, strict=True)]
        size = [math.ceil((end - begin + 1) / ROUNDED) * ROUNDED for begin, end in zip(first, last, strict=True)]
        return seen, view_points, index, first, size


def texture_points(size: tuple[int, int], views: int, disparity: float, slant: tuple[float, float]) -> float:
    """Bound the texture that any plane of a slant is seen in.

    size: rows and columns of a window. views: along the pupil's diameter. disparity: the largest in the window's
    middle, px per view step, 0 or more. slant: down and across. Returns pixels; infinite where a ray sees the plane
    from its edge.
    """
    steep = (abs(slant[0]) + abs(slant[1])) * views / 2
    if steep >= 1:
        return math.inf
    grown = disparity + (abs(slant[0]) * size[0] + abs(slant[1]) * size[1]) / 2
    more = views * grown / (1 - steep) + 5 + ROUNDED
    return (size[0] + more) * (size[1] + more)


def _steps(count: int, step: float) -> Floats:
    """Steps of all views from the middle one, (2, count**2)."""
    return (np.indices((count, count)).reshape(2, -1) - (count - 1) / 2) * step


def _taps(places: Floats, count: int) -> npt.NDArray[np.float32]:
    """Weights of ``count`` pixels in what is interpolated at ``places`` (n, views), (n, views, count): [Keys1981]."""
    whole = np.floor(places).astype(int)
    part = (places - whole).astype(np.float32)
    out = np.zeros((places.size, count), np.float32)
    rows, columns = np.arange(places.size), whole.ravel()
    for tap in range(1 - REACH, REACH + 1):
        away = np.abs(part - tap).ravel()
        near = ((SHARP + 2) * away - (SHARP + 3)) * away**2 + 1
        far = SHARP * (((away - 5) * away + 8) * away - 4)
        out[rows, columns + tap] = near if tap in (0, 1) else far
    return out.reshape(*places.shape, count)


@lru_cache(maxsize=32)
def _root(high: int, wide: int, prior: FieldPrior) -> npt.NDArray[np.float32]:
    """Return a root of the covariance of the texture's pixels."""
    y, x = np.indices((high, wide), float).reshape(2, -1)
    covariance = prior.covariance(y[:, None] - y, x[:, None] - x)
    covariance[np.diag_indices(len(y))] += 1e-9
    return np.linalg.cholesky(covariance).astype(np.float32)
