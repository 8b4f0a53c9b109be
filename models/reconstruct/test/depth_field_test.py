"""Turns of a phase, refocused phasors and clusters of rays."""

import numpy as np
import pytest
from scipy.ndimage import minimum_filter

from talbot.models.parameters import ArrayParameters, ParameterError, SensorParameters
from talbot.models.reconstruct.bayes import FieldEstimator, FieldPrior
from talbot.models.reconstruct.depth_field import DepthField, depth_field, foreground, refocused, still, unwrap

SHAPE = 30, 40
SLOPE = np.linspace(0.4, 2.7, SHAPE[1]) * np.ones(SHAPE)  # turns


def phase_of(turns):
    """What is left of turns."""
    return 2 * np.pi * (turns % 1)


def test_a_slope_through_several_turns():
    coarse = SLOPE + np.random.default_rng(1).normal(0, 0.2, SHAPE)
    found = unwrap(phase_of(SLOPE), coarse, np.full(SHAPE, 0.2))
    np.testing.assert_allclose(found.turns, SLOPE, atol=1e-9)
    assert found.sure.all()


def test_one_sure_corner_tells_all_that_hangs_together():
    doubt = np.full(SHAPE, np.inf)
    doubt[:4, :4] = 0.1
    found = unwrap(phase_of(SLOPE), np.where(np.isfinite(doubt), SLOPE, 9.0), doubt)
    np.testing.assert_allclose(found.turns, SLOPE, atol=1e-9)


def test_an_edge_of_more_than_a_turn_has_its_own_turns_on_both_sides():
    turns = np.where(np.arange(SHAPE[1]) < 17, 0.7, 2.3) * np.ones(SHAPE)
    found = unwrap(phase_of(turns), turns + 0.2, np.full(SHAPE, 0.2))
    np.testing.assert_allclose(found.turns, turns, atol=1e-9)


@pytest.mark.parametrize("turns", [0.0, 1e-12, 0.999999, 1.0, 2.000001])
def test_a_phase_near_the_wrap(turns):
    found = unwrap(np.full(SHAPE, 2 * np.pi * (turns % 1)), np.full(SHAPE, turns + 0.1), np.full(SHAPE, 0.1))
    np.testing.assert_allclose(found.turns, turns, atol=1e-9)


def corner():
    """A wall, one that runs towards it, and 0.86 of a turn in front a block that hides parts of both."""
    x, y = np.arange(SHAPE[1]), np.arange(SHAPE[0])[:, None]
    turns = np.where(x < 20, 3.06, 3.06 - 0.08 * (x - 19)) * np.ones(SHAPE)
    return np.where((y > 14) & (x > 8) & (x < 22), 2.2, turns)


def test_a_coarse_depth_that_is_smeared_over_the_edges():
    turns = corner()
    coarse = minimum_filter(turns, 7) + np.random.default_rng(4).normal(0, 0.1, SHAPE)  # the block grows by 3 px
    found = unwrap(phase_of(turns), coarse, np.full(SHAPE, 0.15))
    plain = turns - np.rint(turns - coarse)
    assert (np.abs(found.turns - turns) > 0.5).mean() == 0 < 0.05 < (np.abs(plain - turns) > 0.5).mean()


@pytest.mark.parametrize("width", [8, 17, 30])
def test_an_edge_of_exactly_a_turn_is_right_or_not_sure(width):
    turns = np.where(np.arange(SHAPE[1]) < width, 0.7, 1.7) * np.ones(SHAPE)
    coarse = turns + np.random.default_rng(4).normal(0, 0.2, SHAPE)
    found = unwrap(phase_of(turns), coarse, np.full(SHAPE, 0.2))
    wrong = np.abs(found.turns - turns) > 0.5
    assert wrong.mean() >= 0.2 and (wrong & found.sure).mean() < 0.02  # no phase shows it


def test_a_pixel_without_phase_has_the_depth_around_it():
    phase = phase_of(SLOPE)
    phase[7, 9] = np.nan
    found = unwrap(phase, SLOPE, np.full(SHAPE, 0.1))
    assert found.turns[7, 9] == pytest.approx(SLOPE[7, 9], abs=0.05) and not found.sure[7, 9]


def test_no_phase_and_no_depth_are_not_sure():
    phase = phase_of(SLOPE)
    phase[5:9] = np.nan
    found = unwrap(phase, SLOPE, np.full(SHAPE, 0.1))
    assert np.isfinite(found.turns).all() and not found.sure[5:9].any() and found.sure[:5].all()
    nothing = unwrap(np.full(SHAPE, np.nan), SLOPE, np.full(SHAPE, 0.1))
    unknown = unwrap(np.random.default_rng(2).uniform(0, 6, SHAPE), np.full(SHAPE, np.nan), np.full(SHAPE, np.inf))
    assert not nothing.sure.any() and np.isfinite(unknown.turns).all()


def test_one_pixel():
    found = unwrap(np.array([[1.0]]), np.array([[2.1]]), np.array([[0.1]]))
    assert found.sure.all() and found.turns[0, 0] == pytest.approx(2 + 1 / (2 * np.pi))


def bars():
    """Depth field of bars in the focal plane before a wall at -1 px a view step, and what is a bar."""
    bar = np.arange(SHAPE[1]) // 4 % 2 == 0
    near = np.broadcast_to(bar, (5, 5, *SHAPE))
    phase = np.where(near, 0.5, 2.0)
    taps = np.stack([0.5 + 0.3 * np.cos(tap * np.pi / 2 + phase) for tap in range(4)])
    return DepthField(taps, np.zeros(SHAPE), np.full(SHAPE, 0.1)), near


def test_rays_of_the_occluder_are_those_of_its_phase():
    field, near = bars()
    np.testing.assert_array_equal(foreground(field, np.full(SHAPE, 0.5 / (2 * np.pi))), near)
    np.testing.assert_array_equal(foreground(field, np.full(SHAPE, 2.0 / (2 * np.pi))), ~near)


def test_the_rest_shows_the_wall_behind():
    field, near = bars()
    passed = refocused(field.phasors, -1.0, ~near)
    seen = np.abs(passed) > 0
    assert seen.mean() > 0.9
    np.testing.assert_allclose(np.angle(passed[seen]), 2.0, atol=1e-6)
    assert np.abs(np.angle(refocused(field.phasors, -1.0)) - 2.0).max() > 0.3


def test_darkness_has_one_cluster():
    dark = DepthField(np.zeros((4, 3, 3, 6, 8)), np.zeros((6, 8)), np.ones((6, 8)))
    assert foreground(dark, np.zeros((6, 8))) is None and not refocused(dark.phasors, 0.5).any()


def test_taps_keep_the_disparity_of_their_sum():
    estimator = FieldEstimator(SensorParameters(array=ArrayParameters(12, 18)), 5, FieldPrior(disparities=11))
    pairs = np.random.default_rng(3).random((4, 2, 12, 18))
    found = depth_field(estimator, pairs)
    whole = estimator.mixture(pairs.sum(0) / 2)
    np.testing.assert_array_equal(found.disparity, whole.disparity)
    # White noise of full scale, which the prior does not expect: the rounding of solves in float32
    np.testing.assert_allclose(found.taps.sum(0) / 2, whole.light_field, atol=5e-3)
    with pytest.raises(ParameterError, match="pairs = 2 taps"):
        depth_field(estimator, pairs[:2])


def test_an_edge_that_defocus_smears_does_not_hold_two_surfaces_together():
    """0.11 turns of phase over three pixels, 0.89 of depth: the disparity's turns count on both sides."""
    x = np.arange(40)
    true = np.where(x < 20, 1.0, 1.89) * np.ones((30, 1))
    phase = 2 * np.pi * (true % 1)
    for number, part in enumerate((0.3, 0.75)):
        phase[:, 19 + number] = 2 * np.pi * ((1 - 0.11 * part) % 1)
    coarse = true + np.random.default_rng(3).normal(0, 0.1, true.shape)
    found = unwrap(phase, coarse, np.full(true.shape, 0.2))
    away = np.abs(x - 19.5) > 2
    assert np.abs(found.turns - true)[:, away].max() < 0.01 and found.sure[:, away].mean() > 0.95


def test_a_mixture_of_two_surfaces_is_not_sure():
    x = np.arange(40)
    true = np.where(x < 20, 1.0, 1.4) * np.ones((30, 1))
    true[:, 20] = 1.2
    found = unwrap(phase_of(true), true, np.full(true.shape, 0.1))
    assert found.sure[:, :20].all() and found.sure[:, 21:].all() and not found.sure[:, 20].any()


def test_three_taps_are_four_where_nothing_moves():
    sensor = SensorParameters(array=ArrayParameters(rows=12, cols=18))
    estimator = FieldEstimator(sensor, 5, FieldPrior(disparities=3))
    rng = np.random.default_rng(4)
    mean, x, y = 0.5 + 0.1 * rng.random((3, 2, 12, 18))
    pairs = np.stack([mean + 0.3 * x, mean - 0.3 * y, mean - 0.3 * x, mean + 0.3 * y])
    four, three = depth_field(estimator, pairs), depth_field(estimator, pairs[:3])
    # The evidence is the same but for rounding, by which a window may be of another class: another estimate
    np.testing.assert_allclose(three.taps, four.taps, atol=5e-3)
    noisy = pairs + rng.normal(0, 0.01, pairs.shape)
    assert still(noisy, 0.01)
    noisy[3, :, 2:5, 3:9] += 0.2
    assert not still(noisy, 0.01)
    with pytest.raises(ParameterError, match="must be 3 or 4"):
        depth_field(estimator, pairs[:2])
