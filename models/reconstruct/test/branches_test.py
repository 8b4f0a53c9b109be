"""The two-branch network: its layers against SciPy's, patches, sizes, the weights that are shipped, bad input."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import correlate

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import ArrayParameters, ParameterError, SensorParameters
from talbot.models.pixel.weights import view_weights
from talbot.models.reconstruct.branches import CHANNELS, KINDS, PATCH, WEIGHTS, Branches, Seen, shapes

ROWS, COLS = 20, 30


def _sensor(rows=ROWS, cols=COLS, **more):
    return SensorParameters(array=ArrayParameters(rows, cols), **more)


def _weights():
    rng, sensor = np.random.default_rng(0), _sensor()
    out = {"phi": view_weights(sensor.tile, sensor.optics)}
    for kind in KINDS:
        out |= {f"{kind}/{name}": 0.1 * rng.standard_normal(shape) for name, shape in shapes().items()}
    return out


@pytest.fixture(scope="module")
def pair():
    return np.random.default_rng(1).random((2, ROWS, COLS))


def _convolved(weights, name, values):
    kernel, bias = weights[name], weights[f"{name}_bias"]
    return np.stack(
        [
            sum(correlate(v, k, mode="constant") for v, k in zip(values, kernels, strict=True)) + b
            for kernels, b in zip(kernel, bias, strict=True)
        ]
    )


def test_the_convolutions_are_those_that_it_says(pair):
    weights = _weights()
    values = Seen(pair, _sensor(), 0.05).back.astype(float)
    for number in range(len(CHANNELS) - 1):
        values = _convolved(weights, f"convolutions/conv_{number}", values)
        values = np.maximum(values, 0) if number < len(CHANNELS) - 2 else values
    found = Branches(weights).estimate(pair, _sensor(), 0.05, "convolutions") - pair.mean(0)
    np.testing.assert_allclose(found, values[0], rtol=1e-3, atol=1e-3 * np.abs(values[0]).max())


def test_the_autoencoder_is_the_one_that_it_says():
    """On an array of one patch, where nothing overlaps."""
    weights, one = _weights(), _sensor(PATCH, PATCH)
    pair = np.random.default_rng(2).random((2, PATCH, PATCH))
    (values,) = Seen(pair, one, 0.05).patches(np.zeros(1, int), np.zeros(1, int)).astype(float)
    for number in range(6):
        values = weights[f"autoencoder/dense_{number}"] @ values + weights[f"autoencoder/dense_{number}_bias"]
        values = np.maximum(values, 0) if number < 5 else values
    volume = values.reshape(1, 5, 5, PATCH, PATCH)
    near = np.maximum(_convolved(weights, "autoencoder/after_0", volume), 0)
    volume = (volume + _convolved(weights, "autoencoder/after_1", near))[0]
    found = Branches(weights).estimate(pair, one, 0.05, "autoencoder") - pair.mean(0)
    np.testing.assert_allclose(found, volume, rtol=1e-3, atol=1e-3 * np.abs(volume).max())


def test_both_are_the_mean_of_their_branches(pair):
    weights = _weights()
    for name in shapes():
        weights[f"{KINDS[name.startswith('conv')]}/{name}"] = weights[f"both/{name}"]
    parts = [Branches(weights).estimate(pair, _sensor(), 0.05, kind) for kind in KINDS]
    np.testing.assert_allclose(parts[2], (parts[0] + parts[1]) / 2, atol=1e-4)


@pytest.mark.parametrize("level", [0.0, 0.3])
def test_a_uniform_scene_shows_no_differences(level):
    pair = CaptureOperator(_sensor()).forward(np.full((5, 5, ROWS, COLS), level))
    seen = Seen(pair, _sensor(), 0.006)
    np.testing.assert_allclose(seen.total, level, atol=1e-6)
    np.testing.assert_allclose(seen.difference, 0, atol=1e-6)
    np.testing.assert_allclose(seen.back[1], 0, atol=1e-4)


@pytest.mark.parametrize("rows, cols", [(9, 9), (13, 17), (24, 11)])
def test_any_size_of_a_patch_or_more(rows, cols):
    found = Branches(_weights()).estimate(np.full((2, rows, cols), 0.5), _sensor(rows, cols), 0.01)
    assert found.shape == (5, 5, rows, cols) and np.isfinite(found).all()


def test_weights_that_are_shipped_are_small_and_leave_a_uniform_scene():
    assert WEIGHTS.stat().st_size < 3_000_000
    pair = CaptureOperator(_sensor()).forward(np.full((5, 5, ROWS, COLS), 0.5))
    for kind in KINDS:
        for noise in (0.006, 0.2):
            np.testing.assert_allclose(Branches.shipped().estimate(pair, _sensor(), noise, kind), 0.5, atol=0.1)


def test_it_knows_what_it_was_taught_with():
    net, own = Branches.shipped(), _sensor()
    assert net.knows(own) and not net.knows(_sensor(8, 30))
    assert not net.knows(replace(own, optics=replace(own.optics, views=7)))
    assert not net.knows(replace(own, optics=replace(own.optics, m=0.1)))


def test_bad_arguments(pair):
    with pytest.raises(ParameterError, match="pair shape"):
        Branches(_weights()).estimate(pair[:, 1:], _sensor(), 0.01)
    with pytest.raises(ParameterError, match="must be those of the training"):
        Branches(_weights()).estimate(pair, replace(_sensor(), optics=replace(_sensor().optics, m=0.05)), 0.01)
    with pytest.raises(ParameterError, match="both/dense_2 = weights of shape"):
        Branches(_weights() | {"both/dense_2": np.zeros((3, 3))})
