"""Scenes whose polarization varies over the picture: light of one plane, a stressed sheet, glossy balls.

Angles are counted from the rows' direction towards the columns', as those of gratings. A grating passes least of the
light that is polarized along it (`models/pixel/polarization.py`).
"""

import numpy as np
import numpy.typing as npt

from talbot.models.scene import camera
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import Scene
from talbot.models.scene.targets import places, uniform

Floats = npt.NDArray[np.float64]

HOLE = 0.18  # radius of the hole in the sheet, of the array's shorter side
RETARDANCE = np.deg2rad(75.0)  # of the sheet far from the hole, where the stress is even
RETARDED = 550e-9  # m, the wavelength of that retardance; at others it is in proportion to 1 / wavelength
INDEX = 1.5  # of refraction, of the balls
LAMP = 7.0  # radiance of the lamps that the balls mirror
LAMP_RADIUS = np.deg2rad(24.0)
CARD = 4.0  # radiance of the card in sunlight: its pixels are full
# Balls: middle y, x and radius, of the array's shorter side; own metres to the camera; albedo; angle to its lamp
BALLS = ((-0.20, -0.18, 0.27, 2.9, 0.45, 0.5), (0.22, 0.16, 0.24, 2.5, 0.3, 2.4), (-0.25, 0.33, 0.14, 3.3, 0.4, -2.0))


def polarized(sampling: Sampling, degree: float = 25.0) -> Scene:
    """Uniform scene of polarized light whose plane turns by pi from left to right.

    sampling: array, views and camera. degree: degree of polarization in percent, 0..100. Returns Scene: one view, with
    polarization.
    """
    psi = np.broadcast_to(np.pi * (np.arange(sampling.cols) + 0.5) / sampling.cols, sampling.shape)
    stokes = degree / 100 * np.stack([np.cos(2 * psi), np.sin(2 * psi)])
    return uniform("polarized", sampling, 0.5, stokes)


def stress(sampling: Sampling, degrees: float = 30.0) -> Scene:
    """Birefringent sheet with a hole, pulled along the rows, before light from a polarizer.

    Stress is Kirsch's solution; retardance is in proportion to the difference of the principal stresses, the axes are
    theirs. The gratings are the second polarizer. What the sheet makes circular of the light has no plane.

    sampling: array, views and camera. degrees: angle of the polarizer's light. Returns Scene: one view, with
    polarization. [Jayasuriya2017], Sec. 4.2; [Kirsch1898].
    """
    y, x = places(sampling)
    delay, axis = kirsch(y, x, HOLE * min(sampling.shape))
    psi = np.deg2rad(degrees)
    # Along the axis' own direction light keeps its plane; across it the cosine of the retardance is left.
    across_kept = np.cos(delay)
    if sampling.light:
        parts = (weight * np.cos(delay * RETARDED / w) for w, weight in sampling.light if weight)
        across_kept = sum(parts, np.zeros(delay.shape))
    along, across = np.cos(2 * (psi - axis)), np.sin(2 * (psi - axis)) * across_kept
    cosine, sine = np.cos(2 * axis), np.sin(2 * axis)
    stokes = np.stack([along * cosine - across * sine, along * sine + across * cosine])
    return uniform("stress", sampling, 0.6, stokes)


def kirsch(y: Floats, x: Floats, radius: float) -> tuple[Floats, Floats]:
    """Retardance and fast axis of a sheet with a hole that is pulled along x.

    y, x: array, from the middle of the hole, broadcastable. radius: of the hole, in the same unit. Returns tuple of
    array: retardance in rad, 0 in the hole, and the axis in rad from x towards y. [Kirsch1898].
    """
    around = np.arctan2(y, x) + 0 * x
    rho = radius / np.maximum(np.hypot(y, x), radius)
    # Half the difference of the principal stresses and the shear, in polar coordinates, of a pull of 1
    normal = (1 - rho**2) / 2 + (1 - 4 * rho**2 + 3 * rho**4) / 2 * np.cos(2 * around)
    normal -= (1 + rho**2) / 2 - (1 + 3 * rho**4) / 2 * np.cos(2 * around)
    shear = -(1 + 2 * rho**2 - 3 * rho**4) * np.sin(2 * around)
    return RETARDANCE * np.hypot(normal, shear) * (rho < 1), around + 0.5 * np.arctan2(shear, normal)


def specular(sampling: Sampling) -> Scene:
    """Glossy balls with highlights of lamps next to them, on a cloth with a sunlit card.

    A highlight is Fresnel's reflection, polarized across the plane of incidence, and brighter than what is diffuse
    around it. The card is diffuse and fills the pixels' wells.

    sampling: array, views and camera. Returns Scene: all views, with disparity, depth, polarization of every view and
    where the highlights are.
    """
    n, shape = sampling.views, sampling.shape
    field, stokes = np.empty((n, n, *shape), sampling.dtype), np.empty((2, n, n, *shape))
    for v, u in np.ndindex(n, n):
        offset = float(sampling.steps[v]), float(sampling.steps[u])
        field[v, u], stokes[:, v, u], _, _ = _balls(sampling, *offset)
    image, _, disparity, shine = _balls(sampling, 0.0, 0.0)
    depth = camera.depth(disparity, sampling)
    return Scene("specular", n, field, image.astype(sampling.dtype), disparity, depth, stokes, shine > 0.5)


def _balls(sampling: Sampling, dv: float, du: float) -> tuple[Floats, Floats, Floats, Floats]:
    """Radiance, (S1/S0, S2/S0), disparity of a view of the balls, and how much of the lamps' disc it shows, 0..1."""
    (y, x), size = places(sampling), min(sampling.shape)
    far = float(camera.disparity(camera.scaled(camera.PLANE, sampling.camera), sampling))
    light, disparity = _cloth((y + dv * far) / size, (x + du * far) / size), np.full(sampling.shape, far)
    stokes, shown = np.zeros((2, *sampling.shape)), np.zeros(sampling.shape)
    for middle_y, middle_x, radius, metres, albedo, lamp in sorted(BALLS, key=lambda ball: -ball[3]):
        near = float(camera.disparity(camera.scaled(metres, sampling.camera), sampling))
        ny, nx = np.broadcast_arrays(
            ((y + dv * near) / size - middle_y) / radius, ((x + du * near) / size - middle_x) / radius
        )
        inside = np.hypot(ny, nx) < 1
        ny, nx = ny[inside], nx[inside]
        nz = np.sqrt(1 - ny**2 - nx**2)
        diffuse = albedo * (0.35 + 0.45 * nz - 0.2 * ny) * (1 + 0.25 * np.sin(14 * ny + 9 * nx))
        # The mirrored ray leaves along 2 nz n - z; lamps are next to the balls, across the line of sight.
        to_lamp = 2 * nz * (ny * np.sin(lamp) + nx * np.cos(lamp))
        disc = np.clip((np.arccos(np.clip(to_lamp, -1, 1)) - LAMP_RADIUS) / -np.deg2rad(3) + 0.5, 0, 1)
        across, along = _fresnel(nz)
        glossy = LAMP * disc * (across + along) / 2
        turn = 2 * (np.arctan2(ny, nx) + np.pi / 2)  # polarized across the plane of normal and line of sight
        part = LAMP * disc * (across - along) / 2 / (glossy + diffuse)
        light[inside], disparity[inside], shown[inside] = glossy + diffuse, near, disc
        stokes[:, inside] = part * np.cos(turn), part * np.sin(turn)
    return light, stokes, disparity, shown


def _cloth(y: Floats, x: Floats) -> Floats:
    """Radiance of the cloth and the card on it, at places of the array's shorter side."""
    woven = 0.4 + 0.1 * (np.sin(95 * x) + np.sin(95 * y) + np.sin(60 * (x + y)))
    return np.where((np.abs(x - 0.28) < 0.12) & (np.abs(y + 0.08) < 0.07), CARD, woven)


def _fresnel(cosine: Floats) -> tuple[Floats, Floats]:
    """Reflected part of light polarized across and along the plane of incidence, from the cosine of its angle."""
    inner = np.sqrt(1 - (1 - cosine**2) / INDEX**2)
    across = ((cosine - INDEX * inner) / (cosine + INDEX * inner)) ** 2
    along = ((inner - INDEX * cosine) / (inner + INDEX * cosine)) ** 2
    return across, along
