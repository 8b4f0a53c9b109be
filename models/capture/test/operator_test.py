"""The capture operator: against the formula written out, its adjoint, and what it leaves out."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.capture import CaptureOperator
from talbot.models.capture.operator import rounding
from talbot.models.parameters import ArrayParameters, OpticsParameters, ParameterError, SensorParameters
from talbot.models.pixel import view_weights


def _sensor(rows, cols, views=3):
    return SensorParameters(array=ArrayParameters(rows, cols), optics=OpticsParameters(views=views, subsamples=4))


def _random(shape, dtype="float64", seed=0):
    return np.random.default_rng(seed).random(shape).astype(dtype)


@pytest.mark.parametrize("dtype,bound", [("float64", 1e-14), ("float32", 1e-5)])
def test_forward_is_eq_3_3(dtype, bound):
    sensor = _sensor(9, 14)
    operator = CaptureOperator(sensor, dtype)
    light = _random(operator.shape)
    kinds = sensor.tile.type_map(9, 14)
    expected = np.einsum("yxdvu,vuyx->dyx", view_weights(sensor.tile, sensor.optics)[kinds], light)
    found = operator.forward(light.astype(dtype))
    assert found.dtype == dtype and np.abs(found - expected).max() < bound


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 13), st.integers(1, 20), st.sampled_from([1, 2, 3]), st.integers(0, 9), st.booleans())
def test_transpose_is_the_adjoint(rows, cols, views, seed, masked):
    """<Phi x, y> = <x, Phi' y>."""
    read = _random((rows, cols), seed=seed) < 0.4 if masked else None
    operator = CaptureOperator(_sensor(rows, cols, views), read=read)
    x, y = _random(operator.shape, seed=seed) - 0.5, _random((2, rows, cols), seed=seed + 1) - 0.5
    left, right = np.vdot(operator.forward(x), y), np.vdot(x, operator.transpose(y))
    assert abs(left - right) <= 1e-12 * max(1, rows * cols)


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 13), st.integers(1, 20), st.integers(0, 9), st.integers(1, (1 << 24) - 1))
def test_leaving_types_out_changes_no_bit_of_the_rest(rows, cols, seed, mask):
    sensor = _sensor(rows, cols)
    read = (mask >> sensor.tile.type_map(rows, cols) & 1).astype(bool)
    whole, part = CaptureOperator(sensor), CaptureOperator(sensor, read=read)
    light = _random(whole.shape, seed=seed)
    expected, found = whole.forward(light), part.forward(light)
    np.testing.assert_array_equal(found[:, read], expected[:, read])
    assert not found[:, ~read].any()


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_one_view_represents_all_within_the_bound(dtype):
    sensor = _sensor(20, 30, views=5)
    one = CaptureOperator(sensor, dtype, angular=False)
    image = _random((20, 30), dtype)
    few = one.forward(image[None, None])
    full = CaptureOperator(sensor, dtype).forward(np.broadcast_to(image, (5, 5, 20, 30)))
    assert (np.abs(few - full) <= rounding(dtype, 5) * few).all()


def test_read_of_everything_is_nothing_left_out():
    sensor = _sensor(8, 12)
    assert CaptureOperator(sensor, read=np.ones((8, 12), bool)).read is None


@pytest.mark.parametrize(
    "light,field",
    [
        (np.zeros((3, 3, 8, 11)), "light_field"),
        (np.zeros((1, 1, 8, 12)), "light_field"),
        (np.zeros((3, 3, 8, 12), np.float32), "light_field"),
    ],
)
def test_wrong_light_fields(light, field):
    with pytest.raises(ParameterError, match=field):
        CaptureOperator(_sensor(8, 12)).forward(light)


def test_wrong_arguments():
    sensor = _sensor(8, 12)
    with pytest.raises(ParameterError, match="pair"):
        CaptureOperator(sensor).transpose(np.zeros((2, 8, 11)))
    with pytest.raises(ParameterError, match="read shape"):
        CaptureOperator(sensor, read=np.ones((8, 11), bool))
    with pytest.raises(ParameterError, match="dtype"):
        CaptureOperator(sensor, "float16")


def test_weights_follow_the_parameters():
    sensor = _sensor(8, 12)
    flat = replace(sensor, optics=replace(sensor.optics, m=0.0))
    pair = CaptureOperator(flat).forward(np.ones((3, 3, 8, 12)))
    np.testing.assert_allclose(pair[0], pair[1])  # m = 0: both diodes see the same
    np.testing.assert_allclose(pair, 1)
