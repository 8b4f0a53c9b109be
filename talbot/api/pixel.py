"""The pixel: gratings in the metal of a process, and their response to light."""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError
from talbot.pixels.optics.fit import Fit, fit
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.response import Response, respond
from talbot.pixels.optics.solve import ORDERS, SolverError

__all__ = ["Fit", "PixelGeometry", "Response", "SolverError", "fit", "solve"]


def solve(geometry: PixelGeometry, angles: npt.ArrayLike, wavelength: npt.ArrayLike, orders: int = ORDERS) -> Response:
    """Light in the photodiodes of a pixel, by rigorous coupled-wave analysis.

        response = talbot.pixel.solve(talbot.pixel.PixelGeometry(period_um=0.74), np.deg2rad([0, 7, 14]), 550e-9)
        response.shares        # (wavelength, polarization, diode, angle), of the light on the pixel
        talbot.pixel.fit(response).beta    # of a response over enough angles

    angles: (A,) in rad, in the plane across the lines, |angle| < pi/2. wavelength: one or several in m, 350e-9..1e-6.
    orders: odd; 41 are exact to 2e-3, 21 to 1e-2. Raises ParameterError, SolverError.
    """
    wavelength_um = 1e6 * np.asarray(wavelength, float)
    if wavelength_um.size and np.min(wavelength_um) > 1e3:
        raise ParameterError(f"wavelength = {1e-6 * np.min(wavelength_um):g}: must be in m, 3.5e-07..1e-06")
    return respond(geometry, angles, wavelength_um, orders=orders)
