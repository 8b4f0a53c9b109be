"""The estimator of any camera: the sensor's as before, covariances of means, planes that come back."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.capture import cameras
from talbot.models.parameters import ArrayParameters, ParameterError, SensorParameters
from talbot.models.reconstruct import psnr_db
from talbot.models.reconstruct.bayes import FieldEstimator, FieldPrior
from talbot.models.reconstruct.bayes.covariance import Covariances
from talbot.models.reconstruct.bayes.estimator import sums_and_differences
from talbot.models.reconstruct.bayes.planes import Plane, Window

PRIOR = FieldPrior(far=-1, near=1, disparities=5, between=0, slants=0, noise=0.002, margin=5)


def _sensor(rows, cols):
    return SensorParameters(array=ArrayParameters(rows, cols))


def _plane(disparity, rows, cols):
    y, x = np.mgrid[:rows, :cols].astype(float)
    steps = np.arange(-2, 3) * disparity

    def texture(y, x):
        return 0.5 + 0.15 * (np.sin(0.3 * x + 0.1 * y) + np.sin(0.25 * y - 0.2 * x + 1))

    return np.array([[texture(y + dv, x + du) for du in steps] for dv in steps])


def test_the_sensors_own_estimates_are_those_of_its_map():
    """Sums and differences of its diodes as a camera: the same to the bit."""
    sensor, prior = _sensor(12, 18), replace(PRIOR, margin=4)
    pair = cameras.asp(sensor, 5).forward(_plane(0.5, 12, 18))
    turned = np.stack([pair[0] + pair[1], pair[0] - pair[1]]).astype(np.float32) / np.float32(np.sqrt(2))
    direct = FieldEstimator(sensor, 5, prior)
    mapped = FieldEstimator(sums_and_differences(sensor, 5), 5, prior)
    assert (direct.linear(pair) == mapped.linear(turned)).all()
    for a, b in zip(direct.mixture(pair), mapped.mixture(turned), strict=True):
        assert np.all(a == b)


def test_covariances_of_means_are_those_of_their_pixels():
    """Against the sum over all pairs of pixels of two squares of 3 px."""
    prior, d, step = FieldPrior(contrast=1.0, level=0.01, length=3.0), 0.7, np.arange(-1, 2)
    weights = np.random.default_rng(1).random((2, 3, 3))
    table = Covariances(weights, 3, 4, 5, prior, side=3).of(d)
    rays = np.stack(np.meshgrid(step * d, step * d, indexing="ij"), -1).reshape(-1, 2)
    square = np.stack(np.meshgrid(step, step, indexing="ij"), -1).reshape(-1, 2)

    def shared(distance, first, second):
        gap = distance + second[None] - first[:, None]
        return prior.covariance(gap[..., 0], gap[..., 1])

    points = (rays[:, None] + square).reshape(-1, 2)
    for at in ((0, 0), (3, -2)):
        one, other = (np.repeat(w.ravel(), 9) / 9 for w in weights)
        place = at[0] + 3, at[1] + 4
        np.testing.assert_allclose(table.samples[*place, 0, 1], one @ shared(np.array(at), points, points) @ other)
        views = shared(np.array(at), rays, points) @ other
        np.testing.assert_allclose(table.field[*place, :, 1], views)


def test_windows_of_means_agree_with_the_tables():
    """The two ways to the covariances of a plane that faces the camera; the texture of one is interpolated."""
    prior, weights = FieldPrior(contrast=0.5), np.random.default_rng(2).random((2, 5, 5)) / 25
    table = Covariances(weights, 5, 15, 15, prior, side=5).of(0.5)
    y, x, response = np.array([2, 7, 12]), np.array([7, 2, 12]), np.array([0, 1, 1])
    window = Window((15, 15), y, x, weights[response], (5, 5, 5, 5), 5, 5)
    shared, field = window.covariances(Plane(0.5), prior)
    places = y - y[:, None] + 14, x - x[:, None] + 14
    np.testing.assert_allclose(shared, table.samples[*places, response[:, None], response], rtol=2e-3)
    assert field is not None and field.shape == (25 * 25, 3)


@pytest.mark.parametrize("name", ["lenslets", "mask", "random"])
def test_planes_come_back_from_every_camera(name):
    sensor, truth = _sensor(30, 30), _plane(1.0, 30, 30)
    camera = cameras.CAMERAS[name](sensor, 5)
    samples = camera.forward(truth)
    samples = samples + 0.002 * np.random.default_rng(0).standard_normal(samples.shape)
    got = FieldEstimator(camera, 5, PRIOR).mixture(samples)
    copied = psnr_db(np.broadcast_to(truth.mean((0, 1)), truth.shape), truth)
    assert psnr_db(got.light_field, truth) > copied + 6
    assert abs(np.median(got.disparity) - 1.0) < 0.2
    blank = FieldEstimator(camera, 5, PRIOR).linear(0.4 * camera.white)
    np.testing.assert_allclose(blank, 0.4, atol=5e-3)


def test_the_plain_camera_takes_a_plane_where_it_is_told():
    """One image and one disparity: the blur of a plane there is known, and taken back."""
    sensor, truth = _sensor(30, 30), _plane(1.0, 30, 30)
    camera = cameras.plain(sensor, 5)
    told = [replace(PRIOR, far=d, near=d, disparities=1) for d in (1.0, 0.0)]
    right, wrong = (psnr_db(FieldEstimator(camera, 5, p).linear(camera.forward(truth)), truth) for p in told)
    assert right > wrong + 6


def test_margins_of_parts_of_a_lenslet_are_refused():
    with pytest.raises(ParameterError, match="margin = 4"):
        FieldEstimator(cameras.lenslets(_sensor(30, 30), 5), 5, replace(PRIOR, margin=4))
