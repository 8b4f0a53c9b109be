"""Tables of a pixel's response for the golden pixel model: its diodes over the angles of a lens."""

from collections.abc import Callable

import numpy as np

from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.response import respond
from talbot.pixels.optics.solve import Floats

ORDERS = 21
ALONG_DEGREES = np.arange(0.0, 33.1, 1.0)  # f/1.2 has 22.6
ACROSS_DEGREES = np.arange(0.0, 33.1, 8.25)
BAND_UM = 0.02  # of the filter before the lens: three wavelengths over it


def along_degrees() -> Floats:
    """Angles in the plane across the lines, of both signs."""
    return np.concatenate([-ALONG_DEGREES[:0:-1], ALONG_DEGREES])


def angle_table(
    geometry: PixelGeometry, wavelength_um: float, note: Callable[[str], None] = lambda text: None
) -> Floats:
    """Shares (4, along, across) of the light on the pixel without polarization, the mean of `BAND_UM`.

    Diodes as in `Response`. Angles along the lines are of one sign: the other's are the same.
    """
    along, across = np.meshgrid(along_degrees(), ACROSS_DEGREES, indexing="ij")
    rays = np.deg2rad(along.ravel()), np.deg2rad(across.ravel())
    shares = []
    for wavelength in wavelength_um + BAND_UM / 2 * np.array([-1, 0, 1]):
        note(f"{geometry.diffraction} at {geometry.period_um:g} um, {1e3 * wavelength:.0f} nm")
        shares.append(respond(geometry, rays[0], wavelength, rays[1], ORDERS).unpolarized[0])
    return np.mean(shares, 0).reshape(4, *along.shape)


def spectral_curves(
    geometry: PixelGeometry, wavelengths_um: Floats, note: Callable[[str], None] = lambda text: None
) -> Floats:
    """Shares (wavelengths, 2, 4, along) of the light on the pixel for rays in the plane across the lines.

    Polarizations and diodes as in `Response`.
    """
    note(f"{geometry.diffraction} at {geometry.period_um:g} um, {len(wavelengths_um)} wavelengths")
    return respond(geometry, np.deg2rad(along_degrees()), wavelengths_um, orders=ORDERS).shares
