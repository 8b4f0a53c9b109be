"""Tables of a design for the golden pixel model: both diodes over the angles of a lens."""

from collections.abc import Callable

import numpy as np

from .design import SEARCH_ORDERS, Design
from .response import respond
from .solve import Floats

ALONG_DEGREES = np.arange(0.0, 33.1, 1.5)  # f/1.2 has 22.6
ACROSS_DEGREES = np.arange(0.0, 33.1, 5.5)
BAND_UM = 0.02  # of a filter before the lens: three wavelengths over it


def angle_table(design: Design, note: Callable[[str], None] = lambda text: None) -> Floats:
    """Shares (4, along, across) of the light on the pixel without polarization, over the design's band.

    Of angles along the lines those of one sign: the other is the same. Diodes as in `Response`.
    """
    along, across = np.meshgrid(_mirrored(ALONG_DEGREES), ACROSS_DEGREES, indexing="ij")
    rays = np.deg2rad(along.ravel()), np.deg2rad(across.ravel())
    shares = []
    for wavelength in design.wavelength_um + BAND_UM / 2 * np.array([-1, 0, 1]):
        note(f"{design.geometry.diffraction}, {design.geometry.period_um:g} um at {1e3 * wavelength:.0f} nm")
        shares.append(respond(design.geometry, rays[0], wavelength, rays[1], SEARCH_ORDERS).unpolarized[0])
    return np.mean(shares, 0).reshape(4, *along.shape)


def _mirrored(degrees: Floats) -> Floats:
    return np.concatenate([-degrees[:0:-1], degrees])
