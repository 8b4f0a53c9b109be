"""A table instead of the formula."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.parameters import OpticsParameters, ParameterError, PixelType, TileParameters
from talbot.models.pixel import TableResponse, optical_gains, response, view_weights

ALONG, ACROSS = np.deg2rad(np.arange(-33, 33.1, 1.5)), np.deg2rad(np.arange(0, 33.1, 5.5))
OPTICS = OpticsParameters()


def table(beta, alpha, gamma):
    """Eq. 3.1 of lines along y, as a table."""
    grid = np.meshgrid(ALONG, ACROSS, indexing="ij")
    values = [response(a, beta, 0.0, *grid, OPTICS.m, OPTICS.aperture_sigma) for a in (alpha, alpha + np.pi)]
    return TableResponse(ALONG, ACROSS, np.array(values), gamma, "PIXEL=test")


@pytest.mark.parametrize("gamma", [0, 90, -90])
def test_a_table_of_the_formula_is_the_formula(gamma):
    """Along the axes, where the angles of both are the same; weights and trims follow."""
    plain = PixelType(24, gamma, 0.4)
    tabled = replace(plain, response=table(24, 0.4, plain.gamma))
    tiles = [TileParameters.of_rows([[PixelType(12, 0, 0), kind]]) for kind in (plain, tabled)]
    weights = [view_weights(tile, OPTICS) for tile in tiles]
    np.testing.assert_allclose(weights[1], weights[0], atol=3e-4)
    np.testing.assert_allclose(*[optical_gains(tile, OPTICS) for tile in tiles], rtol=3e-3)


def test_lines_are_turned_by_their_direction_in_space():
    """A ray and lines turned about the axis together see the same."""
    ray, turn = np.array([0.3, -0.1]), 0.7
    turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ ray
    first = table(18, 0.2, 0.1)(*np.arctan(ray[:, None]))
    second = table(18, 0.2, 0.1 + turn)(*np.arctan(turned[:, None]))
    np.testing.assert_allclose(first, second, atol=1e-9)


def test_it_answers_for_every_angle():
    angles = np.linspace(-np.pi / 2, np.pi / 2, 41)
    found = table(24, 0, 0.5)(*(a.ravel() for a in np.meshgrid(angles, angles)))
    assert found.shape == (2, 41**2) and np.isfinite(found).all() and found.min() >= 0


def test_what_is_no_table():
    good = table(12, 0, 0)
    for change in ({"values": good.values[:1]}, {"values": -good.values}, {"along": good.along[::-1]}):
        with pytest.raises(ParameterError, match="must be"):
            replace(good, **change)
