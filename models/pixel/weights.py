"""Weight of each view in each of the 24 x 2 photodiodes of a tile: the only 48 x views numbers in the capture.

    W[type, diode, v, u] = integral over the view's cell of rho_type(atan nu) omega(nu) dnu

The lens accepts |nu| <= nu_max, a disc. Cells are an even grid over the square around it, cut by the disc.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from numpy.polynomial.legendre import leggauss

from talbot.models.parameters import OpticsParameters, ParameterError, PixelType, SensorParameters, TileParameters
from talbot.models.pixel.response import response, vignetting

_gauss = lru_cache(maxsize=8)(leggauss)  # of each of up to 961 cells


def density(
    types: Sequence[PixelType], optics: OpticsParameters, nu_x: npt.NDArray[np.floating], nu_y: npt.NDArray[np.floating]
) -> npt.NDArray[np.floating]:
    """Integrand rho * omega of all diodes.

    types: pixel types. optics: lens and gratings. nu_x, nu_y: (n,), tangents of the rays. Returns (types, 2, n), 0..2,
    or what a type's own response gives. Raises ParameterError for a type's own response of a wrong shape, negative or
    not finite. Source: [Jayasuriya2017], Eq. 3.3.
    """
    theta_x, theta_y = np.arctan(nu_x), np.arctan(nu_y)
    omega = vignetting(nu_x, nu_y, optics.vignetting_power)
    return np.stack([omega * _diodes(t, optics, theta_x, theta_y) for t in types])


def _diodes(
    kind: PixelType, optics: OpticsParameters, theta_x: npt.NDArray[np.floating], theta_y: npt.NDArray[np.floating]
) -> npt.NDArray[np.floating]:
    """Response rho of both diodes of a type, (2, n)."""
    if kind.response is None:
        m = optics.m if kind.m is None else kind.m
        angles = theta_x, theta_y, m, optics.aperture_sigma
        return np.stack([response(kind.alpha + flip, kind.beta, kind.gamma, *angles) for flip in (0.0, np.pi)])
    rho = np.asarray(kind.response(theta_x, theta_y), float)
    if rho.shape != (2, *theta_x.shape):
        raise ParameterError(f"response = array of shape {rho.shape}: must be {(2, *theta_x.shape)}, both diodes")
    if not (np.isfinite(rho).all() and rho.min() >= 0):
        raise ParameterError(f"response = {rho.min():g}..{rho.max():g}: every value must be finite and 0 or more")
    return rho


def cell_nodes(optics: OpticsParameters, v: int, u: int) -> npt.NDArray[np.float64]:
    """Gauss-Legendre nodes in the cell of one view, inside the lens.

    The integral over nu_x runs in arcs, nu_x = nu_max sin t, cut where the disc crosses the cell's corners. The
    integrand is thus smooth up to the rim of the lens, and the error falls exponentially with the nodes.

    optics: lens, views and subsamples. v, u: view row and column. Returns (3, n), nu_x, nu_y and weight of each node.
    """
    radius = optics.nu_max
    edges = np.linspace(-radius, radius, optics.views + 1)
    x0, x1, y0, y1 = edges[u], edges[u + 1], edges[v], edges[v + 1]
    crossings = [s * np.sqrt(max(radius**2 - y**2, 0.0)) for y in (y0, y1) for s in (-1, 1)]
    cuts = np.array(sorted({x0, x1, *(c for c in crossings if x0 < c < x1)}))
    arcs = np.arcsin(np.clip(cuts / radius, -1, 1))
    node, weight = _gauss(optics.subsamples)
    parts = []
    for t0, t1 in zip(arcs[:-1], arcs[1:], strict=True):
        t = (t0 + t1) / 2 + node * (t1 - t0) / 2
        reach = radius * np.cos(t)
        low, high = np.maximum(y0, -reach), np.minimum(y1, reach)
        half = np.maximum(high - low, 0) / 2  # 0: the disc does not reach this part of the cell
        y = (low + high)[:, None] / 2 + half[:, None] * node
        w = (weight * (t1 - t0) / 2 * reach * half)[:, None] * weight
        x = np.broadcast_to(radius * np.sin(t)[:, None], y.shape)
        parts.append(np.stack([x.ravel(), y.ravel(), w.ravel()]))
    return np.concatenate(parts, 1)


@lru_cache(maxsize=32)
def raw_weights(
    types: tuple[PixelType, ...], optics: OpticsParameters, chief: tuple[float, float] = (0.0, 0.0)
) -> npt.NDArray[np.float64]:
    """View weights W, not scaled.

    types: pixel types. optics: lens, gratings and views. chief: tangents of the chief ray at the pixel, y and x.
    Returns (types, 2, views, views), read-only.
    """
    nodes, starts = _all_nodes(optics)
    nu_x, nu_y, w = nodes
    light = density(types, optics, nu_x + chief[1], nu_y + chief[0]) * w
    out = np.add.reduceat(light, starts, 2).reshape(len(types), 2, optics.views, optics.views)
    out.setflags(write=False)
    return out


@lru_cache(maxsize=32)
def _all_nodes(optics: OpticsParameters) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """Nodes (3, n) of all cells, view after view, and where those of each begin."""
    cells = [cell_nodes(optics, v, u) for v in range(optics.views) for u in range(optics.views)]
    return np.concatenate(cells, 1), np.cumsum([0, *(cell.shape[1] for cell in cells[:-1])])


def view_weights(tile: TileParameters, optics: OpticsParameters) -> npt.NDArray[np.float64]:
    """View weights W, scaled so that the average diode measures 1 in a flat white scene.

    tile: pixel types. optics: lens, gratings and views. Returns (types, 2, views, views), W. Source: [Jayasuriya2017],
    Eq. 3.3.
    """
    raw = raw_weights(tile.types, optics)
    return raw / (raw.sum((1, 2, 3)).mean() / 2)


@dataclass(frozen=True, eq=False)
class FieldWeights:
    """View weights of every pixel: Chebyshev series in the chief ray, of one term where the lens is telecentric.

    W of a pixel of this type at (row, col) is the sum over i, j of series[type, :, v, u, i, j] y[row, i] x[col, j].

    series: (types, 2, views, views, terms, terms), coefficients.
    y: (rows, terms), polynomials at each row.
    x: (cols, terms), polynomials at each column.
    """

    series: npt.NDArray[np.float64]
    y: npt.NDArray[np.float64]
    x: npt.NDArray[np.float64]

    @property
    def summed(self) -> "FieldWeights":
        """Weights of one view that represents all."""
        return FieldWeights(self.series.sum((2, 3), keepdims=True), self.y, self.x)


NODES = 40  # across the pupil, all views together; at least 3 a view


@lru_cache(maxsize=16)
def field_weights(sensor: SensorParameters, views: int) -> FieldWeights:
    """View weights of every pixel behind the sensor's lens, scaled as `view_weights` on the axis.

    sensor: the sensor; its own number of views is not used. views: views along the pupil's diameter, 1..31. Returns
    FieldWeights: off by less than 1e-4 of a weight's share of the light.
    """
    optics = replace(sensor.optics, views=views, subsamples=max(3, -(-NODES // views)))
    types, array = sensor.tile.types, sensor.array
    scale = 2 / raw_weights(types, optics).sum((1, 2, 3)).mean()
    power = optics.camera.pupil_power * array.pitch / 2
    edge = power * max(array.rows - 1, array.cols - 1, 1)  # tangent of the chief ray at the array's edge
    turn = max(t.beta for t in types) * edge  # rad of the fastest grating
    terms = 1 if edge == 0 else 5 + int(np.ceil(1.5 * turn))
    angles = np.pi * (np.arange(terms) + 0.5) / terms
    chief = np.cos(angles) * edge
    values = np.array([[raw_weights(types, optics, (float(y), float(x))) for x in chief] for y in chief])
    fit = np.cos(np.arange(terms)[:, None] * angles) * 2 / terms
    fit[0] /= 2
    series = np.einsum("iy,jx,yxtdvu->tdvuij", fit, fit, values) * scale

    def _terms(count: int) -> npt.NDArray[np.float64]:
        place = (2 * np.arange(count) - (count - 1)) * power / (edge or 1.0)
        return np.cos(np.arange(terms) * np.arccos(np.clip(place, -1, 1))[:, None])

    return FieldWeights(np.ascontiguousarray(series), _terms(array.rows), _terms(array.cols))
