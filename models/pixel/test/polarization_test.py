"""Polarization: the angle comes back, and the thesis's printed forms do not give it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.pixel.polarization import angle, stokes, transmission

FOUR = np.deg2rad([0.0, 45.0, 90.0, 135.0])
psis = st.floats(-np.pi / 2 + 1e-6, np.pi / 2)


def _intensities(psi, degree=0.25, d=1 / 3, radiance=0.7):
    s = degree * np.array([np.cos(2 * psi), np.sin(2 * psi)])
    return radiance * transmission(s, FOUR, d)


@settings(max_examples=60, deadline=None)
@given(psis, st.floats(0.01, 1.0), st.floats(0.01, 1.0))
def test_angle_and_degree_come_back(psi, degree, d):
    s1, s2 = stokes(*_intensities(psi, degree, d), d)
    assert abs(np.sin(angle(s1, s2) - psi)) < 1e-6  # modulo pi
    np.testing.assert_allclose(np.hypot(s1, s2), degree, rtol=1e-9)


@given(psis)
@settings(max_examples=30, deadline=None)
def test_response_has_period_pi(psi):
    np.testing.assert_allclose(_intensities(psi), _intensities(psi + np.pi), atol=1e-12)


def test_printed_psi_lacks_the_half():
    i0, i45, i90, i135 = _intensities(np.deg2rad(20.0))
    printed = np.arctan((i45 - i135) / (i0 - i90))
    np.testing.assert_allclose(np.rad2deg(printed), 40.0)  # twice the angle
    np.testing.assert_allclose(np.rad2deg(angle(i90 - i0, i135 - i45)), 20.0)


def test_printed_cosine_is_not_a_polarizer():
    """cos(2 psi + gamma + pi) does not return when the grating turns by half a turn; cos(2 psi - 2 gamma + pi) does."""
    psi, gamma = 0.3, 0.4
    printed, right = (lambda g: np.cos(2 * psi + g + np.pi)), (lambda g: np.cos(2 * psi - 2 * g + np.pi))
    assert abs(printed(gamma) - printed(gamma + np.pi)) > 0.1
    np.testing.assert_allclose(right(gamma), right(gamma + np.pi))
    s = np.array([np.cos(2 * psi), np.sin(2 * psi)])
    np.testing.assert_allclose(transmission(s, gamma, 1.0), 1 + right(gamma))


@pytest.mark.parametrize("dark", [0.0, 5e-324])
def test_dark_pixels_have_no_polarization(dark):
    with np.errstate(all="raise", under="ignore"):
        out = stokes(*np.full((4, 3), dark), 1 / 3)
    np.testing.assert_array_equal(out, 0)
