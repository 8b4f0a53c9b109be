"""Slanted planes: covariances against draws of texture, slants that are there, values that follow a plane."""

import numpy as np
import pytest

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import ArrayParameters, SensorParameters
from talbot.models.reconstruct import psnr_db
from talbot.models.reconstruct.bayes import FieldEstimator, FieldPrior
from talbot.models.reconstruct.bayes.estimator import TEXTURE
from talbot.models.reconstruct.bayes.evidence import pooled
from talbot.models.reconstruct.bayes.planes import Plane, Window, texture_points
from talbot.models.reconstruct.bayes.slants import along, moved, slants_of

SLANT = 0.08


def _field(rows, cols, down, across, seed=1):
    """Light field (5, 5, rows, cols) of a plane of sines through the middle, and its disparity."""
    y, x = np.mgrid[:rows, :cols].astype(float)
    plane, steps = Plane(0.0, (down, across)), np.arange(-2.0, 3)
    rng = np.random.default_rng(seed)
    waves, phases = rng.uniform(-0.9, 0.9, (6, 2)), rng.uniform(0, 2 * np.pi, 6)
    middle = (rows - 1) / 2, (cols - 1) / 2
    out = np.zeros((5, 5, rows, cols))
    for v, dv in enumerate(steps):
        for u, du in enumerate(steps):
            sy, sx = plane.seen(y - middle[0], x - middle[1], dv, du)
            out[v, u] = 0.5 + sum(0.07 * np.sin(a * sy + b * sx + p) for (a, b), p in zip(waves, phases, strict=True))
    return out, down * (y - middle[0]) + across * (x - middle[1])


def test_a_slanted_plane_in_another_view_is_where_its_own_disparity_says():
    plane = Plane(1.2, (0.05, -0.1))
    y, x = plane.seen(np.array(3.0), np.array(-2.0), np.array(1.5), np.array(-1.0))
    disparity = 1.2 + 0.05 * y - 0.1 * x
    np.testing.assert_allclose([y - 1.5 * disparity, x + disparity], [3.0, -2.0])


def test_covariances_are_those_of_draws_of_the_texture():
    rng, prior = np.random.default_rng(0), FieldPrior(level=0.2, contrast=1.0, length=4.0)
    y, x = (p.ravel() for p in np.indices((3, 4)))
    weights = rng.normal(size=(12, 3, 3))
    window, plane = Window((3, 4), y, x, weights, (1, 1, 1, 2), 3), Plane(0.5, (0.1, -0.2))
    shared, field = window.covariances(plane, prior)
    # The texture itself, on the pixels around
    gy, gx = (p.ravel() - 5 for p in np.indices((13, 14)))
    texture = np.linalg.cholesky(
        prior.covariance(gy[:, None] - gy, gx[:, None] - gx) + 1e-9 * np.eye(len(gy))
    ) @ rng.normal(size=(len(gy), 20000))
    texture = texture.reshape(13, 14, -1)

    def look(py, px, dv, du):
        sy, sx = plane.seen(py - 1.0, px - 1.5, dv, du)
        return _cubic(texture, sy + 1.0 + 5, sx + 1.5 + 5)

    steps = np.arange(-1.0, 2)
    samples = [
        sum(w[v, u] * look(b, a, dv, du) for v, dv in enumerate(steps) for u, du in enumerate(steps))
        for w, b, a in zip(weights, y, x, strict=True)
    ]
    views = [look(1, a, dv, du) for a in (1, 2) for dv in steps for du in steps]
    scale = np.sqrt(np.diag(shared))
    np.testing.assert_allclose(np.cov(samples) / scale / scale[:, None], shared / scale / scale[:, None], atol=0.04)
    found = np.array(views) @ np.array(samples).T / texture.shape[-1]
    np.testing.assert_allclose(found / scale, field / scale, atol=0.04)


@pytest.mark.parametrize("views, slant", [(5, (0.08, 0.0)), (5, (-0.04, 0.12)), (9, (0.1, 0.0))])
def test_no_plane_needs_more_texture_than_is_said(views, slant):
    y, x = (p.ravel() for p in np.indices((12, 14)))
    window = Window((12, 14), y, x, np.ones((len(y), 7, 7)), (4, 4, 4, 6), views)
    for disparity in (-2.5, 0.0, 2.5):
        *_, size = window.texture(Plane(disparity, slant))
        assert size[0] * size[1] <= texture_points((12, 14), views, 2.5, slant) < 10_000


@pytest.mark.parametrize("views, slant", [(5, (0.24, 0.24)), (9, (0.0, -0.24))])
def test_a_plane_that_a_view_sees_from_its_edge_has_no_bound(views, slant):
    assert texture_points((12, 14), views, 2.5, slant) == np.inf


@pytest.mark.parametrize("far, views", [(-2.0, 9), (-20.0, 5)])
def test_slants_that_need_much_texture_are_left_out(far, views):
    """A plane so steep that outer views see it from its edge, and disparities of a whole array."""
    sensor, prior = SensorParameters(array=ArrayParameters(32, 40)), FieldPrior(far=far, near=-far, disparities=5)
    steep, spread = np.broadcast_to(0.2 * np.arange(40.0), (32, 40)), np.full((32, 40), 0.05)
    assert slants_of(steep, spread, 8) == [(0.0, 0.2)]
    assert FieldEstimator(sensor, views, prior)._slants_of(steep, spread) == []
    assert texture_points((12, 14), 5, 2.5, (0.0, 0.08)) < TEXTURE


def _cubic(texture, y, x):
    """[Keys1981] at one place."""

    def taps(at):
        t = at - np.floor(at)
        rows = np.array([[0, 2, 0, 0], [-1, 0, 1, 0], [2, -5, 4, -1], [-1, 3, -3, 1]]) / 2
        return np.array([1, t, t**2, t**3]) @ rows

    top, left = int(np.floor(y)) - 1, int(np.floor(x)) - 1
    return np.einsum("i,j,ijn->n", taps(y), taps(x), texture[top : top + 4, left : left + 4])


@pytest.mark.parametrize("slant", [(0.0, 0.0), (0.08, 0.0), (-0.04, 0.12)])
def test_slants_of_planes(slant):
    y, x = np.mgrid[:60, :70].astype(float)
    disparity = slant[0] * y + slant[1] * x
    found = slants_of(disparity, np.full(disparity.shape, 0.05), 8)
    assert found == ([slant] if any(slant) else [])
    assert slants_of(disparity, np.full(disparity.shape, 0.05), 0) == []


def test_the_most_frequent_slant_is_first():
    y, _ = np.mgrid[:60, :90].astype(float)
    disparity = np.where(np.arange(90) < 60, 0.08 * y, -0.12 * y)
    assert slants_of(disparity, np.full(disparity.shape, 0.05), 8)[:2] == [(0.08, 0.0), (-0.12, 0.0)]


def test_values_move_between_disparities():
    values = np.arange(5.0)[:, None, None] + np.zeros((5, 2, 3))
    steps = np.array([[0, 0.5, 1], [-0.25, 9, -9]])
    np.testing.assert_allclose(moved(values, steps)[2], [[2, 2.5, 3], [1.75, 4, 0]])
    np.testing.assert_allclose(moved(values, 1.5)[:, 0, 0], [1.5, 2.5, 3.5, 4, 4])


def test_a_mean_along_a_level_plane_is_the_pool_and_a_slanted_ridge_stays():
    level = np.random.default_rng(2).normal(size=(3, 40, 30))
    both = along(along(level, 2.5, 1, 0.0), 2.5, 2, 0.0)
    np.testing.assert_allclose(both[1], pooled(level[1], 2.5), atol=1e-12)
    numbers, y, _ = np.mgrid[:41, :30, :4].astype(float)
    ridge = np.maximum(1 - np.abs(numbers - 5 - y), 0)  # a disparity a pixel down
    np.testing.assert_allclose(along(ridge, 2.5, 1, 1.0)[:, 8:-8], ridge[:, 8:-8], atol=1e-12)


@pytest.mark.parametrize("slant", [(0.0, SLANT), pytest.param((-SLANT, 0.0), marks=pytest.mark.slow)])
@pytest.mark.slow
def test_a_slanted_plane_is_better_by_slanted_hypotheses(slant):
    """A wall in steep view, finely textured; its pixels have the disparities of the truth."""
    truth, disparity = _field(28, 36, *slant)
    sensor = SensorParameters(array=ArrayParameters(28, 36))
    pair = CaptureOperator(sensor).forward(truth)
    pair = pair + 0.002 * np.random.default_rng(0).standard_normal(pair.shape)
    gains = {}
    for slants in (0, 4):
        prior = FieldPrior(far=-2, near=2, disparities=9, noise=0.002, slants=slants)
        found = FieldEstimator(sensor, 5, prior).mixture(pair)
        gains[slants] = psnr_db(found.light_field, truth)
        wrong = np.abs(found.disparity - disparity)[6:-6, 6:-6]
    assert gains[4] > gains[0] + 1
    assert np.median(wrong) < 0.1  # of a step of 0.25
