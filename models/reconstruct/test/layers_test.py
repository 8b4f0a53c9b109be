"""Layers: warps and their transposes, surfaces, and two planes of which one hides the other."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import ArrayParameters, SensorParameters
from talbot.models.reconstruct import psnr_db
from talbot.models.reconstruct.bayes import FieldEstimator, FieldPrior
from talbot.models.reconstruct.layers import layered, surfaces_of
from talbot.models.reconstruct.stack import Stack
from talbot.models.reconstruct.warps import gather, gather_linear, scatter, scatter_linear

ROWS, COLS, VIEWS, MARGIN = 48, 54, 5, 9
SENSOR = SensorParameters(array=ArrayParameters(ROWS, COLS))
STEPS = np.arange(VIEWS) - 2.0
NOISE = 0.003


def random(shape, seed=0):
    return np.random.default_rng(seed).standard_normal(shape).astype(np.float32)


@pytest.mark.parametrize("there, back", [(gather, scatter), (gather_linear, scatter_linear)])
def test_what_is_put_back_is_the_transpose(there, back):
    """Also of places beyond the border"""
    picture, values = random((17, 23)), random((11, 12), 1)
    y, x = (place.astype(np.float32) for place in np.random.default_rng(2).uniform(-4, 27, (2, 11, 12)))
    out, put = np.empty_like(values), np.zeros_like(picture)
    there(picture, y, x, out)
    back(put, y, x, values)
    assert np.vdot(out, values) == pytest.approx(np.vdot(picture, put), rel=1e-4)


@pytest.mark.parametrize("there", [gather, gather_linear])
def test_a_ramp_is_a_ramp_between_pixels(there):
    ramp = np.add.outer(3 * np.arange(20.0), -np.arange(30.0)).astype(np.float32)
    y, x = (place.astype(np.float32) for place in np.random.default_rng(3).uniform(1, 17, (2, 9, 9)))
    out = np.empty_like(y)
    there(ramp, y, x, out)
    np.testing.assert_allclose(out, 3 * y - x, atol=1e-4)


def plane(disparity, down=0.0, across=0.0):
    y, x = np.indices((ROWS + 2 * MARGIN, COLS + 2 * MARGIN)) - MARGIN
    return (disparity + down * y + across * x).astype(np.float32)


def test_textures_are_the_transpose_of_the_light_field():
    stack = Stack([plane(1.0, 0.01), plane(-1.0)], STEPS, MARGIN)
    seen = stack.seen([(random(stack.whole) > 0).astype(np.float32)])
    np.testing.assert_allclose(sum(seen), 1, atol=1e-6)
    textures, field = random((2, *stack.whole), 4), random(stack.shape, 5)
    there, back = np.vdot(stack.field(textures, seen), field), np.vdot(textures, stack.textures(field, seen))
    assert there == pytest.approx(back, rel=1e-3)


def test_a_view_shows_what_the_plane_has_there():
    """Of a slanted plane: the disparity of the place that is seen, not of the pixel"""
    stack = Stack([plane(0.5, across=0.02)], STEPS, MARGIN)
    y, x = np.indices((ROWS, COLS))
    place = (x + 2 * 0.5) / (1 - 2 * 0.02)
    np.testing.assert_allclose(stack.places[0, 1, 2, 4] - MARGIN, place, atol=1e-3)
    np.testing.assert_allclose(stack.places[0, 0, 2, 4] - MARGIN, y, atol=1e-6)


def test_surfaces_are_found_from_the_nearest_on():
    """Two slanted planes and a patch that nobody is sure of"""
    y, x = np.indices((ROWS, COLS))
    label = (x + 0.3 * y > 30).astype(int)  # 1: the nearer one
    far, near = -1 + 0.01 * y, 0.8 - 0.005 * x
    disparity = np.where(label, near, far) + 0.03 * random((ROWS, COLS))
    spread = np.full((ROWS, COLS), 0.1)
    spread[10:20, 10:20], disparity[10:20, 10:20] = 2.0, 0.0
    surfaces = surfaces_of(disparity, spread, MARGIN)
    assert len(surfaces.disparity) == 2 and (surfaces.label == 1 - label).mean() > 0.98
    inner = (slice(MARGIN, -MARGIN),) * 2
    for found, true in zip(surfaces.disparity, (near, far), strict=True):
        assert np.abs(found[inner] - true).max() < 0.1
    assert surfaces_of(disparity, spread + 1, MARGIN).disparity == []


def texture(y, x, seed):
    """Waves in all directions down to 4 px."""
    rng = np.random.default_rng(seed)
    waves = zip(rng.uniform(0, np.pi, 24), rng.uniform(0, 6.28, 24), np.geomspace(4, 40, 24), strict=True)
    return 0.5 + sum(
        0.03 * np.sin(2 * np.pi / length * (np.cos(a) * y + np.sin(a) * x) + phase) for a, phase, length in waves
    )


def two_planes(views):
    """Light field of a plane before another, exact in every view: the nearer ends with a slanted edge."""
    y, x = np.indices((ROWS, COLS), float)
    out = np.empty((views, views, ROWS, COLS))
    for v, u in np.ndindex(views, views):
        dv, du = ((place - (views - 1) / 2) * VIEWS / views for place in (v, u))
        near, far = (texture(y + dv * d, x + du * d, seed) for d, seed in ((0.8, 1), (-1.2, 2)))
        out[v, u] = np.where(x + du * 0.8 + 0.3 * (y + dv * 0.8) > 33, near, far)
    return out


@pytest.fixture(scope="module")
def estimated():
    """(the mixture, samples, light field, mixture's noise) of `two_planes`."""
    seen = CaptureOperator(replace(SENSOR, optics=replace(SENSOR.optics, views=15)))
    pair = seen.forward(two_planes(15))
    pair = pair + NOISE * np.random.default_rng(6).standard_normal(pair.shape)
    prior = FieldPrior(slants=0)
    return FieldEstimator(SENSOR, VIEWS, prior, 7).mixture(pair), pair, two_planes(VIEWS), prior.noise


@pytest.mark.slow
def test_layers_gain_where_a_plane_hides_another(estimated):
    mixture, pair, truth, noise = estimated
    field = layered(mixture, SENSOR, 7, noise, pair)
    assert field.dtype == np.float32 and field.shape == truth.shape
    assert psnr_db(field, truth) > psnr_db(mixture.light_field, truth) + 0.5


@pytest.mark.slow
def test_where_layers_do_not_explain_the_samples_the_mixture_stays(estimated):
    """Samples of another scene; and a disparity that nobody is sure of"""
    mixture, pair, _, noise = estimated
    other = pair[:, ::-1, ::-1] + 0.1 * random(pair.shape)
    np.testing.assert_array_equal(layered(mixture, SENSOR, 7, noise, other), mixture.light_field)
    unsure = mixture._replace(spread=np.full_like(mixture.spread, np.inf))
    np.testing.assert_array_equal(layered(unsure, SENSOR, 7, noise, pair), mixture.light_field)
