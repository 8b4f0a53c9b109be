"""Gratings that are kept, and sensors that respond as they do."""

from dataclasses import replace

import pytest

from talbot.models.parameters import STANDARD, ArrayParameters, ParameterError, PixelType, TileParameters
from talbot.pixels.designs import DESIGNS
from talbot.pixels.optics.design import REACHED, measure
from talbot.pixels.tabled import tabled


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
