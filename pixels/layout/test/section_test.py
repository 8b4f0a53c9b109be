"""Cuts through drawn pixels, and the responses that are kept of them."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.parameters import ParameterError, PixelType, TileParameters, drawn_curves
from talbot.pixels.designs import gratings
from talbot.pixels.layout import section
from talbot.pixels.layout.pixel import BAR, PixelLayout, openings
from talbot.pixels.layout.section import sections
from talbot.pixels.layout.write import array_layout

pytestmark = pytest.mark.needs("layout")

TYPES = TileParameters().types


def made(beta, gamma, diodes=(0, 2)):
    return PixelLayout(gratings("sky130").geometries[beta], PixelType(beta, gamma, 0.0), diodes)


def covered(cut, metal):
    return sum(high - low for low, high in cut.metals[metal])


@pytest.mark.parametrize("kind", sorted({(k.beta, k.gamma_deg) for k in TYPES}))
def test_a_cut_meets_what_is_drawn(kind):
    pixel = made(*kind)
    cuts = [*sections(pixel)]
    wells = [sum(high - low for low, high in well) * weight for cut, weight in cuts for well in cut.wells]
    period = cuts[0][0].period_um
    width, _ = pixel.well_um
    tall = [box[3] - box[1] for _, box in openings(pixel)][1]
    if kind[1] in (0.0, 90.0):
        # shares of a pixel: of what is above a well's rows, or next to it in its columns
        assert sum(wells) / period < pixel.fill_factor
    else:
        assert sum(wells) / period == pytest.approx(pixel.fill_factor, rel=0.06)
    assert 0 < tall < 7 and width == pytest.approx(3.7)
    for cut, _ in cuts:
        for spans in (*cut.metals.values(), *cut.wells):
            edges = [edge for span in spans for edge in span]
            assert edges == sorted(edges) and all(0 <= edge <= cut.period_um + 1e-3 for edge in edges)


def test_lines_and_bars_of_an_upright_type():
    ((cut, weight),) = sections(made(24.0, 0.0))
    upper = cut.metals["met4"]
    assert upper[0][1] >= BAR and upper[-1][0] <= 10 - BAR and upper[0][0] == 0 and upper[-1][1] == 10
    np.testing.assert_allclose([high - low for low, high in upper[1:-1]], 0.3)
    np.testing.assert_allclose(np.diff([low for low, _ in upper[1:-1]]), 0.6)  # one grating over both halves
    assert cut.wells == (((0.65, 4.35),), ((5.65, 9.35),)) and 0.6 < weight < 0.7
    lower = cut.metals["met1"]
    phases = [(low + high) / 2 / 0.6 % 1 for low, high in lower if high - low < 0.4]
    west, east = phases[: len(phases) // 2], phases[len(phases) // 2 :]
    assert np.ptp(west) < 0.02 > np.ptp(east)
    assert (east[0] - west[0]) % 1 == pytest.approx(0.5, abs=0.02)


def test_the_kept_response_is_that_of_the_drawn_masks():
    """The least costly type, solved again; all others by `make pixel-layout`."""
    (pixel,) = (p for p in array_layout("sky130", 4, 6).pixels if p.kind == PixelType(12, 0, 0))
    found, (sines, *shares) = section.drawn_curves(pixel, gratings("sky130").wavelength_um), drawn_curves()[12, 0, 0]
    np.testing.assert_allclose(sines, found.sines, atol=1e-4)
    np.testing.assert_allclose(shares, found.shares, atol=1e-4)


def test_every_type_has_a_response():
    kept = drawn_curves()
    assert set(kept) == {(k.beta, abs(k.gamma_deg), k.alpha) for k in TYPES}
    for sines, *shares in kept.values():
        assert (np.diff(sines) > 0).all() and np.min(shares) > 0 and np.sum(shares, 0).max() < 1


def test_an_angle_without_a_cut():
    with pytest.raises(ParameterError, match="gamma_deg = 30: must be one of 0, 22.5, 45, 67.5, 90, of either sign"):
        next(sections(replace(made(12.0, 0.0), kind=PixelType(12, 30, 0))))
