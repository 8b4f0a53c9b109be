"""Back from samples: what must come back exactly does, the rest to a bound."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.afe import trim_codes, trim_gain
from talbot.models.capture import CaptureOperator, cells
from talbot.models.parameters import (
    AmpTiming,
    ArrayParameters,
    OpticsParameters,
    ParameterError,
    SensorParameters,
    TileParameters,
)
from talbot.models.pixel import optical_gains, view_weights
from talbot.models.plan import codes_per_unit
from talbot.models.reconstruct import (
    EdgeOperator,
    Solver,
    demosaic,
    edge_images,
    image_from_edges,
    light_field_estimate,
    psnr_db,
    psnr_without_mean_db,
    rebuild,
    sum_image,
    white_sum,
)
from talbot.models.reconstruct.edges import laplacian
from talbot.models.scene import Sampling, load
from talbot.models.scene.test.focused import focused

TILE = TileParameters()


def _sensor(rows, cols):
    return SensorParameters(array=ArrayParameters(rows, cols))


def _random(shape, seed=0):
    return np.random.default_rng(seed).random(shape)


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 15), st.integers(1, 20), st.integers(1, (1 << 24) - 1))
def test_edge_images_hold_every_sample_once(rows, cols, mask):
    values = _random((rows, cols)) + 1
    kinds = TILE.type_map(rows, cols)
    read = (mask >> kinds & 1).astype(bool)
    images = edge_images(values, TILE, read)
    assert images.shape == (24, -(-rows // 4), -(-cols // 6))
    y, x = np.nonzero(read)
    np.testing.assert_array_equal(images[kinds[y, x], y // 4, x // 6], values[y, x])
    assert (images != 0).sum() == read.sum()


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 15), st.integers(1, 20))
def test_demosaic_passes_through_its_samples(rows, cols):
    values, kinds = _random((rows, cols)), TILE.type_map(rows, cols)
    spread = demosaic(values, TILE)
    np.testing.assert_allclose(np.take_along_axis(spread, kinds[None], 0)[0], values, atol=1e-12)
    assert spread.min() >= 0 and spread.max() <= values.max() + 1e-12


def test_demosaic_is_exact_on_a_ramp_inside():
    y, x = np.mgrid[:24, :36]
    spread = demosaic(0.1 * x + 0.3 * y, TILE)
    for kind in range(24):
        np.testing.assert_allclose(spread[kind, 4:-4, 6:-6], (0.1 * x + 0.3 * y)[4:-4, 6:-6])


def test_demosaic_of_an_unread_type_is_zero():
    kinds = TILE.type_map(8, 12)
    spread = demosaic(np.ones((8, 12)), TILE, kinds != 7)
    assert not spread[7].any() and (np.delete(spread, 7, 0) == 1).all()


def test_image_of_a_uniform_scene_is_uniform():
    sensor = _sensor(9, 13)
    pair = CaptureOperator(sensor).forward(np.full((5, 5, 9, 13), 0.4))
    np.testing.assert_allclose(sum_image(white_sum(sensor) / 2 * pair.sum(0), sensor), 0.4)


def test_image_clips_and_fills():
    sensor = _sensor(4, 6)
    sums = np.array([[-5.0, 300, 80, 80, 80, 80]] * 4)
    read = np.ones((4, 6), bool)
    read[:, 5] = False
    image = sum_image(sums, sensor, read)
    np.testing.assert_allclose(white_sum(sensor), 203.7, atol=0.1)  # 80 % of two full wells
    np.testing.assert_allclose(image[0] * white_sum(sensor), [0, 255, 80, 80, 80, 80], rtol=1e-9)
    assert not sum_image(sums, sensor, np.zeros((4, 6), bool)).any()


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_linear_estimate_of_a_uniform_scene_is_exact(dtype):
    sensor = _sensor(13, 20)
    operator = CaptureOperator(sensor, dtype)
    found = light_field_estimate(operator, operator.forward(np.full((5, 5, 13, 20), 0.3, dtype)))
    assert found.shape == (5, 5, 13, 20) and found.dtype == dtype
    np.testing.assert_allclose(found, 0.3, rtol=1e-5)


def test_views_that_the_pupil_does_not_reach_are_dark():
    sensor = replace(_sensor(8, 12), optics=OpticsParameters(views=7))
    operator = CaptureOperator(sensor)
    found = light_field_estimate(operator, operator.forward(np.full((7, 7, 8, 12), 0.3)))
    np.testing.assert_allclose(found, 0.3 * cells(7)[..., None, None] * np.ones((8, 12)))


def test_linear_estimate_leans_to_the_lit_view():
    """Light from one view only, everywhere: that view, or its neighbour, comes out brightest."""
    sensor = _sensor(8, 12)
    light = np.zeros((5, 5, 8, 12))
    light[1, 3] = 1
    operator = CaptureOperator(sensor)
    found = light_field_estimate(operator, operator.forward(light))
    assert np.unravel_index(found[:, :, 4, 6].argmax(), (5, 5)) == (1, 3)


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 12), st.integers(1, 14), st.integers(0, 99), st.booleans())
def test_edge_operator_and_its_adjoint(rows, cols, seed, masked):
    sensor = _sensor(rows, cols)
    read = _random((rows, cols), seed) < 0.5 if masked else None
    d = EdgeOperator(sensor, 6 * _random((rows, cols), seed + 1) - 3, np.ones(24), read)
    x, y = _random((rows, cols), seed + 2), _random((rows, cols), seed + 3)
    assert abs(np.vdot(d.forward(x), y) - np.vdot(x, d.transpose(y))) < 1e-10


def test_linear_estimate_from_some_types_and_from_none():
    sensor = _sensor(8, 12)
    kinds = sensor.tile.type_map(8, 12)
    some = CaptureOperator(sensor, read=kinds < 9)
    np.testing.assert_allclose(light_field_estimate(some, some.forward(np.full((5, 5, 8, 12), 0.3))), 0.3)
    none = CaptureOperator(sensor, read=np.zeros((8, 12), bool))
    assert not light_field_estimate(none, np.zeros((2, 8, 12))).any()
    with pytest.raises(ParameterError, match="angular"):
        light_field_estimate(CaptureOperator(sensor, angular=False), np.zeros((2, 8, 12)))


def test_edge_operator_is_the_trimmed_capture_of_a_plane():
    rows, cols = 24, 36
    scene = load("edge:30", focused(Sampling(rows, cols), -1.0))  # whole steps: bilinear is exact
    sensor = _sensor(rows, cols)
    g = optical_gains(sensor.tile, sensor.optics)
    a, b = CaptureOperator(sensor).forward(scene.light_field)
    kinds = sensor.tile.type_map(rows, cols)
    found = EdgeOperator(sensor, scene.disparity, g).forward(scene.image)
    np.testing.assert_allclose(found[4:-4, 4:-4], (a - g[kinds] * b)[4:-4, 4:-4], atol=1e-12)


def test_laplacian_is_symmetric_and_blind_to_the_mean():
    x, y = _random((7, 9)), _random((7, 9), 1)
    assert abs(np.vdot(laplacian(x), y) - np.vdot(x, laplacian(y))) < 1e-12
    assert np.abs(laplacian(np.ones((7, 9)))).max() == 0


def test_image_comes_back_from_its_edges():
    rows, cols = 96, 96
    sensor, scene = _sensor(rows, cols), load("camera", focused(Sampling(rows, cols), -2.0))
    d = EdgeOperator(sensor, scene.disparity, optical_gains(sensor.tile, sensor.optics))
    found = image_from_edges(d.forward(scene.image), d, Solver(smoothness=1e-5, iterations=80))
    assert abs(found.mean()) < 1e-12
    start = psnr_without_mean_db(np.zeros((rows, cols)), scene.image)
    assert psnr_without_mean_db(found, scene.image) > start + 10


def test_rebuild_from_codes():
    rows, cols = 96, 96
    sensor, scene = _sensor(rows, cols), load("camera", focused(Sampling(rows, cols), -2.0))
    trim = tuple(trim_codes(optical_gains(sensor.tile, sensor.optics)).tolist())
    values = EdgeOperator(sensor, scene.disparity, trim_gain(trim)).forward(scene.image)
    codes = np.rint(values * codes_per_unit(sensor, AmpTiming()))
    read = sensor.tile.type_map(rows, cols) != 3
    found = rebuild(codes, read, scene, sensor, trim)
    assert found.psnr_db > psnr_without_mean_db(np.zeros((rows, cols)), scene.image) + 6
    assert not rebuild(
        np.zeros((8, 12)), np.ones((8, 12), bool), load("flat", Sampling(8, 12)), _sensor(8, 12), trim
    ).image.any()


def test_nothing_comes_back_from_nothing():
    sensor = _sensor(8, 12)
    d = EdgeOperator(sensor, np.zeros((8, 12)), np.ones(24))
    with np.errstate(all="raise"):
        assert not image_from_edges(np.zeros((8, 12)), d).any()


def test_one_pixel_array():
    d = EdgeOperator(_sensor(1, 1), np.ones((1, 1)), np.ones(24))
    assert np.isfinite(image_from_edges(np.ones((1, 1)), d)).all()


def test_bad_arguments():
    with pytest.raises(ParameterError, match="disparity"):
        EdgeOperator(_sensor(8, 12), np.full((8, 12), np.nan), np.ones(24))
    with pytest.raises(ParameterError, match="smoothness"):
        Solver(smoothness=0)
    with pytest.raises(ParameterError, match="shape"):
        psnr_db(np.zeros(3), np.zeros(4))


def test_psnr():
    assert psnr_db(np.ones(4), np.ones(4)) is None
    np.testing.assert_allclose(psnr_db(np.full(4, 0.1), np.zeros(4)), 20.0)
    assert psnr_without_mean_db(np.arange(4.0) + 5, np.arange(4.0)) is None
    np.testing.assert_allclose(psnr_db(np.full(4, 25.5), np.zeros(4), 255.0), 20.0)


def test_weights_of_an_edge_sum_to_zero():
    sensor = _sensor(4, 6)
    d = EdgeOperator(sensor, np.zeros((4, 6)), optical_gains(sensor.tile, sensor.optics))
    assert np.abs(d.weights.sum((1, 2))).max() < 1e-14 and view_weights(sensor.tile, sensor.optics).min() > 0
