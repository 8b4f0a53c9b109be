"""What each of the 24 x 2 photodiodes of a tile sees of each view: the only 48 x views numbers in the capture.

    W[type, diode, v, u] = integral over the view's cell of rho_type(atan nu) omega(nu) dnu

The lens accepts |nu| <= nu_max, a disc. Cells are an even grid over the square around it, cut by the disc.
"""

from functools import lru_cache

import numpy as np
from numpy.polynomial.legendre import leggauss

from .response import response, vignetting


def density(types, optics, nu_x, nu_y):
    """rho * omega of all diodes at the points nu_x, nu_y (n,): (types, 2, n)."""
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


def cell_nodes(optics, v, u):
    """Gauss-Legendre nodes in the cell of view (v, u), inside the lens: nu_x, nu_y, weight, each (n,).

    The integral over nu_x runs in arcs, nu_x = nu_max sin t, cut where the disc crosses the cell's corners: so the
    integrand is smooth right up to the rim of the lens and the error falls exponentially with the nodes.
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
def raw_weights(types, optics):
    """The integrals above, unscaled: (types, 2, views, views) float64, read-only."""
    views = optics.views
    out = np.empty((len(types), 2, views, views))
    for v in range(views):
        for u in range(views):
            nu_x, nu_y, w = cell_nodes(optics, v, u)
            out[:, :, v, u] = density(types, optics, nu_x, nu_y) @ w
    out.setflags(write=False)
    return out


def view_weights(tile, optics):
    """W (types, 2, views, views), so scaled that a flat white scene gives 1 in a diode on average."""
    raw = raw_weights(tile.types, optics)
    return raw / (raw.sum((1, 2, 3)).mean() / 2)
