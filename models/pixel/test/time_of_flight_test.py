"""Time of flight: depth comes back, and the thesis's printed forms do not give it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.pixel.time_of_flight import (
    SPEED_OF_LIGHT,
    TAPS,
    demodulate,
    depth_of,
    phase_of,
    quadrature,
    tap_gains,
)

F_MOD = 20e6


@settings(max_examples=80, deadline=None)
@given(st.floats(1e-3, 7.49), st.floats(1e-6, 1e6))
def test_depth_and_albedo_come_back(depth, albedo):
    phase, found = demodulate(albedo * tap_gains(phase_of(depth, F_MOD)))
    np.testing.assert_allclose(depth_of(phase, F_MOD), depth, atol=1e-6)
    np.testing.assert_allclose(found, albedo)


def test_taps_follow_the_cosine():
    phase = 0.8
    np.testing.assert_allclose(2 * tap_gains(phase) - 1, np.cos(np.array(TAPS) + phase), atol=1e-12)


def test_printed_quotient_returns_minus_phase():
    """Eq. 5.3 divides by i(pi) - i(0)."""
    taps = tap_gains(0.6)
    np.testing.assert_allclose(np.arctan((taps[3] - taps[1]) / (taps[2] - taps[0])), -0.6)
    np.testing.assert_allclose(demodulate(taps)[0], 0.6)


def test_single_arctangent_loses_the_quadrant():
    taps = tap_gains(2.5)
    x, y = quadrature(taps)
    assert abs(np.arctan(y / x) - 2.5) > 3
    np.testing.assert_allclose(demodulate(taps)[0], 2.5)


def test_frequency_is_in_hertz():
    """d = c phase / (4 pi f) with the f of cos(2 pi f t): Eq. 5.1's cos(f t), in rad/s, would be 2 pi off."""
    depth = 1.5
    delay = 2 * depth / SPEED_OF_LIGHT
    np.testing.assert_allclose(phase_of(depth, F_MOD), 2 * np.pi * F_MOD * delay)
    np.testing.assert_allclose(depth_of(F_MOD * delay, F_MOD), depth / (2 * np.pi))


@pytest.mark.parametrize("level", [0.0, 1.0, 1e300])
def test_alike_taps_give_zero(level):
    with np.errstate(all="raise"):
        assert demodulate(np.full(4, level)) == (0, 0)


def test_range_is_half_a_wavelength():
    assert depth_of(2 * np.pi - 1e-9, F_MOD) == pytest.approx(SPEED_OF_LIGHT / (2 * F_MOD))
