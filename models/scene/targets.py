"""Analytic targets: radiance is a formula of the place, so every view is exact.

Places are px from the middle of the array, x to the right, y down. Each stands on a plane `focus` px a view step
behind the focal plane (default 1, so that edges answer; 0 is in focus).
"""

import numpy as np

from . import camera
from .scene import Scene

FOCUS = 1.0  # px a view step
WAVELENGTH = 24.0  # px, of the tilted plane's texture
TILT = 4.0  # px a view step between the left and the right end of the tilted plane, both sides of focus
POINT_SIGMA = 0.7  # px
SATURATED = 8.0  # radiance: fills the wells several times over


def flat(sampling, level=50.0):
    """A uniform scene of ``level`` percent of white, 0..1600."""
    return _uniform("flat", sampling, level / 100)


def saturated(sampling):
    """So bright that every well is full."""
    return _uniform("saturated", sampling, SATURATED)


def black(sampling):
    """No light at all."""
    return _uniform("black", sampling, 0.0)


def point(sampling):
    """A point of light, on the plane."""
    return _on_plane("point", sampling, lambda y, x: np.exp(-(x**2 + y**2) / (2 * POINT_SIGMA**2)))


def edge(sampling, degrees=20.0):
    """A straight edge from dark (0.05) to bright (0.95), one px wide; ``degrees`` from vertical, any angle."""
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    return _on_plane("edge", sampling, lambda y, x: 0.5 + 0.9 * np.clip(x * c + y * s, -0.5, 0.5))


def tilted(sampling):
    """A plane turned about the vertical through the focal plane, with a woven texture."""
    y, x = _places(sampling)
    # Never so steep that an outer view looks along the plane.
    slope = min(TILT * 5 / sampling.views / max(sampling.cols - 1, 1), 0.25 / max(sampling.steps[-1], 1))
    shift = sampling.focus_or(0.0)

    def texture(v, u):
        k = 2 * np.pi / WAVELENGTH
        return 0.5 + 0.15 * (np.sin(k * u) + np.sin(k * v) + np.sin(k * (u + v) * 0.7))

    field = np.empty((sampling.views, sampling.views, *sampling.shape), sampling.dtype)
    for i, dv in enumerate(sampling.steps):
        for j, du in enumerate(sampling.steps):
            # The disparity d = slope * place - shift at the place that this view sees: place = x + du * d, solved.
            place = (x - du * shift) / (1 - du * slope)
            field[i, j] = texture(y + dv * (slope * place - shift), place)
    raw = np.broadcast_to(slope * x, sampling.shape)
    return Scene(
        "tilted", sampling.views, field, texture(y, x).astype(sampling.dtype), raw - shift, camera.depth(raw, sampling)
    )


def polarized(sampling, degree=25.0):
    """A uniform scene whose light is polarized by ``degree`` percent, its plane turning by pi from left to right."""
    psi = np.broadcast_to(np.pi * (np.arange(sampling.cols) + 0.5) / sampling.cols, sampling.shape)
    stokes = degree / 100 * np.stack([np.cos(2 * psi), np.sin(2 * psi)])
    return _uniform("polarized", sampling, 0.5, stokes)


def _places(sampling):
    rows, cols = sampling.shape
    return np.arange(rows)[:, None] - (rows - 1) / 2, np.arange(cols)[None, :] - (cols - 1) / 2


def _uniform(name, sampling, radiance, polarization=None):
    image = np.full(sampling.shape, radiance, sampling.dtype)
    return Scene(
        name,
        sampling.views,
        image[None, None],
        image,
        depth=np.full(sampling.shape, camera.REFERENCE_DEPTH),
        polarization=polarization,
    )


def _on_plane(name, sampling, radiance):
    """``radiance(y, x)`` on a plane: all views equal, and only one kept, where the plane is in focus."""
    y, x = _places(sampling)
    d = -sampling.focus_or(FOCUS)
    steps = sampling.steps if d else np.zeros(1)
    field = np.stack(
        [np.stack([np.broadcast_to(radiance(y + dv * d, x + du * d), sampling.shape) for du in steps]) for dv in steps]
    ).astype(sampling.dtype)
    image = np.broadcast_to(radiance(y, x), sampling.shape).astype(sampling.dtype)
    return Scene(
        name, sampling.views, field, image, np.full(sampling.shape, d), np.full(sampling.shape, camera.REFERENCE_DEPTH)
    )
