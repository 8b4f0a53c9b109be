"""Polarization from common modes: right where it is seen, without confidence where it cannot be."""

import numpy as np
import pytest

from talbot.models.parameters import ParameterError, TileParameters
from talbot.models.pixel.polarization import angle, transmission
from talbot.models.reconstruct import demosaiced, polarization, specular_tags

TILE, D, NOISE = TileParameters(), 1 / 3, 0.003
SHAPE = 40, 48


def sums(light, psi, degree):
    """What the pixels of an array sum, without noise."""
    gamma = np.array([t.gamma for t in TILE.types])[TILE.type_map(*SHAPE)]
    stokes = np.broadcast_to(degree * np.stack([np.cos(2 * psi), np.sin(2 * psi)]), (2, *SHAPE))
    return light * transmission(stokes, gamma, D)


def turned(found, psi):
    """Largest distance of two angles modulo pi in degrees."""
    return np.rad2deg(np.abs((found - psi + np.pi / 2) % np.pi - np.pi / 2)).max()


@pytest.mark.parametrize("psi", np.deg2rad([0, 30, 45, 89.99, 90, -89.99, -45]))
def test_even_light_is_found_at_any_angle_and_near_the_wrap(psi):
    found = polarization(sums(0.5 * np.ones(SHAPE), np.full(SHAPE, psi), 0.25), TILE, D, NOISE)
    assert turned(found.psi, psi) < 1e-3 and found.confidence.min() > 0.5
    np.testing.assert_allclose(found.degree, 0.25, rtol=1e-5)
    np.testing.assert_allclose(found.light, 0.5, rtol=1e-5)


def test_a_gradient_is_no_polarization():
    ramp = np.linspace(0.2, 0.8, SHAPE[1]) * np.ones(SHAPE)
    found = polarization(sums(ramp, np.zeros(SHAPE), 0.0), TILE, D, NOISE)
    assert found.degree.max() < 1e-6 and not found.confidence.any()
    assert np.hypot(*demosaiced(ramp, TILE, D)).max() > 0.01


def test_an_edge_spoils_it_less_than_demosaicing():
    light = np.where(np.arange(SHAPE[1]) < 23, 0.2, 0.8) * np.ones(SHAPE)
    seen = sums(light, np.full(SHAPE, 0.4), 0.5)
    seen = seen + np.random.default_rng(1).normal(0, NOISE, SHAPE)
    found, plain = polarization(seen, TILE, D, NOISE), demosaiced(seen, TILE, D)
    assert turned(found.psi, 0.4) < 10 < turned(angle(*plain), 0.4)


def test_noise_alone_is_seldom_taken_for_polarization():
    seen = 0.5 + np.random.default_rng(2).normal(0, NOISE, SHAPE)
    found = polarization(seen, TILE, D, NOISE)
    assert (found.confidence > 0).mean() < 0.01 and not specular_tags(found, 0.05).any()


@pytest.mark.parametrize("missing", [(0.0,), (45.0, -45.0), (22.5, -22.5, 67.5, -67.5)])
def test_missing_types_leave_an_answer_or_no_confidence(missing):
    psi = np.full(SHAPE, 0.7)
    used = ~np.isin(np.array([t.gamma_deg for t in TILE.types])[TILE.type_map(*SHAPE)], missing)
    found = polarization(sums(np.full(SHAPE, 0.6), psi, 0.4), TILE, D, NOISE, used)
    sure = found.confidence > 0
    assert np.isfinite(found.psi).all() and sure[used].mean() > 0.9 and not sure[~used].any()
    assert turned(found.psi[sure], 0.7) < 1e-3


@pytest.mark.parametrize("kept", [(0.0,), (0.0, 90.0), (45.0, -45.0)])
def test_orientations_that_cannot_tell_have_no_confidence(kept):
    used = np.isin(np.array([t.gamma_deg for t in TILE.types])[TILE.type_map(*SHAPE)], kept)
    found = polarization(sums(np.full(SHAPE, 0.6), np.full(SHAPE, 0.7), 0.4), TILE, D, NOISE, used)
    assert np.isfinite([found.light, found.s1, found.s2]).all() and not found.confidence.any()


@pytest.mark.parametrize("level", [0.0, 1e-320, 1e-12])
def test_darkness_has_no_polarization(level):
    found = polarization(np.full(SHAPE, level), TILE, D, NOISE)
    assert np.isfinite([found.light, found.s1, found.s2, found.confidence]).all() and not found.confidence.any()


def test_full_pixels_are_never_tagged():
    full = np.zeros(SHAPE, bool)
    full[10:25, 12:30] = True
    seen = np.where(full, 1.25, sums(np.full(SHAPE, 0.6), np.full(SHAPE, 0.7), 0.5))
    found = polarization(seen, TILE, D, NOISE, ~full)
    tags = specular_tags(found, 0.1)
    assert not tags[full].any() and tags[~full].mean() > 0.95 and np.isfinite(found.psi).all()


def test_one_pixel_and_none_used_have_no_confidence():
    assert not polarization(np.ones((1, 1)), TILE, D, NOISE).confidence.any()
    assert not polarization(np.ones(SHAPE), TILE, D, NOISE, np.zeros(SHAPE, bool)).confidence.any()


@pytest.mark.parametrize("given, message", [((0.0, 0.1), "diattenuation"), ((D, 0.0), "noise = 0: must be greater")])
def test_bad_arguments(given, message):
    with pytest.raises(ParameterError, match=message):
        polarization(np.ones(SHAPE), TILE, *given)
