"""Gratings that are kept, and sensors that respond as they do."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.parameters import STANDARD, ArrayParameters, ParameterError, PixelType, TileParameters, drawn_curves
from talbot.pixels.designs import DESIGNS
from talbot.pixels.optics.design import REACHED, measure
from talbot.pixels.optics.response import bare_share
from talbot.pixels.tabled import pixel_of, tabled, untabled
from talbot.platforms.optics import optical_stack


def drawn(*kinds):
    """Types with the responses of SKY130's drawn pixels."""
    tile = TileParameters.of_rows([list(kinds)])
    sensor = tabled(replace(STANDARD, tile=tile, array=ArrayParameters(4, 4)), "sky130")
    assert pixel_of(sensor) == "sky130" and untabled(sensor).tile == tile
    return [kind.response for kind in sensor.tile.types]


def test_a_drawn_type_responds_with_its_curve():
    (response,) = drawn(PixelType(24, 0, 0))
    sines, *shares = drawn_curves()[24, 0, 0]
    near = np.abs(sines) < 0.5
    plain = bare_share(optical_stack("sky130"), DESIGNS["sky130"].wavelength_um)
    found = response(np.arcsin(sines[near]), 0 * sines[near])
    np.testing.assert_allclose(found, np.array(shares)[:, near] / plain, atol=0.01)


def test_drawn_types_by_symmetry():
    """Half a period on the diodes are exchanged; of the mirrored direction the response is mirrored."""
    angles = np.deg2rad(np.linspace(-15, 15, 11)), np.deg2rad(np.linspace(-4, 9, 11))
    zero, half, left, right = drawn(
        PixelType(12, 0, 0), PixelType(12, 0, np.pi), PixelType(12, 45, 0), PixelType(12, -45, 0)
    )
    np.testing.assert_allclose(half(*angles), zero(*angles)[::-1])
    np.testing.assert_allclose(right(angles[0], -angles[1]), left(*angles))


def test_a_drawn_type_at_another_angle_is_refused():
    with pytest.raises(
        ParameterError, match="gamma_deg = 30: must be one of 0, 45, 90, of either sign, at which beta 12"
    ):
        drawn(PixelType(12, 30, 0))


@pytest.mark.parametrize("pdk", DESIGNS)
def test_the_gratings_kept_have_the_betas_they_are_for(pdk):
    chosen = DESIGNS[pdk]
    assert set(chosen.geometries) == {kind.beta for kind in TileParameters().types}
    for beta, geometry in chosen.geometries.items():
        found = measure(geometry, chosen.wavelength_um)
        assert found.off(beta) < REACHED and found.fit.m > 0.3 and abs(found.fit.alpha) < 0.1


def test_a_sensor_of_another_beta_is_refused():
    tile = TileParameters.of_rows([[PixelType(15, 0, 0)]])
    odd = replace(STANDARD, tile=tile, array=ArrayParameters(4, 4))
    with pytest.raises(ParameterError, match="beta = 15: must be one of 12, 18, 24, which pixel = 'sky130' has"):
        tabled(odd, "sky130")
    assert tabled(odd, "ideal") is odd
