"""Spectra against published values, closed forms and another quadrature."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.parameters import (
    LIGHTS,
    STANDARD,
    SURFACES,
    LightParameters,
    ParameterError,
    RoomParameters,
    SpectralParameters,
    Spectrum,
    light,
    sensor_of,
    surface,
)
from talbot.models.parameters.electrical import PHOTON
from talbot.models.parameters.silicon import absorbed
from talbot.models.parameters.spectra import eye
from talbot.models.parameters.spectral import OXIDE

# lm/W over 380..780 nm, by colour-science 0.4.7 from CIE's tables
PUBLISHED = {"d65": 205.16, "a": 156.19, "led": 316.95, "e": 182.46, "laser:555": 683.0, "laser:505": 683 * 0.4073}


@pytest.mark.parametrize("name", PUBLISHED)
def test_luminous_efficacy_is_the_published_one(name):
    assert light(name).efficacy == pytest.approx(PUBLISHED[name], rel=1e-3)


@pytest.mark.parametrize("nm, power", [(380, 9.7951), (560, 100.0), (780, 241.675)])
def test_illuminant_a_is_the_table_of_cie(nm, power):
    a = light("a")
    assert 100 * a.at(1e-9 * nm) / a.at(560e-9) == pytest.approx(power, rel=1e-4)


@settings(max_examples=25, deadline=None)
@given(centre=st.floats(400, 760), width=st.floats(5, 300), name=st.sampled_from(["d65", "led", "e"]))
def test_sums_are_the_integrals(centre, width, name):
    """A Gaussian filter over a light, by Gauss's rule between the points of its table."""
    spectral, lamp = SpectralParameters(filter_wavelength=1e-9 * centre, filter_width=1e-9 * width), light(name)
    nodes, shares = lamp.quadrature()
    ends = 1e-9 * np.arange(380, 781, 5)
    at, weight = np.polynomial.legendre.leggauss(9)
    points = ends[:-1, None] + 2.5e-9 * (1 + at)
    exact = 2.5e-9 * float((lamp.at(points) * spectral.transmission(points) @ weight).sum())
    whole = np.trapezoid(lamp.at(ends), ends)
    assert shares @ spectral.transmission(nodes) == pytest.approx(exact / whole, rel=2e-3, abs=1e-6)


def test_a_narrow_filter_is_a_laser():
    """Depth of the fringes and electrons tend to those of the filter's wavelength."""
    narrow = SpectralParameters(filter_wavelength=600e-9, filter_width=5e-9)
    for beta in (12.0, 24.0):
        laser = narrow.modulation(beta, 600e-9)
        assert narrow.depth(beta, light("e")) == pytest.approx(float(laser), abs=2e-3)


@settings(max_examples=50, deadline=None)
@given(beta=st.floats(0, 30), width=st.floats(10, 200), distance=st.floats(1e-6, 1e-5))
def test_fringes_of_a_gaussian_band_have_a_closed_form(beta, width, distance):
    """The mean of a cosine over a Gaussian: the cosine at its middle times exp(-(sigma frequency)**2 / 2)."""
    spectral = SpectralParameters(grating_distance=distance)
    nodes = np.linspace(400e-9, 700e-9, 6001)
    sigma = 1e-9 * width / 2.3548
    weights = np.exp(-0.5 * ((nodes - 550e-9) / sigma) ** 2)
    frequency = OXIDE * beta**2 / (4 * np.pi * distance)  # rad per m of wavelength
    mean = weights @ spectral.modulation(beta, nodes) / weights.sum()
    if width < 100:
        assert mean == pytest.approx(np.exp(-((sigma * frequency) ** 2) / 2), abs=2e-3)
    assert spectral.modulation(beta, 550e-9) == 1 and abs(mean) <= 1 + 1e-12


@settings(max_examples=20, deadline=None)
@given(name=st.sampled_from([*LIGHTS, "laser:450", "laser:850"]), reflectance=st.sampled_from(SURFACES))
def test_units_chain_by_wavelength(name, reflectance):
    """From radiance to electrons; the sums are those of the light as a whole."""
    room = RoomParameters(spectrum=light(name), reflectance=reflectance, irradiance=3.0)
    parts, spectral = LightParameters(), STANDARD.spectral
    chain, white = room.by_wavelength(10e-6, 1 / 2.4, parts, spectral), room.white(10e-6, 1 / 2.4)
    sine = np.sin(np.arctan(1 / 2.4))
    np.testing.assert_allclose(chain.irradiance, np.pi * chain.radiance * parts.transmission * sine**2)
    photons = chain.irradiance * (10e-6) ** 2 * parts.fill * chain.wavelengths / PHOTON
    efficiency = 0.5 * absorbed(chain.wavelengths, 5e-6) / absorbed(550e-9, 5e-6)
    np.testing.assert_allclose(chain.electrons, photons * parts.gratings * np.minimum(efficiency, 1))
    assert white.electrons == pytest.approx(chain.electrons.sum()) and white.irradiance <= 3.0
    assert white.room_lux == pytest.approx(683 * np.pi * (chain.radiance @ eye().at(chain.wavelengths)))


def test_surfaces_add_up_to_gray():
    nodes = np.linspace(380e-9, 1000e-9, 99)
    np.testing.assert_allclose(sum(surface(name).at(nodes) for name in ("red", "green", "blue")), 1)
    parts = [RoomParameters(spectrum=light("d65"), reflectance=name).white(10e-6, 0.4).electrons for name in SURFACES]
    assert sum(parts[1:]) == pytest.approx(parts[0])


def test_electrons_of_equal_energy_are_near_those_of_the_default_room():
    """The room without a spectrum takes all photons of 400 to 700 nm as of 550 nm."""
    plain, equal = (RoomParameters(spectrum=lamp).white(10e-6, 1 / 2.4) for lamp in (None, light("e")))
    assert plain.room_lux == pytest.approx(equal.room_lux) and plain.sensor_lux == pytest.approx(equal.sensor_lux)
    assert equal.electrons == pytest.approx(1.158 * plain.electrons, rel=1e-3)


@pytest.mark.parametrize(
    "bad",
    [
        lambda: light("d50"),
        lambda: light("laser:"),
        lambda: light("laser:1001"),
        lambda: surface("pink"),
        lambda: Spectrum("x", (1.0, 1.0), (1.0, 1.0)),
        lambda: Spectrum("x", (1.0,), (0.0,)),
        lambda: Spectrum("x", (1.0,), (1.0, 2.0)),
        lambda: SpectralParameters(filter_width=1e-9),
        lambda: RoomParameters(irradiance=1.0),
        lambda: RoomParameters(reflectance="red"),
        lambda: RoomParameters(spectrum=light("laser:850")),
        lambda: SpectralParameters(filter_width=5e-9).electrons(light("laser:850")),
    ],
)
def test_what_is_out_of_range_is_refused(bad):
    with pytest.raises(ParameterError, match=" = .*: "):
        bad()


def test_a_sensor_file_has_the_filter():
    sensor = sensor_of({"spectral": {"filter_wavelength": 850e-9, "filter_width": 30e-9}})
    assert sensor.spectral.transmission([850e-9, 865e-9]) == pytest.approx([0.9, 0.45])
