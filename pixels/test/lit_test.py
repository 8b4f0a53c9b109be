"""Pixels in light with a spectrum, against sums over lasers and over the solver's wavelengths."""

from argparse import ArgumentParser
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.parameters import STANDARD, ParameterError, SpectralParameters, Spectrum, light
from talbot.models.pixel.weights import density
from talbot.pixels import lit
from talbot.pixels.designs import gratings
from talbot.pixels.lit import in_light, shares_on_grid
from talbot.pixels.optics.response import bare_share, respond
from talbot.pixels.response import command
from talbot.pixels.tabled import pixel_of, tabled

NU = np.linspace(-0.4, 0.4, 41)


def responses(sensor):
    return density(sensor.tile.types, sensor.optics, NU, 0.3 * NU)


@settings(max_examples=4, deadline=None)
@given(first=st.integers(400, 750), tilt=st.floats(0.1, 10), width=st.sampled_from([0.0, 120e-9]))
def test_the_formula_in_a_light_is_the_sum_over_lasers(first, tilt, width):
    """A light of 4 nm: its five wavelengths, each as a laser of its share of the electrons."""
    sensor = replace(STANDARD, spectral=SpectralParameters(filter_width=width))
    lamp = Spectrum("band", (1e-9 * first, 1e-9 * (first + 4)), (1.0, tilt))
    nodes, weights = sensor.spectral.electrons(lamp)
    lasers = [in_light(sensor, Spectrum("line", (w,), (1.0,))) for w in nodes.tolist()]
    total = sum(u * responses(one) for u, one in zip(weights, lasers, strict=True))
    np.testing.assert_allclose(responses(in_light(sensor, lamp)), total, atol=1e-12)


def test_inverted_fringes_exchange_the_diodes():
    far = light("laser:700")
    one = in_light(STANDARD, far)
    depths = {beta: STANDARD.spectral.depth(beta, far) for beta in (12.0, 18.0, 24.0)}
    assert depths[24.0] < 0 < depths[12.0]
    for kind, lit_kind in zip(STANDARD.tile.types, one.tile.types, strict=True):
        turned = abs(lit_kind.alpha - kind.alpha)
        assert lit_kind.beta == kind.beta and turned == pytest.approx(np.pi * (depths[kind.beta] < 0))


def test_at_their_own_wavelength_pixels_are_as_without_a_light():
    np.testing.assert_allclose(responses(in_light(STANDARD, light("laser:550"))), responses(STANDARD), rtol=1e-12)


def test_weights_on_a_grid_keep_the_sum_of_what_is_linear_on_it():
    grid = np.array([0.4, 0.45, 0.5, 0.7])
    at = np.linspace(0.4, 0.7, 101)
    weights, values = np.random.default_rng(1).random(101), np.array([1.0, -2.0, 3.0, 0.5])
    assert shares_on_grid(grid, 1e-6 * at, weights) @ values == pytest.approx(weights @ np.interp(at, grid, values))


def test_gratings_in_a_light_are_the_mean_of_their_wavelengths(monkeypatch, tmp_path):
    """Across the lines, of two wavelengths, relative to a plain diode in the same light."""
    monkeypatch.setattr(lit, "STORE", tmp_path)
    monkeypatch.setattr(lit, "GRID_UM", (0.55, 0.6))
    pixel = "sky130-endless"
    geometry = gratings(pixel).geometries[24.0]
    lamp = replace(light("e"), wavelengths=(550e-9, 600e-9), values=(1.0, 2.0))
    spectral = SpectralParameters(collection_depth=1e-3, quantum_efficiency=1.0)
    table = lit._averaged(geometry, lamp, "gray", spectral)
    shares = respond(geometry, np.deg2rad([0.0, 7.0]), (0.55, 0.6), orders=21).unpolarized
    nodes, electrons = spectral.electrons(lamp)
    weights = shares_on_grid(np.array([0.55, 0.6]), nodes, electrons)
    bare = weights @ [bare_share(geometry.stack, w) for w in (0.55, 0.6)]
    np.testing.assert_allclose(table[:, [33, 40], 0], np.tensordot(weights, shares, 1) / bare, rtol=1e-6)


def test_a_light_is_refused_where_no_wavelength_is_known():
    drawn = tabled(STANDARD, "sky130")
    with pytest.raises(ParameterError, match="light = 'd65': must be left out with pixel = sky130, .* sky130-endless"):
        in_light(drawn, light("d65"))
    own = replace(STANDARD.tile.types[0], response=lambda x, y: np.ones((2, x.size)))
    types = (own, *STANDARD.tile.types[1:])
    with pytest.raises(ParameterError, match="light = 'd65': must be left out with responses of a file or a function"):
        in_light(replace(STANDARD, tile=replace(STANDARD.tile, types=types)), light("d65"))
    assert pixel_of(drawn) == "sky130"


@pytest.mark.parametrize("words", [["--light=d65"], ["--light=d65", "--diffraction=met4", "--wavelength-um=0.5"]])
def test_a_search_and_a_wavelength_have_no_light(words):
    parser = ArgumentParser()
    command.add_arguments(parser)
    with pytest.raises(ParameterError, match="must be with a geometry|must be left out with light"):
        command.run(parser.parse_args(words))
