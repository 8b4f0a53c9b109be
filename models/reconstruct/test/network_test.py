"""The network: convolutions against SciPy's, sizes, the weights that are shipped, bad input."""

import numpy as np
import pytest
from scipy.ndimage import correlate

from talbot.models.parameters import ParameterError
from talbot.models.reconstruct.bayes import Estimate
from talbot.models.reconstruct.network import INPUTS, LAYERS, WEIGHTS, Network, features


def _weights(scale=0.1):
    rng = np.random.default_rng(0)
    shapes = {name: (out, inside, 3, 3) for name, (inside, out) in LAYERS.items()}
    shapes |= {f"{name}_bias": (out,) for name, (_, out) in LAYERS.items()}
    return {name: scale * rng.standard_normal(shape) for name, shape in shapes.items()}


def _estimates(rows, cols, value=None):
    rng = np.random.default_rng(1)
    field = rng.random((5, 5, rows, cols)) if value is None else np.full((5, 5, rows, cols), value)
    return field, Estimate(field[::-1], np.zeros((rows, cols)), np.ones((rows, cols)))


def _direct(weights, values):
    """The network by SciPy's correlation, one pair of channels after the other."""

    def layers(values, *names):
        for name in names:
            kernels, bias = weights[name], weights[f"{name}_bias"]
            values = np.stack(
                [
                    sum(correlate(v, k, mode="constant") for v, k in zip(values, kernel, strict=True)) + b
                    for kernel, b in zip(kernels, bias, strict=True)
                ]
            )
            values = values if name == "full_4" else np.maximum(values, 0)
        return values

    def halved(v):
        return (v[:, ::2, ::2] + v[:, 1::2, ::2] + v[:, ::2, 1::2] + v[:, 1::2, 1::2]) / 4

    def doubled(v):
        return np.kron(v, np.ones((1, 2, 2)))

    full = layers(values, "full_1", "full_2")
    half = layers(halved(full), "half_1", "half_2")
    quarter = layers(halved(half), "quarter_1", "quarter_2")
    half = layers(half + doubled(quarter), "half_3", "half_4")
    return layers(full + doubled(half), "full_3", "full_4")


def test_it_is_the_convolutions_that_it_says():
    """Over more than one strip of rows, too."""
    weights, (linear, mixture) = _weights(), _estimates(20, 8)
    found = Network(weights).correct(linear, mixture, 0.05) - mixture.light_field
    direct = _direct(weights, features(linear, mixture, 0.05).astype(float))
    assert np.abs(direct).max() > 0.1
    np.testing.assert_allclose(found.reshape(25, 20, 8), direct, rtol=1e-3, atol=1e-3 * np.abs(direct).max())


@pytest.mark.parametrize("rows, cols", [(1, 1), (5, 7), (33, 18)])
def test_any_size(rows, cols):
    found = Network(_weights()).correct(*_estimates(rows, cols), 0.01)
    assert found.shape == (5, 5, rows, cols) and np.isfinite(found).all()


def test_what_it_sees():
    linear, mixture = _estimates(4, 6)
    seen = features(linear, mixture, 0.06)
    assert seen.shape == (INPUTS, 4, 6)
    np.testing.assert_allclose(seen[25:50].mean(0), 0, atol=1e-6)
    np.testing.assert_allclose(seen[-1], 1, atol=1e-6)


def test_weights_that_are_shipped_are_small_and_leave_a_uniform_scene():
    assert WEIGHTS.stat().st_size < 500_000
    for noise in (0.003, 0.2):
        found = Network.shipped().correct(*_estimates(24, 24, 0.5), noise)
        np.testing.assert_allclose(found, 0.5, atol=0.02)


def test_bad_arguments():
    with pytest.raises(ParameterError, match="views = 3: must be 5"):
        field = np.zeros((3, 3, 8, 8))
        Network(_weights()).correct(field, Estimate(field, field[0, 0], field[0, 0]), 0.01)
    with pytest.raises(ParameterError, match="full_2 = weights of shape"):
        Network(_weights() | {"full_2": np.zeros((3, 3, 3, 3))})
