"""The solver against another coupled-wave code, meent (MIT): two gratings of lossy metal over silicon.

Silicon without loss: of an absorbing half space meent 0.13.2 says otherwise than the closed form in `solve_test`.
"""

import numpy as np
import pytest

from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.solve import Illumination, solve
from talbot.platforms.materials import refractive_index

meent = pytest.importorskip("meent")
CELLS = 560  # of a period: the edges of the lines are between them
ORDERS = 21
WAVELENGTH, PERIOD, SHIFT = 0.53, 0.7, 0.25


def cell(slab, shift):
    """A layer's refractive indices along a period, with their sign of loss."""
    x = (np.arange(CELLS) + 0.5) / CELLS - shift
    inside = np.abs((x + 0.5) % 1 - 0.5) < slab.fill / 2
    return np.sqrt(np.where(inside, slab.medium if slab.line is None else slab.line, slab.medium) + 0j).conj()


@pytest.mark.parametrize("metals", [("met4", "met1"), ("met3", "met2")])
@pytest.mark.parametrize("degrees", [0, 7, 14])
def test_transmission_is_that_of_another_code(metals, degrees):
    upper, lower = PixelGeometry(diffraction=metals[0], analyzer=metals[1], period_um=PERIOD, analyzer_fill=0.4).layers(
        WAVELENGTH
    )
    silicon, angle = float(refractive_index("silicon", WAVELENGTH).real), np.deg2rad([degrees])
    lit = Illumination(WAVELENGTH, angle, 0 * angle, bottom=silicon**2)
    ours = solve(upper, lower, PERIOD, lit, (SHIFT,), ORDERS).transmitted[:, 0, 0]
    layers = [(s, 0.0) for s in upper] + [(s, SHIFT) for s in lower]
    for field in (0, 1):
        theirs = meent.call_mee(
            backend=0,
            pol=field,
            n_top=1,
            n_bot=silicon,
            theta=float(angle[0]),
            fto=[ORDERS // 2, 0],
            wavelength=WAVELENGTH,
            period=[PERIOD, 1],
            ucell=np.array([[cell(*layer)] for layer in layers]),
            thickness=[slab.thickness_um for slab, _ in layers],
        )
        assert ours[field] == pytest.approx(float(np.sum(theirs.conv_solve().de_ti).real), abs=2e-5)
