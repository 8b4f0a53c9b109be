"""Reconstruction of the image from the decoded edge samples alone, where the disparity is known.

An edge sample is a difference over the lens: the sum of c[type, v, u] I(y + dv d, x + du d), with c = Wa - g Wb of sum
0 and d the disparity at the pixel (occlusion is not modelled). The result is the image with the least gradient that
explains the samples:

    argmin |D I - samples|^2 + smoothness |grad I|^2

by conjugate gradients, D applied and never built. For small disparities D is a derivative, so that plain conjugate
gradients converge slowly over large areas; the preconditioner is the inverse of the Laplacian, by cosine transforms.
A difference has no mean: the image has mean 0.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit
from talbot.models.parameters import ParameterError, SensorParameters, check_int, check_real
from talbot.models.pixel.weights import view_weights

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Solver:
    """Settings of the conjugate gradients.

    smoothness: weight of the gradient, 1e-9..1e3.
    iterations: limit, 1..10000.
    tolerance: relative residual at which the iteration ends, 0..1.
    """

    smoothness: float = 3e-3
    iterations: int = 20
    tolerance: float = 1e-3

    def __post_init__(self) -> None:
        check_real("smoothness", self.smoothness, 1e-9, 1e3)
        check_int("iterations", self.iterations, 1, 10_000)
        check_real("tolerance", self.tolerance, 0, 1)


class EdgeOperator:
    """D: from an image to the trimmed differences of all pixels, and back.

    sensor: the sensor.
    disparity: (rows, cols), px per view step.
    balance: (types,), capacitor ratio g of each pixel type.
    read: (rows, cols), pixels that have a sample; None is all.

    Raises ParameterError for a disparity of a wrong shape, or not finite.
    """

    def __init__(
        self,
        sensor: SensorParameters,
        disparity: npt.ArrayLike,
        balance: npt.ArrayLike,
        read: npt.NDArray[np.bool_] | None = None,
    ) -> None:
        shape = sensor.array.rows, sensor.array.cols
        if np.shape(disparity) != shape or not np.isfinite(disparity).all():
            raise ParameterError(f"disparity shape = {np.shape(disparity)}: must be {shape}, every value finite")
        weights = view_weights(sensor.tile, sensor.optics)
        self.weights = weights[:, 0] - np.asarray(balance, float)[:, None, None] * weights[:, 1]
        self.kinds = sensor.tile.type_map(*shape)
        if read is not None:
            self.kinds = np.where(read, self.kinds, -1)
        self.disparity, self.shape = np.ascontiguousarray(disparity, float), shape

    def forward(self, image: npt.ArrayLike) -> Floats:
        """Apply D.

        image: (rows, cols), relative radiance. Returns (rows, cols), trimmed differences, 0 where nothing is read.
        """
        out = np.zeros(self.shape)
        _gather(np.ascontiguousarray(image, float), self.disparity, self.kinds, self.weights, out)
        return out

    def transpose(self, samples: npt.ArrayLike) -> Floats:
        """Apply the transpose of D.

        samples: (rows, cols), trimmed differences; pixels that are not read do not count. Returns (rows, cols), image.
        """
        out = np.zeros(self.shape)
        _scatter(np.ascontiguousarray(samples, float), self.disparity, self.kinds, self.weights, out)
        return out


def image_from_edges(samples: npt.ArrayLike, operator: EdgeOperator, solver: Solver = Solver()) -> Floats:
    """Reconstruct an image from edge samples.

    samples: (rows, cols), decoded codes divided by the codes per unit of radiance (models.plan.codes_per_unit).
    operator: D. solver: settings. Returns (rows, cols), relative radiance of mean 0.
    """

    def _normal(image: Floats) -> Floats:
        return operator.transpose(operator.forward(image)) + solver.smoothness * laplacian(image)

    right = operator.transpose(samples)
    return _conjugate_gradients(_normal, right - right.mean(), _inverse_laplacian(operator.shape), solver)


def _conjugate_gradients(
    apply: Callable[[Floats], Floats], right: Floats, precondition: Callable[[Floats], Floats], solver: Solver
) -> Floats:
    """x of apply(x) = right, both (rows, cols), with the residual at most tolerance * |right|, or the last iteration's.

    Like scipy.sparse.linalg.cg, but without BLAS, whose threads stall one another where the cores are shared.
    """
    x, residual = np.zeros_like(right), right.copy()
    goal = solver.tolerance**2 * _dot(right, right)
    direction, energy = np.zeros_like(right), 0.0
    for _ in range(solver.iterations):
        if _dot(residual, residual) <= goal:
            break
        upward = precondition(residual)
        before, energy = energy, _dot(residual, upward)
        if energy <= 0:  # only the mean is left, which the preconditioner ignores
            break
        direction = upward + (energy / before if before else 0.0) * direction
        curved = apply(direction)
        step = energy / _dot(direction, curved)
        x += step * direction
        residual -= step * curved
    return x - x.mean()


def _dot(a: Floats, b: Floats) -> float:
    return float(np.einsum("yx,yx", a, b))


def laplacian(image: Floats) -> Floats:
    """Negative Laplacian grad' grad of an image with a free border.

    image: (rows, cols), the image. Returns (rows, cols), its sum is 0.
    """
    out = np.zeros_like(image)
    for axis in (0, 1):
        step = np.diff(image, axis=axis)
        pad = [(0, 0), (0, 0)]
        pad[axis] = (1, 1)
        out -= np.diff(np.pad(step, pad), axis=axis)
    return out


def _inverse_laplacian(shape: tuple[int, int]) -> Callable[[Floats], Floats]:
    """Return a function from an image to the mean-free solution of laplacian(solution) = image - mean(image)."""
    y, x = (2 - 2 * np.cos(np.pi * np.arange(n) / n) for n in shape)
    eigen = y[:, None] + x[None, :]
    eigen[0, 0] = np.inf
    from scipy.fft import dctn, idctn  # it imports for long

    return lambda image: np.asarray(idctn(np.asarray(dctn(image, norm="ortho")) / eigen, norm="ortho"))


@njit(cache=True)
def _gather(image: Floats, disparity: Floats, kinds: Ints, weights: Floats, out: Floats) -> None:
    views = weights.shape[1]
    middle = (views - 1) / 2
    rows, cols = image.shape
    for y in range(rows):
        for x in range(cols):
            kind = kinds[y, x]
            if kind < 0:
                continue
            d = disparity[y, x]
            total = 0.0
            for v in range(views):
                py = min(max(y + (v - middle) * d, 0.0), rows - 1.0)
                y0 = int(py)
                y1, ty = min(y0 + 1, rows - 1), py - y0
                for u in range(views):
                    px = min(max(x + (u - middle) * d, 0.0), cols - 1.0)
                    x0 = int(px)
                    x1, tx = min(x0 + 1, cols - 1), px - x0
                    upper = image[y0, x0] * (1 - tx) + image[y0, x1] * tx
                    lower = image[y1, x0] * (1 - tx) + image[y1, x1] * tx
                    total += weights[kind, v, u] * (upper * (1 - ty) + lower * ty)
            out[y, x] = total


@njit(cache=True)
def _scatter(samples: Floats, disparity: Floats, kinds: Ints, weights: Floats, out: Floats) -> None:
    views = weights.shape[1]
    middle = (views - 1) / 2
    rows, cols = samples.shape
    for y in range(rows):
        for x in range(cols):
            kind = kinds[y, x]
            if kind < 0:
                continue
            d = disparity[y, x]
            for v in range(views):
                py = min(max(y + (v - middle) * d, 0.0), rows - 1.0)
                y0 = int(py)
                y1, ty = min(y0 + 1, rows - 1), py - y0
                for u in range(views):
                    px = min(max(x + (u - middle) * d, 0.0), cols - 1.0)
                    x0 = int(px)
                    x1, tx = min(x0 + 1, cols - 1), px - x0
                    part = samples[y, x] * weights[kind, v, u]
                    out[y0, x0] += part * (1 - ty) * (1 - tx)
                    out[y0, x1] += part * (1 - ty) * tx
                    out[y1, x0] += part * ty * (1 - tx)
                    out[y1, x1] += part * ty * tx
