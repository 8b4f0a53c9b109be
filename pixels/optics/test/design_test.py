"""Geometries, responses and fits."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.parameters import ParameterError
from talbot.pixels.optics.closed_form import angular_frequency, talbot_depth
from talbot.pixels.optics.design import Design, candidates, front, measure, neighbours, phased
from talbot.pixels.optics.fit import fit
from talbot.pixels.optics.geometry import QUADRATURE, PixelGeometry, Slab
from talbot.pixels.optics.response import Response, respond
from talbot.pixels.optics.solve import Illumination, solve
from talbot.pixels.optics.test.slope import phase_slope
from talbot.platforms.materials import refractive_index
from talbot.platforms.optics import optical_stack
from talbot.platforms.processes import PROCESSES

ANGLES = np.deg2rad(np.arange(-20, 20.1, 2.0))


def formula(alpha, beta, sigma, m, turn, noise=0.0):
    """A response that is Eq. 3.1 itself, half of the light for both diodes on the axis."""
    phase = beta * ANGLES + alpha + turn * 2 * np.pi * np.array(QUADRATURE)[:, None]
    curves = np.exp(-0.5 * (ANGLES / sigma) ** 2) * (1 + m * np.cos(phase)) / 4
    curves = curves + noise * (-1.0) ** np.arange(curves.size).reshape(curves.shape)
    shares = np.stack([1.2 * curves, 0.8 * curves])[None]
    return Response(PixelGeometry(), ANGLES, 0 * ANGLES, np.array([0.53]), shares, 0 * shares)


@pytest.mark.parametrize("alpha, beta, sigma, m, turn", [(0.3, 12.0, 0.2, 0.6, 1), (-2.5, 24.0, 0.35, 0.3, -1)])
def test_the_formula_is_found_again(alpha, beta, sigma, m, turn):
    found = fit(formula(alpha, beta, sigma, m, turn))
    assert (found.beta, found.m, found.sigma) == pytest.approx((beta, m, sigma), rel=1e-3)
    assert found.alpha == pytest.approx(alpha, abs=1e-3) and found.turn == turn
    assert found.residual_rms < 1e-4 and found.unexplained < 1e-6
    assert found.extinction_ratio == pytest.approx(1.5) and found.diattenuation == pytest.approx(0.2)
    assert phase_slope(formula(alpha, beta, sigma, m, turn)) == pytest.approx(beta, rel=1e-6)


def test_what_the_formula_leaves_is_measured():
    response = formula(0.0, 15.0, 5.0, 0.5, 1, noise=0.02)
    assert fit(response).residual_rms == pytest.approx(0.02 / response.unpolarized.mean(), rel=0.03)


def test_two_thin_gratings_have_the_beta_of_the_closed_form():
    """Lines far wider than the wavelength, half a Talbot depth apart, in one medium: angles are inside it."""
    wavelength, period, gap = 0.53, 5.0, talbot_depth(5.0, 0.53, 1.5) / 2
    lines = Slab(2.25, 0.05, 2.25 + 4j, 0.5)
    angles = np.deg2rad(np.linspace(-2, 2, 21))
    light = Illumination(wavelength, angles, 0 * angles, top=2.25, bottom=2.25)
    got = solve([lines, Slab(2.25, gap)], [lines], period, light, QUADRATURE, orders=31).transmitted.mean(0)
    signal = (got[0] - got[2]) + 1j * (got[1] - got[3])
    slope = abs(np.polyfit(angles, np.unwrap(np.angle(signal)), 1)[0])
    assert slope == pytest.approx(angular_frequency(gap, period, 1.0), rel=0.01)


def test_angles_and_shifts_by_symmetry_are_those_solved_one_by_one():
    geometry = PixelGeometry(shift=0.1)
    whole = respond(geometry, [-0.2, 0.0, 0.2], [0.5, 0.6], across=[0.0, 0.0, 0.1], orders=15)
    upper, lower = geometry.layers(0.6)
    silicon = complex(refractive_index("silicon", 0.6)) ** 2
    light = Illumination(0.6, np.array([-0.2, 0.0, 0.2]), np.array([0.0, 0.0, 0.1]), bottom=silicon)
    direct = solve(upper, lower, 0.7, light, np.add(0.1, QUADRATURE), 15)
    np.testing.assert_allclose(whole.shares[1], direct.transmitted / 2, atol=1e-9)


def test_response_and_fit_of_a_pixel_of_sky130():
    design = measure(PixelGeometry(), 0.53, orders=15)
    slope = phase_slope(respond(design.geometry, ANGLES, 0.53, orders=15))
    assert design.fit.beta == pytest.approx(slope, rel=0.05)
    assert 0.3 < design.fit.m < 0.6 and 0.1 < design.fit.quantum_efficiency < 0.25
    turned = phased(replace(design, fit=replace(design.fit, alpha=3.0)))
    assert turned.geometry.shift == 0.5 and turned.fit.alpha == pytest.approx(3.0 - np.pi)


@pytest.mark.parametrize("pdk", PROCESSES)
def test_candidates_keep_the_rules(pdk):
    stack = optical_stack(pdk)
    found = [*candidates(stack)]
    kinds = {"amplitude", "interleaved", *(["photogate"] if stack.gate else [])}
    assert {g.kind for g in found} == kinds and len(set(found)) == len(found) > 20
    for geometry in found[::7]:
        design = Design(geometry, 0.5, fit(formula(0.0, 12.0, 0.3, 0.5, 1)))
        for other in neighbours(design):
            assert other.period_um >= sum((stack.metal("", other.diffraction).width_um,) * 2)


def test_the_front_is_what_nothing_beats():
    base = fit(formula(0.0, 12.0, 0.3, 0.5, 1))
    rows = [(0.5, 0.1, 0.1), (0.4, 0.2, 0.1), (0.4, 0.1, 0.1), (0.1, 0.3, 0.1), (0.3, 0.15, 0.1), (0.1, 0.1, 0.2)]
    designs = [(Design(PixelGeometry(), 0.5, replace(base, m=m, quantum_efficiency=q)), wide) for m, q, wide in rows]
    assert front(designs) == [designs[k] for k in (0, 1, 3, 5)]
    assert front([]) == []


@pytest.mark.parametrize(
    "change, said",
    [
        ({"period_um": 0.5}, "period_um = 0.5: must be at least 0.6, met4's width and space in sky130"),
        ({"period_um": 6.0}, r"period_um = 6.0: must be a number in \[0.1, 5.0\]"),
        ({"diffraction": "met9"}, "diffraction = 'met9': must be one of met1"),
        ({"analyzer": "gold"}, "analyzer = 'gold': must be one of met1"),
        ({"analyzer": "met4"}, r"analyzer = 'met4': must be below diffraction = 'met4' \(gap -0.845 um\)"),
        ({"analyzer": None}, "analyzer = None: must be a name for kind = 'amplitude'"),
        ({"analyzer": "poly"}, "analyzer = 'poly': must be poly, the gates, for a photogate alone"),
        ({"kind": "photogate"}, "analyzer = 'met1': must be poly, the gates, for a photogate alone"),
        ({"fill": 0.9}, r"fill = 0.9: must be in \[0.429, 0.571\], lines of 0.3 and spaces of 0.3 um of met4"),
        ({"shift": 2.0}, r"shift = 2.0: must be a number in \[-1, 1\]"),
        ({"process": "tsmc"}, "pdk = 'tsmc': must be one of sky130"),
        ({"kind": "phase"}, "kind = 'phase': must be one of amplitude, interleaved, photogate"),
        ({"kind": "interleaved"}, "analyzer = 'met1': must be None for an interleaved pixel"),
        ({"kind": "interleaved", "analyzer": None}, "period_um = 0.7: must be at least 0.84, two diffusions' width"),
    ],
)
def test_a_bad_geometry(change, said):
    with pytest.raises(ParameterError, match=said):
        PixelGeometry(**change)
