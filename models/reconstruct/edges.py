"""The image back from the decoded edge samples alone, where the disparity is known.

An edge sample is a difference over the lens: the sum of c[type, v, u] I(y + dv d, x + du d), with c = Wa - g Wb of sum
0 and d the disparity at the pixel (what a nearer surface hides from some views is not modelled). Sought is the image
that explains them with the least gradient:

    argmin |D I - samples|^2 + smoothness |grad I|^2

by conjugate gradients, D applied and never built. For small disparities D is a derivative, so that plain conjugate
gradients creep over large areas; the inverse of the Laplacian, by cosine transforms, is the preconditioner that makes
them few. A difference knows no mean: the image has mean 0.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.fft import dctn, idctn

from models.parameters import ParameterError, check_int, check_real
from models.pixel.weights import view_weights


@dataclass(frozen=True)
class Solver:
    """smoothness: weight of the gradient, 1e-9..1e3. iterations: at most, 1..10000. tolerance: relative, 0..1."""

    smoothness: float = 1e-3
    iterations: int = 20
    tolerance: float = 1e-3

    def __post_init__(self):
        check_real("smoothness", self.smoothness, 1e-9, 1e3)
        check_int("iterations", self.iterations, 1, 10_000)
        check_real("tolerance", self.tolerance, 0, 1)


class EdgeOperator:
    """D: an image (rows, cols) to the trimmed differences of all pixels, and back. Float64.

    sensor: SensorParameters. disparity: px a view step, (rows, cols). balance: g of each pixel type, (types,).
    read: bool (rows, cols), pixels whose samples there are; None = all.
    """

    def __init__(self, sensor, disparity, balance, read=None):
        shape = sensor.array.rows, sensor.array.cols
        if np.shape(disparity) != shape or not np.isfinite(disparity).all():
            raise ParameterError(f"disparity shape = {np.shape(disparity)}: must be {shape}, every value finite")
        weights = view_weights(sensor.tile, sensor.optics)
        self.weights = weights[:, 0] - np.asarray(balance, float)[:, None, None] * weights[:, 1]
        self.kinds = sensor.tile.type_map(*shape)
        if read is not None:
            self.kinds = np.where(read, self.kinds, -1)
        self.disparity, self.shape = np.ascontiguousarray(disparity, float), shape

    def forward(self, image):
        out = np.zeros(self.shape)
        _gather(np.ascontiguousarray(image, float), self.disparity, self.kinds, self.weights, out)
        return out

    def transpose(self, samples):
        out = np.zeros(self.shape)
        _scatter(np.ascontiguousarray(samples, float), self.disparity, self.kinds, self.weights, out)
        return out


def image_from_edges(samples, operator, solver=Solver()):
    """The image of mean 0, (rows, cols), in the unit in which ``samples`` (rows, cols) measure radiance.

    samples: decoded codes divided by the codes that a radiance of 1 makes (models.plan.codes_per_unit).
    """

    def normal(image):
        return operator.transpose(operator.forward(image)) + solver.smoothness * laplacian(image)

    right = operator.transpose(samples)
    return _conjugate_gradients(normal, right - right.mean(), _inverse_laplacian(operator.shape), solver)


def _conjugate_gradients(apply, right, precondition, solver):
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
        if energy <= 0:  # nothing left but what the preconditioner is blind to: the mean
            break
        direction = upward + (energy / before if before else 0.0) * direction
        curved = apply(direction)
        step = energy / _dot(direction, curved)
        x += step * direction
        residual -= step * curved
    return x - x.mean()


def _dot(a, b):
    return float(np.einsum("yx,yx", a, b))


def laplacian(image):
    """grad' grad of an image, its border free: (rows, cols)."""
    out = np.zeros_like(image)
    for axis in (0, 1):
        step = np.diff(image, axis=axis)
        pad = [(0, 0), (0, 0)]
        pad[axis] = (1, 1)
        out -= np.diff(np.pad(step, pad), axis=axis)
    return out


def _inverse_laplacian(shape):
    """A function image -> the mean-free solution of laplacian(solution) = image - mean(image)."""
    y, x = (2 - 2 * np.cos(np.pi * np.arange(n) / n) for n in shape)
    eigen = y[:, None] + x[None, :]
    eigen[0, 0] = np.inf
    return lambda image: idctn(dctn(image, norm="ortho") / eigen, norm="ortho")


@njit(cache=True)
def _gather(image, disparity, kinds, weights, out):
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
def _scatter(samples, disparity, kinds, weights, out):
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
