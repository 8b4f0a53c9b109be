"""Sparse coding: ADMM against the conditions of its optimum, dictionaries that are found again, light fields."""

import numpy as np
import pytest

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import ArrayParameters, ParameterError, SensorParameters
from talbot.models.reconstruct import psnr_db
from talbot.models.reconstruct.sparse import Coding, Dictionary, Lasso, SparseEstimator

ROWS, COLS = 30, 41


def _sensor(rows=ROWS, cols=COLS):
    return SensorParameters(array=ArrayParameters(rows, cols))


def _plane(disparity):
    y, x = np.mgrid[:ROWS, :COLS].astype(float)
    steps, k = np.arange(-2, 3) * disparity, 2 * np.pi / 13
    return np.array([[0.5 + 0.15 * (np.sin(k * (x + du)) + np.sin(k * (y + dv) + 1)) for du in steps] for dv in steps])


def _seen(field, noise=0.006):
    pair = CaptureOperator(_sensor()).forward(field)
    return pair + noise * np.random.default_rng(1).standard_normal(pair.shape)


def test_admm_ends_where_the_optimum_is():
    """A'(i - A x) is the penalty times the sign of every code that is not 0, and smaller where it is 0."""
    rng = np.random.default_rng(0)
    a, i = rng.standard_normal((30, 50)), rng.standard_normal((30, 4))
    penalty = rng.uniform(1, 3, (50, 1))
    codes = Lasso.of(a.T @ a).solve((a.T @ i).astype(np.float32), penalty, 4000)
    slope = a.T @ (i - a @ codes)
    used = codes != 0
    assert 0.1 < used.mean() < 0.7
    np.testing.assert_allclose(slope[used], (penalty * np.sign(codes))[used], atol=0.01)
    assert (np.abs(slope) <= penalty + 0.01).all()


def test_planes_come_back_with_parallax():
    truth = _plane(1.0)
    pair = _seen(truth)
    found = SparseEstimator(_sensor(), Coding(stride=3)).estimate(pair)
    assert psnr_db(found, truth) > psnr_db(np.broadcast_to(pair.mean(0), truth.shape), truth) + 3
    a, b = (field[2, 4] - field[2, 0] for field in (found, truth))
    assert 0.5 < (a * b).sum() / (b * b).sum() < 1.1


@pytest.mark.parametrize("stride", [1, 5, 9])
def test_a_uniform_scene_comes_back_uniform(stride):
    found = SparseEstimator(_sensor(), Coding(stride=stride)).estimate(_seen(np.full((5, 5, ROWS, COLS), 0.4), 0))
    np.testing.assert_allclose(found, 0.4, atol=2e-3)


def test_more_strides_more_atoms_and_more_processes():
    truth = _plane(1.0)
    pair = _seen(truth)
    fine, coarse = (SparseEstimator(_sensor(), Coding(stride=s)).estimate(pair) for s in (2, 9))
    assert psnr_db(fine, truth) > psnr_db(coarse, truth)
    few = SparseEstimator(_sensor(), Coding(stride=2, atoms=40)).estimate(pair)
    assert psnr_db(fine, truth) > psnr_db(few, truth)
    np.testing.assert_array_equal(SparseEstimator(_sensor(), Coding(stride=2, jobs=2)).estimate(pair), fine)


def test_noise_black_and_full_samples_give_finite_values():
    for pair, noise in (
        (np.zeros((2, ROWS, COLS)), 1e-5),
        (np.full((2, ROWS, COLS), 1.25), 1e-5),
        (_seen(_plane(1.0), 0.4), 0.4),
    ):
        assert np.abs(SparseEstimator(_sensor(), Coding(noise=noise)).estimate(pair)).max() < 3


def test_the_shipped_dictionary():
    own = Dictionary.shipped()
    np.testing.assert_allclose(np.linalg.norm(own.atoms.reshape(len(own.atoms), -1), axis=1), 1, atol=1e-5)
    assert np.ptp(own.atoms[0]) < 1e-6 and (own.sizes > 0).all()


def test_bad_arguments():
    for field, value in (("stride", 0), ("iterations", 0), ("penalty", -1), ("noise", 0), ("jobs", 0)):
        with pytest.raises(ParameterError, match=f"{field} = {value}"):
            Coding(**{field: value})
    with pytest.raises(ParameterError, match="stride = 10: must be in 1..9"):
        SparseEstimator(_sensor(), Coding(stride=10))
    with pytest.raises(ParameterError, match="rows, cols"):
        SparseEstimator(_sensor(8, 8))
    with pytest.raises(ParameterError, match="pair shape"):
        SparseEstimator(_sensor()).estimate(np.zeros((2, 4, 4)))
