"""Responses by type: a modulation depth for each, and functions instead of Eq. 3.1."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.parameters import (
    ArrayParameters,
    OpticsParameters,
    ParameterError,
    PixelType,
    SensorParameters,
    TileParameters,
)
from talbot.models.pixel import response, view_weights
from talbot.models.pixel.weights import density, field_weights

OPTICS = OpticsParameters()


def thesis(theta_x, theta_y):
    """Eq. 3.1 of a type with beta 15, gamma 30 degrees, alpha 0.3, as a user would write it."""
    return [
        response(a, 15, np.deg2rad(30), theta_x, theta_y, OPTICS.m, OPTICS.aperture_sigma) for a in (0.3, 0.3 + np.pi)
    ]


def test_a_function_is_the_same_as_its_parameters():
    types = (PixelType(15, 30, 0.3), PixelType(15, 0, 0, response=thesis))
    field = field_weights(
        SensorParameters(
            tile=TileParameters.of_rows([types]),
            array=ArrayParameters(12, 18),
            optics=replace(OPTICS, camera=replace(OPTICS.camera, exit_pupil=0.05)),
        ),
        5,
    )
    np.testing.assert_array_equal(field.series[0], field.series[1])


def test_modulation_depth_of_a_type():
    tile = TileParameters.of_rows([[PixelType(12, 0, 0, m=0.0), PixelType(12, 0, 0)]])
    flat, full = view_weights(tile, OPTICS)
    np.testing.assert_allclose(flat[0], flat[1])
    assert np.abs(full[0] - full[1]).max() > 0.01
    np.testing.assert_array_equal(full, view_weights(tile, replace(OPTICS, m=0.7))[1])


@pytest.mark.parametrize(
    "own, said",
    [
        (lambda x, y: np.ones(x.shape), r"must be \(2, 1\), both diodes"),
        (lambda x, y: [np.ones(x.shape), np.full(x.shape, -0.5)], "-0.5..1: every value must be finite and 0 or more"),
        (lambda x, y: np.full((2, *x.shape), np.nan), "must be finite"),
    ],
)
def test_a_function_that_is_no_response_is_refused(own, said):
    with pytest.raises(ParameterError, match=f"response = .*{said}"):
        density([PixelType(1, 0, 0, response=own)], OPTICS, np.zeros(1), np.zeros(1))


def test_tiles_of_rows():
    a, b = PixelType(1, 0, 0), PixelType(2, 0, 0)
    assert TileParameters.of_rows([[a, b], [b, a]]) == TileParameters(2, 2, (a, b, b, a), (0, 1, 2, 3))
    for rows in ([], [[]], [[a], [a, b]], [[a]] * 5):
        with pytest.raises(ParameterError, match="tile rows|tile cols"):
            TileParameters.of_rows(rows)
    with pytest.raises(ParameterError, match="response = 3: must be a function"):
        PixelType(1, 0, 0, response=3)
