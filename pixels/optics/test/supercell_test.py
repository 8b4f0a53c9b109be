"""A whole period with anything in it: against even lines, which the other solver has, and against its own parts."""

import numpy as np
import pytest

from talbot.models.parameters import ParameterError
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.solve import Illumination, solve
from talbot.pixels.optics.supercell import Section, section_shares, slabs
from talbot.platforms.materials import refractive_index
from talbot.platforms.optics import optical_stack

STACK, WAVELENGTH, PERIOD, TIMES = optical_stack("sky130"), 0.575, 0.7, 3


def even(shift):
    """Lines of met4 over met1 at half fill, `TIMES` periods of them."""
    places = np.arange(-1, TIMES + 1)
    cell = TIMES * PERIOD
    out = {}
    for name, at in (("met4", 0.0), ("met1", shift)):
        lines = [(PERIOD * (k + at - 0.25), PERIOD * (k + at + 0.25)) for k in places]
        out[name] = tuple((max(a, 0.0), min(b, cell)) for a, b in lines if b > 0 and a < cell)
    return Section(cell, out, (((0.0, 1.0),), ((1.0, cell),)))


def test_periods_side_by_side_are_one_period():
    """Only multiples of the lines' own orders take part: 33 of three periods are 11 of one."""
    sines, shares, total = section_shares(STACK, even(0.25), WAVELENGTH, 11 * TIMES, 1, 0.5)
    axis = int(np.argmin(np.abs(sines)))
    light = Illumination(
        WAVELENGTH, np.zeros(1), np.zeros(1), bottom=complex(refractive_index("silicon", WAVELENGTH)) ** 2
    )
    upper, lower = PixelGeometry(period_um=PERIOD).layers(WAVELENGTH)
    expected = solve(upper, lower, PERIOD, light, (0.25,), 11).transmitted[:, 0, 0]
    np.testing.assert_allclose(total[:, axis], expected, atol=1e-9)
    np.testing.assert_allclose(shares.sum(1), total, atol=1e-9)  # both wells together are all
    assert shares.min() > 0 and sines.size == 2 * int(0.5 * TIMES * PERIOD / WAVELENGTH) + 1


def test_offsets_are_angles_between():
    """Of a mirrored cut the response is mirrored; two offsets have twice the angles, none of them twice."""
    cut = Section(2.0, {"met1": ((0.6, 1.4),)}, (((0.0, 2.0),),))
    sines, _, total = section_shares(STACK, cut, WAVELENGTH, 21, 2, 0.5)
    np.testing.assert_allclose(sines, -sines[::-1], atol=1e-12)
    np.testing.assert_allclose(total, total[:, ::-1], atol=1e-9)
    np.testing.assert_allclose(np.diff(sines), WAVELENGTH / 2.0 / 2, atol=1e-12)


def test_metal_everywhere_is_dark_and_none_is_the_bare_stack():
    dark, bare = (Section(2.0, {"met1": spans}, (((0.0, 2.0),),)) for spans in (((0.0, 2.0),), ()))
    assert section_shares(STACK, dark, WAVELENGTH, 5, 1, 0.5)[2].max() < 1e-6
    assert 0.5 < section_shares(STACK, bare, WAVELENGTH, 5, 1, 0.5)[2].min() < 1
    assert all(slab.line is None for slab in slabs(STACK, bare, WAVELENGTH))


def test_what_is_refused():
    with pytest.raises(ParameterError, match="metal = 'gold': must be one of met1"):
        section_shares(STACK, Section(2.0, {"gold": ((0.0, 1.0),)}, ()), WAVELENGTH, 5, 1, 0.5)
    with pytest.raises(ParameterError, match=r"most = 2: must be a number in \[0, 1\]"):
        section_shares(STACK, even(0.0), WAVELENGTH, 5, 1, 2)
