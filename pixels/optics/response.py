"""Angular responses of a pixel's photodiodes, as its gratings make them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.pixels.optics.geometry import QUADRATURE, PixelGeometry, Slab
from talbot.pixels.optics.solve import ORDERS, Floats, Illumination, solve
from talbot.platforms.materials import refractive_index
from talbot.platforms.optics import OpticalStack


@dataclass(frozen=True)
class Response:
    """Shares of the light on a pixel that enter the silicon under a diode.

    Attributes
    ----------
    angles : Floats
        (A,), rad between the ray's projection and the normal, in the plane across the lines.
    across : Floats
        (A,), the same in the plane along the lines.
    wavelengths_um : Floats
        (W,).
    shares : Floats
        (W, 2, 4, A), 0..1: polarization along the lines, then across them; diodes whose analyzers (or fingers) are
        shifted by 0, 1/4, 1/2 and 3/4 of a period. Diodes 0 and 2 form the pixel of one type, 1 and 3 that of the type
        in quadrature.
    reflected : Floats
        (W, 2, 4, A).
    """

    geometry: PixelGeometry
    angles: Floats
    across: Floats
    wavelengths_um: Floats
    shares: Floats
    reflected: Floats

    @property
    def unpolarized(self) -> Floats:
        """Shares (W, 4, A) of light without polarization."""
        return self.shares.mean(1)


def respond(
    geometry: PixelGeometry,
    angles: npt.ArrayLike,
    wavelengths_um: npt.ArrayLike,
    across: npt.ArrayLike = 0.0,
    orders: int = ORDERS,
) -> Response:
    """Response of ``geometry``. angles, across: in rad, below pi/2, broadcast to (A,).

    Raises ParameterError, SolverError.

    The lines are their own mirror image: what falls in from the left on an analyzer moved to the right is what falls in
    from the right on one moved to the left, so that angles of both signs, and angles along the lines, are solved once.
    """
    angles, across = np.broadcast_arrays(np.atleast_1d(angles).astype(float), np.asarray(across, float))
    wavelengths = np.atleast_1d(wavelengths_um).astype(float)
    rays, which = np.unique(np.stack([np.abs(angles), np.abs(across)]).round(12), axis=1, return_inverse=True)
    shifts = np.add(geometry.shift, QUADRATURE)
    both = np.unique(np.concatenate([shifts, -shifts]).round(9) % 1.0)
    rows = [np.array([_index(both, sign * shift) for shift in shifts]) for sign in (1, -1)]
    left = angles < 0
    shares, reflected = [], []
    for wavelength in wavelengths:
        part, back = _solved(geometry, rays, float(wavelength), both, orders)
        for out, values in ((shares, part), (reflected, back)):
            out.append(np.where(left, values[:, rows[1]][..., which], values[:, rows[0]][..., which]))
    return Response(geometry, angles, across, wavelengths, np.array(shares), np.array(reflected))


def bare_share(stack: OpticalStack, wavelength_um: float) -> float:
    """Share of the light on a pixel that each of two diodes gets on the axis, where there is no metal."""
    slabs, below = [], stack.surface_um
    for film in stack.films:
        slabs.append(Slab(complex(refractive_index(film.material, wavelength_um) ** 2), film.top_um - below))
        below = film.top_um
    silicon = complex(refractive_index("silicon", wavelength_um)) ** 2
    light = Illumination(wavelength_um, np.zeros(1), np.zeros(1), bottom=silicon)
    return float(solve(slabs[::-1], [], 1.0, light, orders=1).transmitted.mean()) / 2


def _solved(
    geometry: PixelGeometry, rays: Floats, wavelength_um: float, shifts: Sequence[float] | Floats, orders: int
) -> tuple[Floats, Floats]:
    """Shares and reflected light, (2, shifts, A) each."""
    upper, lower = geometry.layers(wavelength_um)
    silicon = complex(refractive_index("silicon", wavelength_um)) ** 2
    light = Illumination(wavelength_um, rays[0], rays[1], bottom=silicon)
    listed = [*map(float, shifts)]
    light_shares = solve(upper, lower, geometry.period_um, light, listed, orders, geometry.shared)
    # Half of the pixel is above each diode of an amplitude pixel; fingers share all of it.
    return (
        light_shares.transmitted / 2 if light_shares.fingers is None else light_shares.fingers[:, :, 0]
    ), light_shares.reflected


def _index(values: Floats, value: float) -> int:
    distance = np.abs((values - value + 0.5) % 1 - 0.5)
    return int(np.argmin(distance))
