"""The solver against closed forms, against conservation laws and where it could break."""

import numpy as np
import pytest

from talbot.models.parameters import ParameterError
from talbot.pixels.optics.geometry import PixelGeometry, Slab
from talbot.pixels.optics.solve import Illumination, SolverError, solve
from talbot.platforms.materials import refractive_index

GLASS = 1.46**2
ALUMINIUM = complex(refractive_index("aluminium", 0.53)) ** 2
ANGLES = np.deg2rad([-40.0, -7.0, 0.0, 3.0, 20.0])


def light(angles=ANGLES, across=0.0, wavelength=0.53, **ends):
    angles = np.asarray(angles, float)
    return Illumination(wavelength, angles, np.full(angles.shape, across), **ends)


def abeles(films, bottom, wavelength, cosine_of_sine, p):
    """Share that enters the half space below, by characteristic matrices [Abeles]: no code of the solver's."""
    sine = cosine_of_sine
    q = lambda e: np.sqrt(e - sine**2 + 0j)  # noqa: E731
    eta = lambda e: e / q(e) if p else q(e)  # noqa: E731
    m = np.eye(2, dtype=complex)
    for e, h in films:
        d = 2 * np.pi / wavelength * q(e) * h
        m = m @ np.array([[np.cos(d), -1j * np.sin(d) / eta(e)], [-1j * np.sin(d) * eta(e), np.cos(d)]])
    b, c = m @ np.array([1, eta(bottom)])
    return 4 * eta(1.0).real * np.real(eta(bottom)) / abs(eta(1.0) * b + c) ** 2


def test_a_bare_stack_is_fresnels():
    """SKY130's films on silicon, through the layers of a pixel with lines of no width."""
    stack = PixelGeometry()
    upper, lower = stack.layers(0.53)
    bare = [Slab(s.medium, s.thickness_um, s.line, 0.0) for s in upper + lower]
    silicon = complex(refractive_index("silicon", 0.53)) ** 2
    got = solve(bare[: len(upper)], bare[len(upper) :], 0.7, light(bottom=silicon), orders=5).transmitted[:, 0]
    films = [(s.medium, s.thickness_um) for s in bare]
    for p in (False, True):
        expected = [abeles(films, silicon, 0.53, np.sin(a), p) for a in ANGLES]
        np.testing.assert_allclose(got[int(p)], expected, atol=1e-12)


@pytest.mark.parametrize("across", [0.0, 0.3])
@pytest.mark.parametrize("line", [2.0**2, -40.0])  # a dielectric; metal without loss
def test_energy_is_conserved_without_loss(across, line):
    upper = [Slab(GLASS, 0.3), Slab(GLASS, 0.4, line, 0.4), Slab(GLASS, 1.1)]
    lower = [Slab(GLASS, 0.2, line, 0.5), Slab(GLASS, 0.1)]
    got = solve(upper, lower, 0.7, light(across=across, bottom=3.5**2), (0.0, 0.25), orders=21)
    np.testing.assert_allclose(got.reflected + got.transmitted, 1, atol=1e-6)


def test_reciprocity():
    """Order 0 passes alike from above and from below: shares of a stack of one travelling order, turned over."""
    layers = [Slab(GLASS, 0.2, ALUMINIUM, 0.3), Slab(GLASS, 0.5), Slab(GLASS, 0.3, 4 + 0.5j, 0.6)]
    down = solve(layers, [], 0.25, light(), orders=31)
    up = solve(layers[::-1], [], 0.25, light(-ANGLES), orders=31)
    np.testing.assert_allclose(down.transmitted, up.transmitted, atol=1e-9)
    assert np.abs(down.reflected - up.reflected).max() > 0.01


def test_oblique_incidence_goes_over_into_the_plane_one():
    upper, lower = PixelGeometry().layers(0.53)
    ends = {"bottom": 17 + 0.3j}
    plane, oblique = (solve(upper, lower, 0.7, light(across=a, **ends), (0.25,), 21) for a in (0.0, 1e-7))
    np.testing.assert_allclose(oblique.transmitted, plane.transmitted, atol=1e-6)


def test_oblique_lines_of_full_width_are_films():
    """Rotated incidence on what does not depend on x at all: as Fresnel at the polar angle, both fields' mean."""
    layers = [Slab(GLASS, 0.4, 2.25 + 0.2j, 1.0), Slab(GLASS, 0.3)]
    got = solve(layers, [], 0.7, light([0.3], 0.4, bottom=15.0), orders=5).transmitted.mean(0)[0, 0]
    sine = np.sin(np.arctan(np.hypot(np.tan(0.3), np.tan(0.4))))
    films = [(2.25 + 0.2j, 0.4), (GLASS, 0.3)]
    assert got == pytest.approx(np.mean([abeles(films, 15.0, 0.53, sine, p) for p in (False, True)]), abs=1e-9)


def test_mirrored_shift_is_mirrored_angle():
    upper, lower = PixelGeometry().layers(0.53)
    got = solve(upper, lower, 0.7, light([-0.2, 0.2], bottom=17), (0.2, -0.2), 21).transmitted
    np.testing.assert_allclose(got[:, 0, 0], got[:, 1, 1], atol=1e-9)


def test_fingers_share_all_that_enters():
    upper, lower = PixelGeometry(kind="interleaved", analyzer=None, period_um=0.85).layers(0.53)
    got = solve(upper, lower, 0.85, light(bottom=17), (0.0, 0.5), 21, fingers=True)
    assert got.fingers is not None
    np.testing.assert_allclose(got.fingers.sum(2), got.transmitted, atol=1e-12)
    np.testing.assert_allclose(got.fingers[:, 0], got.fingers[:, 1, ::-1], atol=1e-9)


@pytest.mark.parametrize(
    "layers, period, angle, wavelength",
    [
        ([Slab(GLASS, 1e3, ALUMINIUM, 0.5)], 0.7, 0.0, 0.53),  # a millimetre of metal lines
        ([Slab(GLASS, 1e3, ALUMINIUM, 1.0)], 0.7, 0.1, 0.53),  # and of metal
        ([Slab(GLASS, 0.3, ALUMINIUM, 0.5)], 0.7, np.deg2rad(89.9), 0.53),
        ([Slab(GLASS, 0.3, ALUMINIUM, 0.5)], 0.53, 0.0, 0.53),  # Rayleigh: orders +-1 at grazing in air
        ([Slab(GLASS, 0.3, ALUMINIUM, 0.5)], 0.53 / 1.46, 0.0, 0.53),  # and in the glass
        ([Slab(GLASS, 0.3, ALUMINIUM, 0.0)], 0.7, 0.0, 0.53),
        ([Slab(GLASS, 0.0, ALUMINIUM, 0.5)], 0.7, 0.2, 0.53),
        ([Slab(GLASS, 0.3, ALUMINIUM, 0.5), Slab(GLASS, 0.3, ALUMINIUM, 0.4)], 0.7, 0.2, 0.53),  # no gap
        ([Slab(GLASS, 0.3, -50.0, 0.5)], 0.7, 0.2, 0.53),  # metal without loss
        ([Slab(GLASS, 0.3, ALUMINIUM, 0.5)], 0.7, 0.2, 500.0),  # far longer than all else
        ([Slab(GLASS, 0.3, ALUMINIUM, 0.5)], 0.7, 0.2, 0.01),  # X rays: more orders than are kept
    ],
)
@pytest.mark.parametrize("across", [0.0, 0.1])
def test_a_bounded_answer(layers, period, angle, wavelength, across):
    got = solve(layers, [], period, light([angle], across, wavelength, bottom=GLASS), orders=21)
    total = got.reflected + got.transmitted
    assert np.isfinite(total).all() and got.transmitted.min() >= -1e-6 and total.max() <= 1 + 1e-6


@pytest.mark.parametrize(
    "change, said",
    [
        ({"orders": 20}, "orders = 20: must be odd"),
        ({"orders": 0}, "orders = 0: must be an integer in 1..401"),
        ({"upper": [Slab(1.0, -0.1)]}, r"thickness_um = -0.1: must be a number in \[0, 1000000.0\]"),
        ({"period_um": -1.0}, "period_um = -1.0: must be a number"),
    ],
)
def test_what_is_refused(change, said):
    with pytest.raises(ParameterError, match=said):
        solve(**({"upper": [Slab(1.0, 1.0)], "lower": [], "period_um": 0.7, "light": light()} | change))
    with pytest.raises(ParameterError, match=r"along = 1.57\d*: must be an angle in rad below pi/2"):
        light([np.pi / 2])


def test_two_lines_a_period_are_one_of_half_the_period():
    once = [Slab(GLASS, 0.3, ALUMINIUM, 0.4)], 0.35
    twice = [Slab(GLASS, 0.3, ALUMINIUM, 0.4, lines=2)], 0.7
    for angle in (0.0, 0.3):
        (a, period), (b, double) = once, twice
        lit = light([angle], 0.1, bottom=GLASS)
        single = solve(a, [], period, lit, orders=11).transmitted
        np.testing.assert_allclose(solve(b, [], double, lit, orders=21).transmitted, single, atol=1e-9)


def test_what_has_no_solution_is_a_named_error():
    with pytest.raises(SolverError, match="modes = none|reflected \\+ transmitted = nan"):
        solve([Slab(GLASS, 0.3, complex("nan"), 0.5)], [], 0.7, light(), orders=5)
    with pytest.raises(SolverError, match="reflected \\+ transmitted = .*: must be in 0..1"):
        solve([Slab(GLASS, 0.3, 4 - 3j, 0.5)], [], 0.7, light(), orders=5)  # lines that make light
