"""Scenes of flat facets, cast ray by ray: a box with two blocks in it, and a fence before a wall.

Metres to the right, down and away from the camera. A ray of the view (dv, du) through the pixel (y, x) passes

    X = (x + du K (s - s0)) / (f s),    Y alike with y and dv,    Z = 1 / s

with s the inverse depth, s0 that of the focal plane, K px of disparity for each 1/m, and f px of focal length: on a
plane n P = k it meets  s = (nx (x - du K s0) / f + ny (y - dv K s0) / f + nz) / (k - (nx du + ny dv) K / f).
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.scene import camera
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import Scene
from talbot.models.scene.targets import places

Floats = npt.NDArray[np.float64]
Texture = Callable[[Floats, Floats], Floats]  # radiance at metres along both sides; NaN: a hole

NEAR, FAR = 2.2, 4.6  # m of the scene, ends of the box
GRAIN = 0.08  # of the near end's width: shortest wave of the textures
BARS = 12.0  # px, of a bar of the fence and the gap next to it
CRACK = 1e-9  # of a side: rounding must leave none between two facets
WALL = 1.55, 1.9  # depth of the wall's left and right end, of the fence's


class Facet(NamedTuple):
    """A rectangle: corner, two sides at right angles, in m, and its texture."""

    corner: Floats
    across: Floats
    down: Floats
    texture: Texture


def cornell(sampling: Sampling) -> Scene:
    """Box whose open end fills the picture, with two blocks in it; all walls are textured.

    sampling: array, views and camera. Returns Scene: all views, with disparity and depth.
    """
    near, far = (float(camera.scaled(z, sampling.camera)) for z in (NEAR, FAR))
    wide, high = (near * n / 2 / _focal(sampling) for n in (sampling.cols, sampling.rows))
    grain = 2 * np.pi / (GRAIN * 2 * min(wide, high))
    deep = np.array([0.0, 0.0, far - near / 2])
    right, below = np.array([2 * wide, 0.0, 0.0]), np.array([0.0, 2 * high, 0.0])
    corner = np.array([-wide, -high, near / 2])
    facets = [
        Facet(corner + deep, right, below, _woven(0.55, grain / 2, 0.3)),
        Facet(corner, deep, below, _woven(0.4, grain / 2, 1.1)),
        Facet(corner + right, deep, below, _woven(0.65, grain / 2, 2.0)),
        Facet(corner, deep, right, _woven(0.5, grain / 2, 2.9)),
        Facet(corner + below, deep, right, _woven(0.7, grain / 2, 3.7)),
    ]
    span = far - near
    facets += _block((-0.35 * wide, high, near + 0.68 * span), 0.55 * wide, 1.2 * high, 0.3, _woven(0.6, grain, 4.4))
    facets += _block((0.3 * wide, high, near + 0.3 * span), 0.5 * wide, 0.6 * high, -0.35, _woven(0.45, grain, 5.2))
    return _cast("cornell", sampling, facets)


def fence(sampling: Sampling) -> Scene:
    """Fence in the focal plane that hides half of a wall behind it.

    sampling: array, views and camera. Returns Scene: all views, with disparity, depth, and the depth of the wall behind
    the fence.
    """
    focus, f = sampling.camera.focus, _focal(sampling)
    bar, wide, high = BARS * focus / f, *(2 * focus * n / f for n in (sampling.cols, sampling.rows))
    side = np.array([wide, 0.0, 0.0]), np.array([0.0, high, 0.0])
    grain = 2 * np.pi / (GRAIN * min(wide, high) / 2)
    wood = _woven(0.35, 2 * grain, 0.7)
    bars = Facet(
        np.array([-wide / 2, -high / 2, focus]), *side, lambda a, b: np.where(a / bar % 1 < 0.5, wood(a, b), np.nan)
    )
    left, right = (focus * end for end in WALL)
    start = np.array([-2 * wide, -2 * high, left - 1.5 * (right - left)])
    wall = Facet(start, np.array([4 * wide, 0, 4 * (right - left)]), 4 * side[1], _woven(0.65, grain, 1.9))
    behind = _cast("wall", sampling, [wall])
    scene = _cast("fence", sampling, [wall, bars])
    return replace(scene, behind=behind.depth)


def _focal(sampling: Sampling) -> float:
    """Focal length in px."""
    return sampling.camera.principal_distance / sampling.pitch


def _woven(level: float, k: float, seed: float) -> Texture:
    """Texture of waves in several directions, of waves of k rad per m and longer."""

    def _radiance(a: Floats, b: Floats) -> Floats:
        waves = np.sin(k * a + seed) + np.sin(k * (0.3 * a + 0.9 * b) + 2 * seed) + np.sin(k * (0.6 * a - 0.5 * b))
        return level * (1 + 0.16 * (waves + np.sin(0.37 * k * (a + b) + seed)))

    return _radiance


def _block(foot: tuple[float, float, float], side: float, tall: float, turn: float, texture: Texture) -> list[Facet]:
    """Upright square block on the point ``foot``: the faces that a camera may see."""
    a, b = side * np.array([np.cos(turn), 0, np.sin(turn)]), side * np.array([-np.sin(turn), 0, np.cos(turn)])
    up, corner = np.array([0, -tall, 0.0]), np.array(foot) - (a + b) / 2
    sides = (corner, a, up), (corner, b, up), (corner + a, b, up), (corner + up, a, b)
    return [Facet(*face, texture) for face in sides]


def _cast(name: str, sampling: Sampling, facets: Sequence[Facet]) -> Scene:
    """Return the scene of the nearest facets."""

    def _view(dv: float, du: float) -> tuple[Floats, Floats]:
        return _rays(sampling, facets, dv, du)

    steps = [float(step) for step in sampling.steps]
    field = np.array([[_view(dv, du)[0] for du in steps] for dv in steps], sampling.dtype)
    image, disparity = _view(0.0, 0.0)
    depth = camera.depth(disparity, sampling)
    return Scene(name, sampling.views, field, image.astype(sampling.dtype), disparity, depth, render=lambda mask: _view)


def _rays(sampling: Sampling, facets: Sequence[Facet], dv: float, du: float) -> tuple[Floats, Floats]:
    """Radiance and disparity of a view."""
    y, x = places(sampling)
    f, k, s0 = _focal(sampling), camera.per_inverse_metre(sampling), 1 / sampling.camera.focus
    light, nearest = np.zeros(sampling.shape), np.full(sampling.shape, 1e-9)
    for corner, across, down, texture in facets:
        normal = np.cross(across, down)
        below = float(normal @ corner) - (normal[0] * du + normal[1] * dv) * k / f
        s = (normal[0] * (x - du * k * s0) + normal[1] * (y - dv * k * s0)) / f + normal[2]
        s = np.broadcast_to(s / below, sampling.shape)
        hit = np.flatnonzero(s > nearest)
        here = s.ravel()[hit]
        row, column = np.divmod(hit, sampling.cols)
        shift = k * (here - s0)
        point = np.stack([(x[0, column] + du * shift) / f, (y[row, 0] + dv * shift) / f, np.ones_like(here)]) / here
        lengths = np.linalg.norm(across), np.linalg.norm(down)
        a, b = ((side @ (point - corner[:, None])) / n for side, n in zip((across, down), lengths, strict=True))
        radiance = texture(a, b)
        inside = (np.abs(p - n / 2) <= n * (0.5 + CRACK) for p, n in zip((a, b), lengths, strict=True))
        seen = np.logical_and(*inside) & ~np.isnan(radiance)
        light.ravel()[hit[seen]], nearest.ravel()[hit[seen]] = radiance[seen], here[seen]
    return light, k * (nearest - s0)
