"""Cameras as maps of a light field: closed forms, adjoints, and the sensor's own operator."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.capture import CaptureOperator, cameras
from talbot.models.capture.projection import Projection
from talbot.models.parameters import ArrayParameters, OpticsParameters, ParameterError, SensorParameters

SENSOR = SensorParameters(array=ArrayParameters(20, 30))
RNG = np.random.default_rng(0)


@settings(max_examples=20, deadline=None)
@given(st.sampled_from(list(cameras.CAMERAS)), st.integers(1, 2), st.integers(0, 2**32 - 1))
def test_transpose_is_the_adjoint(name, fine, seed):
    camera, rng = cameras.CAMERAS[name](SENSOR, 5 * fine), np.random.default_rng(seed)
    field = rng.random((camera.pupil, camera.pupil, *camera.shape))
    samples = rng.random(camera.responses.shape)
    assert np.vdot(camera.forward(field), samples) == pytest.approx(np.vdot(field, camera.transpose(samples)))


@settings(max_examples=20, deadline=None)
@given(st.sampled_from(list(cameras.CAMERAS)), st.integers(1, 3), st.floats(0.1, 2))
def test_white_is_one_in_the_mean(name, fine, white):
    camera = cameras.CAMERAS[name](SENSOR, 5 * fine)
    assert camera.weights.min() >= 0
    period = camera.weights.sum((1, 2))[camera.order]
    assert period.mean() == pytest.approx(1, rel=0.15 if name == "random" else 1e-9)
    got = camera.forward(np.full((camera.pupil, camera.pupil, *camera.shape), white))
    np.testing.assert_allclose(got, white * camera.white)


def test_every_map_is_its_matrix():
    """Column by column, of a small array."""
    sensor = replace(SENSOR, array=ArrayParameters(5, 5))
    for name, make in cameras.CAMERAS.items():
        camera = make(sensor, 5)
        size = 25 * 25
        matrix = np.stack([camera.forward(unit.reshape(5, 5, 5, 5)).ravel() for unit in np.eye(size)], 1)
        for row, (channel, y, x) in zip(matrix, np.ndindex(camera.responses.shape), strict=True):
            expected, response = (
                np.zeros((5, 5, 5, 5)),
                camera.weights[camera.order[channel, y % camera.period[0], x % camera.period[1]]],
            )
            if name == "lenslets":
                expected[:] = response[..., None, None] / 25
            else:
                expected[..., y, x] = response
            np.testing.assert_allclose(row, expected.ravel(), atol=1e-12)


def test_lenslets_give_the_views_at_their_resolution():
    camera, field = cameras.lenslets(SENSOR, 5), RNG.random((5, 5, 20, 30))
    views = camera.forward(field) / camera.white
    means = field.reshape(5, 5, 4, 5, 6, 5).mean((3, 5))
    for v, u in np.ndindex(5, 5):
        np.testing.assert_allclose(views[0, v::5, u::5], means[v, u])


def test_pixels_with_gratings_are_the_sensors():
    field = RNG.random((5, 5, 20, 30))
    np.testing.assert_allclose(cameras.asp(SENSOR, 5).forward(field), CaptureOperator(SENSOR).forward(field))


def test_open_pixels_weigh_the_disc_of_the_pupil():
    """Without vignetting each cell by its area inside the disc; on the whole the mean of a scene in focus."""
    optics = OpticsParameters(vignetting_power=0.0)
    assert cameras.open_weights(optics, 1).item() == pytest.approx(1)
    middle = cameras.open_weights(optics, 5)[2, 2]
    assert middle == pytest.approx((2 / 5) ** 2 / np.pi)
    camera, image = cameras.plain(SENSOR, 5), RNG.random((20, 30))
    np.testing.assert_allclose(camera.forward(np.broadcast_to(image, (5, 5, 20, 30)))[0], image)


def test_a_mask_moves_by_a_cell_a_view_step():
    code = cameras.mask_code()[0]
    assert code.mean() == 0.5
    camera, views = cameras.mask(SENSOR, 5), cameras.open_weights(SENSOR.optics, 5)
    seen = camera.weights[camera.order[0]] / views  # (y, x, v, u)
    for v, u in np.ndindex(5, 5):
        np.testing.assert_allclose(seen[..., v, u] > 0.5, np.roll(code, (2 - v, 2 - u), (0, 1)) > 0.5)


def test_a_mask_without_distance_only_darkens_pixels():
    camera = cameras.mask(SENSOR, 5, shift=0.0)
    shape = camera.weights / np.maximum(camera.weights.sum((1, 2), keepdims=True), 1e-9)
    open_ = camera.weights.sum((1, 2)) > 0
    np.testing.assert_allclose(
        shape[open_], np.broadcast_to(cameras.open_weights(SENSOR.optics, 5), shape[open_].shape)
    )


def test_random_responses_of_a_pixel_differ():
    order = cameras.random(SENSOR, 5, 12, (8, 12)).order
    assert order.shape == (12, 8, 12)
    assert all(len(set(pixel)) == 12 for pixel in order.reshape(12, -1).T)


def test_bad_maps():
    weights, order, telling = np.ones((2, 3, 3)), np.zeros((1, 5, 5), int), np.ones(2, bool)
    with pytest.raises(ParameterError, match="weights"):
        Projection((10, 10), np.ones((2, 3, 4)), order, telling)
    with pytest.raises(ParameterError, match="order"):
        Projection((10, 10), weights, order + 2, telling)
    with pytest.raises(ParameterError, match="telling"):
        Projection((10, 10), weights, order, np.ones(3, bool))
    with pytest.raises(ParameterError, match="side = 4"):
        Projection((10, 10), weights, order, telling, side=4)
    with pytest.raises(ParameterError, match="shape"):
        Projection((12, 10), weights, order, telling, side=5)
    with pytest.raises(ParameterError, match="light_field shape"):
        Projection((10, 10), weights, order, telling).forward(np.ones((3, 3, 5, 5)))
    with pytest.raises(ParameterError, match="samples shape"):
        Projection((10, 10), weights, order, telling).transpose(np.ones((1, 5, 5)))
    with pytest.raises(ParameterError, match="pupil = 7"):
        cameras.lenslets(SENSOR, 7)
