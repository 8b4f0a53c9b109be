"""A ramp of light, out of focus, against rays traced through the lens one by one and Eq. 3.1 written out.

Nothing of the camera's formulas is used but the lens itself: focal length, exit pupil and where the sensor stands.
"""

import numpy as np
import pytest
from PIL import Image

from talbot.models.capture import Region, integrate
from talbot.models.parameters import ArrayParameters, CameraParameters, OpticsParameters, SensorParameters
from talbot.models.scene import Sampling, load

ROWS, COLS, PITCH = 28, 36, 10e-6
ACROSS, DOWN = 0.011, 0.007  # radiance a pixel
PUPILS = {"telecentric": 1e9, "pupil at 30 mm": 0.03, "pupil at 9 mm": 0.009}


def met(x, nu, pupil, lens, depth):
    """Place on the plane at ``depth`` from the entrance pupil of the ray that arrives at x, nu off the chief ray."""
    behind = lens.focal_length + lens.extension
    slope = x / pupil + nu
    height = x - slope * behind
    before = slope + height / lens.focal_length
    chief = 1 - behind / pupil  # height at the lens of the chief ray of a pixel at x = 1
    entrance = chief / (1 / pupil + chief / lens.focal_length)
    return height - before * (depth + entrance)


def disc(radius):
    """Nodes and weights over the round pupil."""
    node, weight = np.polynomial.legendre.leggauss(40)
    r, around = (node + 1) / 2 * radius, np.arange(80) * 2 * np.pi / 80
    w = np.repeat(weight / 2 * radius * r * 2 * np.pi / 80, 80)
    return (r[:, None] * np.sin(around)).ravel(), (r[:, None] * np.cos(around)).ravel(), w


def currents(kind, optics, ty, tx, w):
    """Weight of each ray in both diodes of a pixel type."""
    ay, ax = np.arctan(ty), np.arctan(tx)
    wave = optics.m * np.cos(kind.beta * (ax * np.cos(kind.gamma) + ay * np.sin(kind.gamma)) + kind.alpha)
    common = w * np.exp(-(ay**2 + ax**2) / (2 * optics.aperture_sigma**2)) / (1 + ty**2 + tx**2) ** 2
    return np.stack([common * (1 + wave), common * (1 - wave)])


@pytest.mark.parametrize("focus", [0.18, 0.35])
@pytest.mark.parametrize("pupil", PUPILS)
def test_angle_disparity_and_chief_ray_agree(pupil, focus, tmp_path):
    y, x = np.mgrid[:ROWS, :COLS]
    Image.fromarray((0.1 + ACROSS * x + DOWN * y).astype(np.float32)).save(tmp_path / "ramp.tif")
    far = PUPILS[pupil]
    lens = CameraParameters(focus=focus, exit_pupil=None if far > 1 else far)
    sensor = SensorParameters(array=ArrayParameters(ROWS, COLS, PITCH), optics=OpticsParameters(lens))
    scene = load(str(tmp_path / "ramp.tif"), Sampling.of(sensor))
    found = integrate(scene, sensor, Region(31, np.ones((ROWS, COLS), bool)))[0]

    optics, kinds = sensor.optics, sensor.tile.type_map(ROWS, COLS)
    rim = lens.focal_length / lens.f_number / 2 / abs(met(0.0, 1.0, far, lens, 0.0))  # in the entrance pupil's plane
    nu_y, nu_x, w = disc(rim)
    white = np.mean([currents(kind, optics, nu_y, nu_x, w).sum() / 2 for kind in sensor.tile.types])
    depth = 3.72 / 14.5
    errors, moved = [], []
    for row in range(8, ROWS - 8):
        for col in range(8, COLS - 8):
            at = ((row - (ROWS - 1) / 2) * PITCH, (col - (COLS - 1) / 2) * PITCH)
            ray = (
                currents(sensor.tile.types[kinds[row, col]], optics, nu_y + at[0] / far, nu_x + at[1] / far, w) / white
            )
            # A pixel's place in the picture is where its chief ray meets the plane.
            scale = met(PITCH, 0.0, far, lens, depth)
            seen = [met(a, nu, far, lens, depth) / scale - a / PITCH for a, nu in zip(at, (nu_y, nu_x), strict=True)]
            own = 0.1 + ACROSS * col + DOWN * row
            light = own + DOWN * seen[0] + ACROSS * seen[1]
            errors.append(found[:, row, col] - (ray * light).sum(1))
            moved.append((ray * (light - own)).sum(1))
    assert np.std(moved) > 5e-4
    assert np.sqrt(np.mean(np.square(errors))) < 1e-3 * np.std(moved)
