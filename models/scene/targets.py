"""Analytic targets: radiance is a formula of the position, so every view is exact.

Positions are px from the middle of the array, x to the right, y down. Each target but the tilted plane is on a plane at
`camera.PLANE`, out of the default focus, so that edges respond.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from talbot.models.scene import camera
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import Scene

Floats = npt.NDArray[np.float64]

WAVELENGTH = 24.0  # px, of the tilted plane's texture
TILT = 0.26  # 1/m of the scene between the left and the right end of the tilted plane, both sides of camera.REFERENCE
IN_FOCUS = 1e-6  # px across the whole pupil: rounding of a focus that is meant to hit the plane
POINT_SIGMA = 0.7  # px
SATURATED = 8.0  # radiance: fills the wells several times over


def flat(sampling: Sampling, level: float = 50.0) -> Scene:
    """Uniform scene.

    sampling: array, views and camera. level: percent of white, 0..1600. Returns Scene: one view.
    """
    return uniform("flat", sampling, level / 100)


def saturated(sampling: Sampling) -> Scene:
    """Uniform scene that fills every well.

    sampling: array, views and camera. Returns Scene: one view.
    """
    return uniform("saturated", sampling, SATURATED)


def black(sampling: Sampling) -> Scene:
    """Scene without light.

    sampling: array, views and camera. Returns Scene: one view.
    """
    return uniform("black", sampling, 0.0)


def point(sampling: Sampling) -> Scene:
    """Point of light in the middle of the array.

    sampling: array, views and camera. Returns Scene: all views; one view in focus.
    """
    return _on_plane("point", sampling, lambda y, x: np.exp(-(x**2 + y**2) / (2 * POINT_SIGMA**2)))


def edge(sampling: Sampling, degrees: float = 20.0) -> Scene:
    """Straight edge from dark (0.05) to bright (0.95), one px wide.

    sampling: array, views and camera. degrees: angle from vertical. Returns Scene: all views; one view in focus.
    """
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    return _on_plane("edge", sampling, lambda y, x: 0.5 + 0.9 * np.clip(x * c + y * s, -0.5, 0.5))


def moving(sampling: Sampling, speed: float = 5000.0) -> Scene:
    """Upright edge from dark (0.05) to bright (0.95) that moves.

    At the frame's start it is a quarter of the array left of the middle.

    sampling: array, views and camera. speed: to the right, 0..1e6 px/s. Returns Scene: all views; one view in focus.
    """

    def _at(seconds: float) -> Scene:
        place = speed * seconds - sampling.cols / 4
        return _on_plane("moving", sampling, lambda y, x: 0.5 + 0.9 * np.clip(x - place + 0 * y, -0.5, 0.5))

    return replace(_at(0.0), static=False, moved=_at, speed=speed)


def tilted(sampling: Sampling) -> Scene:
    """Plane turned about a vertical axis through the reference plane, with a woven texture.

    sampling: array, views and camera. Returns Scene: all views, with disparity and depth.
    """
    y, x = places(sampling)
    # The slope stays below that of the outermost rays.
    across = TILT * sampling.camera.scale * camera.per_inverse_metre(sampling)
    slope = min(across / max(sampling.cols - 1, 1), 0.5 / sampling.views)
    middle = camera.scaled(camera.REFERENCE, sampling.camera)
    shift = -float(camera.disparity(middle, sampling))

    def _texture(v: Floats, u: Floats) -> Floats:
        k = 2 * np.pi / WAVELENGTH
        return 0.5 + 0.15 * (np.sin(k * u) + np.sin(k * v) + np.sin(k * (u + v) * 0.7))

    def _view(dv: float, du: float) -> tuple[Floats, Floats]:
        # The disparity d = slope * place - shift at the position that this view shows: place = x + du * d, solved.
        place = (x - du * shift) / (1 - du * slope)
        d = slope * place - shift
        return _texture(y + dv * d, place), np.broadcast_to(d, sampling.shape)

    field = np.array([[_view(dv, du)[0] for du in sampling.steps] for dv in sampling.steps], sampling.dtype)
    disparity = np.broadcast_to(slope * x - shift, sampling.shape)
    depth = camera.depth(disparity, sampling)
    image = _texture(y, x).astype(sampling.dtype)
    return Scene("tilted", sampling.views, field, image, disparity, depth, render=lambda mask: _view)


def places(sampling: Sampling) -> tuple[Floats, Floats]:
    """Place of every pixel, px from the middle of the array.

    sampling: the array. Returns y (rows, 1): down; x (1, cols): to the right.
    """
    rows, cols = sampling.shape
    return np.arange(rows, dtype=float)[:, None] - (rows - 1) / 2, np.arange(cols, dtype=float)[None, :] - (
        cols - 1
    ) / 2


def plane(sampling: Sampling) -> tuple[Floats, Floats]:
    """Return the plane of pictures without depth.

    sampling: array, views and camera. Returns disparity (rows, cols): in px per view step; depth (rows, cols): in m
    from the camera.
    """
    depth = np.full(sampling.shape, camera.scaled(camera.PLANE, sampling.camera))
    return camera.disparity(depth, sampling), depth


def uniform(name: str, sampling: Sampling, radiance: float, polarization: Floats | None = None) -> Scene:
    """Scene of one radiance.

    name: name in reports. sampling: array, views and camera. radiance: 0..16. polarization: (2, rows, cols), S1/S0 and
    S2/S0. Returns Scene: one view.
    """
    image = np.full(sampling.shape, radiance, sampling.dtype)
    return Scene(name, sampling.views, image[None, None], image, depth=plane(sampling)[1], polarization=polarization)


def _on_plane(name: str, sampling: Sampling, radiance: Callable[[Floats, Floats], Floats]) -> Scene:
    """``radiance(y, x)`` on a plane; in focus all views are equal, and one is kept."""
    y, x = places(sampling)
    disparity, depth = plane(sampling)
    d = disparity.flat[0]
    steps = sampling.steps if abs(d) * sampling.views > IN_FOCUS else np.zeros(1)

    def _view(dv: float, du: float) -> tuple[Floats, Floats]:
        return np.broadcast_to(radiance(y + dv * d, x + du * d), sampling.shape), disparity

    field = np.array([[_view(dv, du)[0] for du in steps] for dv in steps], sampling.dtype)
    image = np.broadcast_to(radiance(y, x), sampling.shape).astype(sampling.dtype)
    return Scene(name, sampling.views, field, image, disparity, depth, render=lambda mask: _view)
