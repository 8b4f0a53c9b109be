"""Layers against their definition and their gradient, training, and files."""

import numpy as np
import pytest

from talbot.models.parameters import ParameterError
from talbot.models.recognition.network import Conv, Dense, Network, Pool, Relu, Signs, lenet
from talbot.models.recognition.statistics import first_layer_flops

RNG = np.random.default_rng(0)
PICTURES = RNG.standard_normal((6, 6, 6, 2)).astype(np.float32)
LABELS = np.array([0, 1, 2, 0, 1, 2])


def test_a_convolution_is_the_sum_over_its_window():
    layer = Conv(3, 3)
    net = Network([layer], (6, 6, 2))
    out, w = net.scores(PICTURES), layer.weights[0].reshape(3, 3, 2, 3)
    padded = np.pad(PICTURES, ((0, 0), (1, 1), (1, 1), (0, 0)))
    assert np.allclose(out[2, 4, 1], np.einsum("yxc,yxcf->f", padded[2, 4:7, 1:4], w), atol=1e-5)


@pytest.mark.parametrize(
    "layers",
    (
        lambda: [Conv(4, 3), Relu(), Dense(3)],
        lambda: [Conv(2, 3, same=False), Signs(), Conv(4, 3, same=False), Pool(), Dense(3)],
        lambda: [Signs(), Conv(3, 3), Pool(), Relu(), Conv(2, 3, same=False), Dense(3)],
    ),
)
def test_gradients_are_finite_differences(layers):
    net = Network(layers(), (6, 6, 2), 3)
    net.loss(PICTURES, LABELS)
    checked = [(layer, i) for layer in net.layers for i in range(len(layer.weights))]
    gradients = [layer.gradients[i].copy() for layer, i in checked]
    for (layer, i), gradient in zip(checked, gradients, strict=True):
        for place in RNG.integers(0, layer.weights[i].size, 4):
            flat, step = layer.weights[i].reshape(-1), 1e-3
            before = flat[place]
            ends = []
            for value in (before + step, before - step):
                flat[place] = value
                ends.append(net.loss(PICTURES, LABELS))
            flat[place] = before
            assert (ends[0] - ends[1]) / (2 * step) == pytest.approx(gradient.reshape(-1)[place], abs=2e-3, rel=0.03)


def bars(n, seed):
    """Horizontal and vertical bars, with noise."""
    rng = np.random.default_rng(seed)
    x, y = rng.normal(0, 0.4, (n, 8, 8, 1)), rng.integers(0, 2, n)
    for i, kind in enumerate(y):
        place = rng.integers(1, 7)
        x[(i, place) if kind else (i, slice(None), place)] += 2
    return x.astype(np.float32), y


def test_training_learns_and_repeats_and_its_file_gives_the_same_answers(tmp_path):
    (x, y), (new, truth) = bars(400, 1), bars(200, 2)
    nets = [Network(lenet(8, 2, [Conv(4, 3)]), (8, 8, 1), 7) for _ in range(2)]
    assert (nets[0].classify(new) == truth).mean() < 0.8
    for net in nets:
        net.train(x, y, 4)
    assert (nets[0].classify(new) == truth).mean() > 0.97
    assert np.array_equal(nets[0].scores(new), nets[1].scores(new))
    nets[0].save(tmp_path / "w.npz")
    other = Network(lenet(8, 2, [Conv(4, 3)]), (8, 8, 1), 8)
    other.load(tmp_path / "w.npz")
    assert (other.classify(new) == nets[0].classify(new)).mean() > 0.99
    with pytest.raises(ParameterError, match="same layers"):
        Network(lenet(8, 3, [Conv(4, 3)]), (8, 8, 1)).load(tmp_path / "w.npz")


def test_a_binary_layer_multiplies_by_signs_and_a_factor_an_output():
    conv, dense = Conv(3, 3, binary=True), Dense(4, binary=True)
    net = Network([conv, dense], (6, 6, 2))
    out = net.scores(PICTURES)
    for layer in (conv, dense):
        w = layer.weights[0]
        layer.weights = (np.where(w > 0, 1, -1) * np.abs(w).mean(0, keepdims=True), layer.weights[1])
        layer.binary = False
    assert np.allclose(net.scores(PICTURES), out, atol=1e-4) and net.additions == 0


def test_a_binary_network_learns_and_adds():
    (x, y), (new, truth) = bars(400, 1), bars(200, 2)
    net = Network(lenet(8, 2, [Conv(4, 3)], binary=True), (8, 8, 1), 7)
    net.train(x, y, 6)
    assert (net.classify(new) == truth).mean() > 0.9
    assert net.flops - net.additions == net.products[0] + 64 * 2


def test_fixed_filters_stay():
    layer = Conv(4, 3, fixed=True)
    net = Network(lenet(8, 2, [layer]), (8, 8, 1))
    before = layer.weights[0].copy()
    net.train(*bars(64, 1), 1)
    assert np.array_equal(layer.weights[0], before)


def test_operations_are_those_of_table_6_2():
    """Thesis Table 6.2: FLOPS of the first layer, of the original and of 12 filters."""
    table = (
        ((224, 224, 7, 96, 3), 708.0e6),
        ((224, 224, 7, 12, 3), 88.5e6),
        ((32, 32, 5, 192, 3), 14.75e6),
        ((32, 32, 5, 12, 3), 921.6e3),
        ((28, 28, 5, 20, 1), 392e3),
        ((28, 28, 5, 12, 1), 235e3),
    )
    for sizes, printed in table:
        assert first_layer_flops(*sizes) == pytest.approx(printed, rel=2e-3)
    net = Network([Conv(12, 5)], (28, 28, 1))
    assert net.flops == first_layer_flops(28, 28, 5, 12)


def test_a_picture_of_another_shape_is_refused():
    with pytest.raises(ParameterError, match="pictures = "):
        Network(lenet(8, 2), (8, 8, 1)).classify(np.zeros((1, 9, 9, 1)))
