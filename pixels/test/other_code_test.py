"""The solver against another coupled-wave code, meent (MIT): two gratings of lossy metal over silicon.

Silicon without loss: of an absorbing half space meent 0.13.2 says otherwise than the closed form in `solve_test`.
"""

from dataclasses import replace

import meent
import numpy as np
import pytest

from talbot.pixels.designs import gratings
from talbot.pixels.optics.fit import fit
from talbot.pixels.optics.geometry import QUADRATURE, PixelGeometry
from talbot.pixels.optics.response import respond
from talbot.pixels.optics.solve import Illumination, solve
from talbot.pixels.optics.test.slope import phase_slope
from talbot.platforms.materials import refractive_index

CELLS = 560  # of a period: the edges of the lines are between them
ORDERS = 21
WAVELENGTH, PERIOD, SHIFT = 0.53, 0.7, 0.25


def cell(slab, shift):
    """A layer's refractive indices along a period, with their sign of loss."""
    x = (np.arange(CELLS) + 0.5) / CELLS - shift
    inside = np.abs((x + 0.5) % 1 - 0.5) < slab.fill / 2
    return np.sqrt(np.where(inside, slab.medium if slab.line is None else slab.line, slab.medium) + 0j).conj()


def theirs(geometry, wavelength, degrees, field, shift):
    """Transmission by meent. field: 0 along the lines, 1 across them."""
    upper, lower = geometry.layers(wavelength)
    layers = [(s, 0.0) for s in upper] + [(s, shift) for s in lower]
    made = meent.call_mee(
        backend=0,
        pol=field,
        n_top=1,
        n_bot=float(refractive_index("silicon", wavelength).real),
        theta=float(np.deg2rad(degrees)),
        fto=[ORDERS // 2, 0],
        wavelength=wavelength,
        period=[geometry.period_um, 1],
        ucell=np.array([[cell(*layer)] for layer in layers]),
        thickness=[slab.thickness_um for slab, _ in layers],
    )
    return float(np.sum(made.conv_solve().de_ti).real)


def ours(geometry, wavelength, degrees, shift):
    """The same by this solver, of both fields."""
    angle, silicon = np.deg2rad([degrees]), float(refractive_index("silicon", wavelength).real)
    lit = Illumination(wavelength, angle, 0 * angle, bottom=silicon**2)
    return solve(*geometry.layers(wavelength), geometry.period_um, lit, (shift,), ORDERS).transmitted[:, 0, 0]


@pytest.mark.parametrize("metals", [("met4", "met1"), ("met3", "met2")])
@pytest.mark.parametrize("degrees", [0, 7, 14])
def test_transmission_is_that_of_another_code(metals, degrees):
    geometry = PixelGeometry(diffraction=metals[0], analyzer=metals[1], period_um=PERIOD, analyzer_fill=0.4)
    found = ours(geometry, WAVELENGTH, degrees, SHIFT)
    for field in (0, 1):
        assert found[field] == pytest.approx(theirs(geometry, WAVELENGTH, degrees, field, SHIFT), abs=2e-5)


@pytest.mark.slow  # 168 solutions of meent, 10 s alone
@pytest.mark.parametrize("beta", gratings("sky130").geometries)
def test_beta_is_the_phase_slope_of_another_codes_curves(beta):
    """Of the gratings that `make pixel` found: Eq. 3.1 as fitted here, the slope of the phase of meent's curves."""
    chosen = gratings("sky130")
    geometry, wavelength, degrees = chosen.geometries[beta], chosen.wavelength_um, np.arange(-20, 20.1, 2.0)
    shares = [
        [[theirs(geometry, wavelength, d, field, geometry.shift + more) / 2 for d in degrees] for more in QUADRATURE]
        for field in (0, 1)
    ]
    angles = np.deg2rad(degrees)
    found = respond(geometry, angles, wavelength, orders=ORDERS)
    slope = phase_slope(replace(found, shares=np.array([shares])))
    assert slope == pytest.approx(fit(found).beta, rel=0.05)
