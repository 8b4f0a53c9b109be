"""The camera against rays traced through its lens, and what cannot be built."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.parameters import (
    ArrayParameters,
    CameraParameters,
    OpticsParameters,
    ParameterError,
    SensorParameters,
)
from talbot.models.scene import Sampling, camera

CAMERAS = [
    CameraParameters(),
    CameraParameters(exit_pupil=0.05),
    CameraParameters(f_number=2.8, focal_length=0.025, focus=0.4, exit_pupil=0.03),
    CameraParameters(focal_length=0.012, focus=0.05, exit_pupil=0.0121),
    CameraParameters(focus=1000.0, exit_pupil=0.008),
]


def traced(lens, x, nu):
    """Height and slope at the lens, on the scene's side, of the ray that reaches the sensor at x under nu."""
    slope = x * lens.pupil_power + nu
    height = x - slope * (lens.focal_length + lens.extension)
    return height, slope + height / lens.focal_length


@pytest.mark.parametrize("lens", CAMERAS)
def test_rays_obey_the_formulas(lens):
    x, nu, depth = 1.3e-3, 0.21, 0.31 * lens.focus
    height, slope = traced(lens, x, 0.0)
    pupil = height / slope  # chief rays cross the axis there: distance in front of the lens

    def seen(x, nu, depth):
        height, slope = traced(lens, x, nu)
        return height - slope * (depth + pupil)

    np.testing.assert_allclose(seen(x, nu, lens.focus), seen(x, 0.0, lens.focus), rtol=1e-9)  # in focus
    np.testing.assert_allclose(seen(x, 0.0, depth), -x / lens.principal_distance * depth, rtol=1e-9)  # field
    np.testing.assert_allclose(abs(seen(x, lens.nu_max, 0.0)), lens.aperture / 2, rtol=1e-9)  # rim of the pupil
    moved = lens.principal_distance**2 * nu * (1 / depth - 1 / lens.focus)
    np.testing.assert_allclose(seen(x, nu, depth), seen(x + moved, 0.0, depth), rtol=1e-9)  # disparity, with its sign


def test_a_stop_at_the_lens_is_the_textbook_lens():
    f, focus = 0.01, 0.21
    lens = CameraParameters(focal_length=f, focus=focus, exit_pupil=f * focus / (focus - f))
    np.testing.assert_allclose(lens.principal_distance, f * focus / (focus - f))
    np.testing.assert_allclose(lens.magnification, f / (focus - f))
    np.testing.assert_allclose(lens.nu_max, (focus - f) / focus / 2.4)


def test_a_telecentric_lens_keeps_its_angles():
    for focus in (0.05, 0.2, 100.0):
        lens = CameraParameters(focus=focus)
        assert lens.principal_distance == lens.focal_length and lens.nu_max == pytest.approx(1 / 2.4)


def test_disparity_and_depth_are_inverse():
    sampling = Sampling(8, 12, camera=CameraParameters(exit_pupil=0.05))
    depth = np.array([0.1, 0.207, 0.3, 5.0])
    found = camera.disparity(depth, sampling)
    np.testing.assert_allclose(camera.depth(found, sampling), depth)
    assert found[0] > 0 > found[2] and abs(found[1]) < 1e-12
    finer = replace(sampling, views=25, pitch=20e-6)
    np.testing.assert_allclose(camera.disparity(depth, finer), found / 10)


def test_a_wider_lens_has_more_disparity():
    wide, narrow = (Sampling(camera=CameraParameters(f_number=n)) for n in (1.2, 4.8))
    np.testing.assert_allclose(camera.disparity(0.3, wide), 4 * camera.disparity(0.3, narrow))


@pytest.mark.parametrize(
    "changes,field",
    [
        ({"f_number": 0.4}, "f_number = 0.4"),
        ({"focal_length": 0.0}, "focal_length = 0.0"),
        ({"focus": 0.007}, "focus = 0.007"),
        ({"scale": 0.0}, "scale = 0.0"),
        ({"exit_pupil": 1e-3}, "exit_pupil = 0.001"),
        ({"focus": float("inf")}, "focus = inf"),
    ],
)
def test_lenses_that_cannot_be(changes, field):
    with pytest.raises(ParameterError, match=f"{field}: must be a number in "):
        CameraParameters(**changes)


@pytest.mark.parametrize("changes", [{"focal_length": 1e-3}, {"exit_pupil": 1.4e-3}])
def test_corners_that_the_lens_cannot_reach(changes):
    with pytest.raises(ParameterError, match=next(iter(changes))):
        SensorParameters(array=ArrayParameters(384, 384), optics=OpticsParameters(CameraParameters(**changes)))
