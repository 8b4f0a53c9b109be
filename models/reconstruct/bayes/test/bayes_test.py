"""Light fields by Bayes' rule: covariances against their definition, planes of known disparity, bad input."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import ArrayParameters, ParameterError, SensorParameters, TileParameters
from talbot.models.pixel import view_weights
from talbot.models.reconstruct import light_field_estimate, psnr_db
from talbot.models.reconstruct.bayes import FieldEstimator, FieldPrior, scene
from talbot.models.reconstruct.bayes.covariance import Covariances
from talbot.models.reconstruct.bayes.scene import classes
from talbot.models.reconstruct.bayes.windows import Axis
from talbot.models.reconstruct.refocus import refocus

PRIOR = FieldPrior(far=-2, near=2, disparities=9, noise=0.002)
ROWS, COLS = 30, 44  # partial tiles at both ends


def _sensor(rows=ROWS, cols=COLS, **more):
    return SensorParameters(array=ArrayParameters(rows, cols), **more)


def _texture(y, x):
    k = 2 * np.pi / 13
    return 0.5 + 0.12 * (np.sin(k * x) + np.sin(k * y + 1) + np.sin(0.8 * k * (x + y)))


def _plane(disparity, rows=ROWS, cols=COLS):
    """Light field (5, 5, rows, cols) of a textured plane."""
    y, x = np.mgrid[:rows, :cols].astype(float)
    steps = np.arange(-2, 3) * disparity
    return np.array([[_texture(y + dv, x + du) for du in steps] for dv in steps])


def _seen(field, noise=0.002, seed=0):
    pair = CaptureOperator(_sensor(*field.shape[2:])).forward(field)
    return pair + noise * np.random.default_rng(seed).standard_normal(pair.shape)


@pytest.fixture(scope="module")
def estimator():
    return FieldEstimator(_sensor(), 5, PRIOR)


def test_covariances_are_those_of_their_definition():
    """Against samples of random planes, added up view by view: the covariance of many draws."""
    sensor = _sensor()
    weights = view_weights(sensor.tile, sensor.optics)[:3].reshape(6, 5, 5)
    prior, d = FieldPrior(contrast=1.0, level=0.01, length=3.0), 1.5
    table = Covariances(weights, 5, 4, 3, prior).of(d)
    steps = np.arange(-2, 3) * d

    def points(y, x):
        return np.array([[(y + v, x + u) for u in steps] for v in steps]).reshape(-1, 2)

    def shared(a, b):
        gap = a[:, None] - b[None]
        return prior.covariance(gap[..., 0], gap[..., 1])

    origin, other = points(0, 0), points(2, -1)
    for i, j in ((0, 0), (1, 4), (5, 2)):
        direct = weights[i].ravel() @ shared(origin, other) @ weights[j].ravel()
        np.testing.assert_allclose(table.samples[2 + 3, -1 + 2, i, j], direct, rtol=1e-9)
    for view in (0, 7, 24):
        direct = shared(origin[view : view + 1], other) @ weights[4].ravel()
        np.testing.assert_allclose(table.field[2 + 3, -1 + 2, view, 4], direct[0], rtol=1e-9)


@pytest.mark.parametrize("length, period, margin", [(30, 4, 4), (44, 6, 4), (3, 4, 4), (1, 1, 0), (9, 6, 16)])
def test_every_pixel_is_in_a_block_inside_its_window(length, period, margin):
    axis = Axis.of(length, period, margin)
    covered, blocks = np.zeros(length, bool), []
    for group in axis.groups():
        first = np.arange(length)[group.windows]
        blocks += list(np.arange(len(axis.blocks))[group.blocks])
        np.testing.assert_array_equal(first + group.offset, axis.blocks[group.blocks])
        assert (first % period == group.phase).all() and first.max() + axis.window <= length
        assert 0 <= group.offset <= axis.window - axis.block
        for start in first + group.offset:
            covered[start : start + axis.block] = True
    assert covered.all() and sorted(blocks) == list(range(len(axis.blocks)))
    np.testing.assert_allclose(axis.spread().sum(1), 1)


def test_blocks_that_are_taken_go_back_to_their_places(estimator):
    blocks, values = estimator.blocks, np.random.default_rng(3).random((1, ROWS, COLS), np.float32)
    out = np.zeros((1, 1, ROWS, COLS), np.float32)
    for group in blocks.groups:
        blocks.place(out, blocks.taken(values, *group)[0], *group)
    assert (out[0] == values).all()


def test_the_grid_is_the_same_for_both_estimates(estimator):
    """The mixture's planes at the grid's disparities, and those between, are as their own covariances make them."""
    single = FieldEstimator(_sensor(), 5, replace(PRIOR, far=1.75, near=1.75, disparities=1))
    for group in estimator.blocks.groups:
        between, whole = (estimator._facing.solver(number, group) for number in (15, 14))
        own = single._facing.solver(0, group)
        assert estimator.prior.fine[15] == 1.75
        np.testing.assert_allclose(between.field, own.field, atol=1e-6)
        assert not np.allclose(whole.field, own.field, atol=1e-3)
        samples = np.random.default_rng(1).random((len(own.factor[0]), 2), np.float32)
        np.testing.assert_allclose(between(samples), own(samples), rtol=1e-2, atol=1e-2)


def test_a_uniform_scene_comes_back_uniform(estimator):
    pair = _seen(np.full((5, 5, ROWS, COLS), 0.4), noise=0)
    np.testing.assert_allclose(estimator.linear(pair), 0.4, atol=2e-3)
    np.testing.assert_allclose(estimator.mixture(pair).light_field, 0.4, atol=2e-3)


@pytest.mark.parametrize("disparity", [-1.5, 1.0, 2.0])
def test_planes_come_back_with_their_parallax(estimator, disparity):
    truth = _plane(disparity)
    pair = _seen(truth)
    copied = np.broadcast_to(pair.mean(0), truth.shape)
    free = max(psnr_db(copied, truth), psnr_db(light_field_estimate(CaptureOperator(_sensor()), pair), truth))
    linear, mixture = estimator.linear(pair), estimator.mixture(pair)
    assert psnr_db(linear, truth) > free + 3
    assert psnr_db(mixture.light_field, truth) > free + 6
    a, b = (field[2, 4] - field[2, 0] for field in (mixture.light_field, truth))
    assert 0.9 < (a * b).sum() / (b * b).sum() < 1.1
    assert abs(np.median(mixture.disparity) - disparity) < 0.15


def test_without_texture_the_disparity_is_uncertain(estimator):
    spread = estimator.mixture(_seen(np.full((5, 5, ROWS, COLS), 0.4))).spread
    textured = estimator.mixture(_seen(_plane(1.0))).spread
    assert spread.min() > 1 and (textured < 0.25).mean() > 0.8


def test_where_two_planes_meet_the_mixture_is_no_worse_than_the_linear_estimate(estimator):
    """Bars in the focal plane before a wall far behind: no window shows one disparity."""
    _, x = np.mgrid[:ROWS, :COLS]
    truth = np.where(x // 4 % 2 == 0, 0.2, _plane(-1.5))
    pair = _seen(truth)
    mixture, linear = estimator.mixture(pair), estimator.linear(pair)
    assert psnr_db(mixture.light_field, truth) > psnr_db(linear, truth) - 0.2
    assert np.median(mixture.spread) > 0.5


def test_the_linear_estimate_takes_the_disparities_of_each_part_of_the_scene(estimator):
    """Two planes side by side, each as well as alone: the other's disparity costs nothing away from it."""
    truth, half = _plane(1.5), COLS // 2
    truth[..., half:] = _plane(-1.5)[..., half:]
    shares = estimator._shares(estimator._windows(_seen(truth)))
    np.testing.assert_allclose(shares.sum(0), 1)
    for d, columns in ((1.5, slice(0, 2)), (-1.5, slice(-2, None))):
        assert shares[np.abs(PRIOR.grid - d) <= 0.5][..., columns].sum(0).min() > 0.6
        alone = _plane(d)
        rest = np.s_[..., : half - 8] if d > 0 else np.s_[..., half + 8 :]
        both = psnr_db(estimator.linear(_seen(truth))[rest], truth[rest])
        assert both > psnr_db(estimator.linear(_seen(alone))[rest], alone[rest]) - 1


def test_windows_of_like_shares_are_a_class():
    shares = np.eye(4)[:, [0, 1, 1, 3, 0, 2]]
    kinds = classes(shares, 4)
    assert len(set(kinds)) == 4 and kinds[0] == kinds[4] and kinds[1] == kinds[2]
    assert not classes(shares, 1).any()
    assert not classes(np.full((4, 5), 0.25), 3).any()  # all alike


def test_classes_cost_little(monkeypatch, estimator):
    """One filter for windows of like shares is nearly one for each."""
    truth = _plane(1.0)
    truth[..., COLS // 2 :] = _plane(-1.5)[..., COLS // 2 :]
    pair = _seen(truth)
    few = psnr_db(estimator.linear(pair), truth)
    monkeypatch.setattr(scene, "CLASSES", 1000)
    assert psnr_db(estimator.linear(pair), truth) < few + 0.5


def test_black_white_and_saturated_samples_give_finite_values(estimator):
    for pair in (np.zeros((2, ROWS, COLS)), np.full((2, ROWS, COLS), 1.25)):
        for values in (estimator.linear(pair), *estimator.mixture(pair)):
            assert np.isfinite(values).all()


def test_a_missing_pixel_type_costs_little():
    measured = np.arange(24) != 7
    truth = _plane(1.0)
    pair = _seen(truth)
    pair[:, ~measured[TileParameters().type_map(ROWS, COLS)]] = 9.0  # must not be looked at
    copied = psnr_db(np.broadcast_to(pair.mean(0), truth.shape), truth)
    assert psnr_db(FieldEstimator(_sensor(), 5, PRIOR, measured=measured).linear(pair), truth) > copied + 6


@pytest.mark.parametrize("rows, cols", [(1, 1), (3, 5), (4, 6)])
def test_small_arrays(rows, cols):
    found = FieldEstimator(_sensor(rows, cols), 5, PRIOR).mixture(_seen(np.full((5, 5, rows, cols), 0.3)))
    np.testing.assert_allclose(found.light_field, 0.3, atol=0.03)


def test_refocus_brings_a_plane_back():
    truth = _plane(1.0)
    inside = slice(4, -4), slice(4, -4)
    sharp = psnr_db(refocus(truth, 1.0)[inside], truth[2, 2][inside])
    assert sharp is None or sharp > 60
    assert psnr_db(refocus(truth, -1.0)[inside], truth[2, 2][inside]) < 25


def test_bad_arguments(estimator):
    with pytest.raises(ParameterError, match="near = -1"):
        FieldPrior(far=0, near=-1)
    with pytest.raises(ParameterError, match="noise = 0"):
        FieldPrior(noise=0)
    with pytest.raises(ParameterError, match="pair shape"):
        estimator.linear(np.zeros((2, 4, 4)))
    with pytest.raises(ParameterError, match="measured"):
        FieldEstimator(_sensor(), 5, PRIOR, measured=np.zeros(24, bool))


def _rough(contrast, disparity, size, seed=3):
    """Light field of a plane with waves of all lengths, of this standard deviation, (5, 5, size, size)."""
    rng = np.random.default_rng(seed)
    waves = [(rng.normal(0, 0.5, 2), rng.uniform(0, 2 * np.pi)) for _ in range(40)]
    y, x = np.mgrid[:size, :size].astype(float)
    steps = np.arange(-2, 3) * disparity

    def texture(y, x):
        return sum(np.sin(k[0] * y + k[1] * x + phase) for k, phase in waves) / np.sqrt(len(waves) / 2)

    return 0.4 + contrast * np.array([[texture(y + dv, x + du) for du in steps] for dv in steps])


def test_a_frame_of_little_contrast_has_a_prior_of_its_own():
    """Noise would be taken for parallax of the contrast that is expected: a tenth of it is there."""
    truth, noise = _rough(0.02, 1.0, 48), 0.006
    pair = _seen(truth, noise)
    prior = FieldPrior(far=-2, near=2, disparities=9, slants=0)
    contrast = prior.contrast_of(pair.mean(0), noise)
    assert contrast in (prior.contrast / 4, prior.contrast / 8**0.5, prior.contrast / 2)
    errors = [
        psnr_db(FieldEstimator(_sensor(48, 48), 5, one).linear(pair), truth)
        for one in (prior, replace(prior, contrast=contrast))
    ]
    assert errors[1] > errors[0] + 0.5


def test_contrast_is_never_above_the_priors_nor_far_below():
    rng = np.random.default_rng(0)
    assert FieldPrior().contrast_of(rng.random((40, 30)), 0.006) == FieldPrior().contrast
    for empty in (np.zeros((40, 30)), 0.006 * rng.standard_normal((40, 30))):
        assert FieldPrior().contrast_of(empty, 0.006) == FieldPrior().contrast / 4
    assert FieldPrior().contrast_of(np.ones((1, 1)), 0.006) == FieldPrior().contrast
