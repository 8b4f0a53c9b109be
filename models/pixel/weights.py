"""Weight of each view in each of the 24 x 2 photodiodes of a tile: the only 48 x views numbers in the capture.

    W[type, diode, v, u] = integral over the view's cell of rho_type(atan nu) omega(nu) dnu

The lens accepts |nu| <= nu_max, a disc. Cells are an even grid over the square around it, cut by the disc.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from numpy.polynomial.legendre import leggauss

from models.parameters import OpticsParameters, PixelType, TileParameters

from .response import response, vignetting


def density(
    types: Sequence[PixelType], optics: OpticsParameters, nu_x: npt.NDArray[np.floating], nu_y: npt.NDArray[np.floating]
) -> npt.NDArray[np.floating]:
    """Integrand rho * omega of all diodes.

    Parameters
    ----------
    types : sequence of PixelType
        Pixel types.
    optics : OpticsParameters
        Lens and gratings.
    nu_x, nu_y : array (n,)
        Points in the pupil.

    Returns
    -------
    array (types, 2, n)
        0..2.

    References
    ----------
    [Jayasuriya2017], Eq. 3.3.
    """
    theta_x, theta_y = np.arctan(nu_x), np.arctan(nu_y)
    omega = vignetting(nu_x, nu_y, optics.vignetting_power)
    return np.stack(
        [
            np.stack(
                [
                    omega * response(t.alpha + flip, t.beta, t.gamma, theta_x, theta_y, optics.m, optics.aperture_sigma)
                    for flip in (0.0, np.pi)
                ]
            )
            for t in types
        ]
    )


def cell_nodes(optics: OpticsParameters, v: int, u: int) -> npt.NDArray[np.float64]:
    """Gauss-Legendre nodes in the cell of one view, inside the lens.

    The integral over nu_x runs in arcs, nu_x = nu_max sin t, cut where the disc crosses the cell's corners. The
    integrand is thus smooth up to the rim of the lens, and the error falls exponentially with the nodes.

    Parameters
    ----------
    optics : OpticsParameters
        Lens, views and subsamples.
    v, u : int
        View row and column.

    Returns
    -------
    float64 (3, n)
        nu_x, nu_y and weight of each node.
    """
    radius = optics.nu_max
    edges = np.linspace(-radius, radius, optics.views + 1)
    x0, x1, y0, y1 = edges[u], edges[u + 1], edges[v], edges[v + 1]
    crossings = [s * np.sqrt(max(radius**2 - y**2, 0.0)) for y in (y0, y1) for s in (-1, 1)]
    cuts = np.array(sorted({x0, x1, *(c for c in crossings if x0 < c < x1)}))
    arcs = np.arcsin(np.clip(cuts / radius, -1, 1))
    node, weight = leggauss(optics.subsamples)
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
def raw_weights(types: tuple[PixelType, ...], optics: OpticsParameters) -> npt.NDArray[np.float64]:
    """View weights W, not scaled.

    Parameters
    ----------
    types : tuple of PixelType
        Pixel types.
    optics : OpticsParameters
        Lens, gratings and views.

    Returns
    -------
    float64 (types, 2, views, views)
        Read-only.
    """
    views = optics.views
    out = np.empty((len(types), 2, views, views))
    for v in range(views):
        for u in range(views):
            nu_x, nu_y, w = cell_nodes(optics, v, u)
            out[:, :, v, u] = density(types, optics, nu_x, nu_y) @ w
    out.setflags(write=False)
    return out


def view_weights(tile: TileParameters, optics: OpticsParameters) -> npt.NDArray[np.float64]:
    """View weights W, scaled so that the average diode measures 1 in a flat white scene.

    Parameters
    ----------
    tile : TileParameters
        Pixel types.
    optics : OpticsParameters
        Lens, gratings and views.

    Returns
    -------
    float64 (types, 2, views, views)
        W.

    References
    ----------
    [Jayasuriya2017], Eq. 3.3.
    """
    raw = raw_weights(tile.types, optics)
    return raw / (raw.sum((1, 2, 3)).mean() / 2)
