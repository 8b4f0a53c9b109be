"""The tile's pixel types on a plan's gratings: which diodes each has, and its response over angle and wavelength."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import PixelType
from talbot.pixels.optics.design import Design, measure
from talbot.pixels.optics.fit import Fit, fit
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.response import Response, respond
from talbot.pixels.optics.scalar import scalar_shares
from talbot.pixels.response.search import Plan, bandwidth
from talbot.pixels.tabled import rows

DEGREES = np.arange(-20, 20.01, 0.5)
CURVE_ORDERS = 31
SPAN_UM = 0.08  # on each side of the plan's wavelength
WAVELENGTHS = 9
RAY_DEGREES = 10.0  # off the axis, of the rays around it
AZIMUTHS = np.deg2rad(np.arange(0, 360, 5.0))
Floats = npt.NDArray[np.floating]


@dataclass(frozen=True)
class Measured:
    """A design over angle and wavelength: its response, and Eq. 3.1 at each wavelength."""

    design: Design
    response: Response
    fits: tuple[Fit, ...]

    @property
    def fit(self) -> Fit:
        """At the design's own wavelength."""
        return self.fits[len(self.fits) // 2]

    @property
    def exact(self) -> Design:
        """The design with the fit of this response, which has more angles and orders than the search's."""
        return replace(self.design, fit=self.fit)

    @property
    def level(self) -> float:
        """Factor from the formula of mean 1 (`Fit.curve`) to shares."""
        shares = at(self.response, len(self.fits) // 2).unpolarized
        return float(shares.mean() / self.fit.curve(self.response.angles).mean())

    @property
    def bandwidth_um(self) -> float:
        """Width of the wavelengths around the design's own at which m is at least half as great."""
        return bandwidth(self.response.wavelengths_um, [one.m for one in self.fits], len(self.fits) // 2)


def wavelengths_of(plan: Plan) -> Floats:
    """Wavelengths in um of a plan's curves."""
    return plan.wavelength_um + np.linspace(-SPAN_UM, SPAN_UM, WAVELENGTHS)


def solve_one(geometry: PixelGeometry, wavelength_um: float) -> dict[str, Any]:
    """Shares and reflected light at one wavelength, as lists: a job."""
    found = respond(geometry, np.deg2rad(DEGREES), wavelength_um, orders=CURVE_ORDERS)
    return {"shares": found.shares[0].tolist(), "reflected": found.reflected[0].tolist()}


def across_lines(azimuths: Floats) -> Floats:
    """Angles in rad, in the plane across the lines, of rays `RAY_DEGREES` off the axis. azimuths: from that plane."""
    return np.arctan(np.tan(np.deg2rad(RAY_DEGREES)) * np.cos(azimuths))


def solve_around(geometry: PixelGeometry, wavelength_um: float) -> list[list[float]]:
    """Shares (4, azimuths) of the light of rays at `AZIMUTHS`, without polarization: a job."""
    angles, across = across_lines(AZIMUTHS), across_lines(AZIMUTHS - np.pi / 2)
    return respond(geometry, angles, wavelength_um, across, CURVE_ORDERS).unpolarized[0].tolist()


def name_of(kind: PixelType) -> str:
    """Return a type's name: beta, then gamma and alpha in degrees."""
    return f"{kind.beta:g}/{kind.gamma_deg:g}/{np.rad2deg(kind.alpha):g}"


def measured(design: Design, wavelengths_um: Sequence[float] | Floats, solved: Sequence[dict[str, Any]]) -> Measured:
    """Return a design from the results of `solve_one`."""
    angles = np.deg2rad(DEGREES)
    shares, reflected = (np.array([part[name] for part in solved]) for name in ("shares", "reflected"))
    response = Response(design.geometry, angles, 0 * angles, np.asarray(wavelengths_um, float), shares, reflected)
    return Measured(design, response, tuple(fit(at(response, k)) for k in range(len(solved))))


def at(response: Response, k: int) -> Response:
    """Return a response at one of its wavelengths."""
    return replace(
        response,
        wavelengths_um=response.wavelengths_um[[k]],
        shares=response.shares[[k]],
        reflected=response.reflected[[k]],
    )


def nearest(plan: Plan, beta: float) -> float:
    """Which of the plan's betas is nearest to a type's."""
    return min(plan.designs, key=lambda b: abs(b - beta))


def stacked(kinds: Sequence[PixelType], plan: Plan, found: dict[float, Measured]) -> Floats:
    """Response (type, diode, angle, wavelength, polarization) of all types along their own gratings."""
    out = []
    for kind in kinds:
        one = found[nearest(plan, kind.beta)]
        chosen = one.response.shares[:, :, list(rows(kind.alpha, one.fit))]  # wavelength, polarization, diode, angle
        out.append(chosen.transpose(2, 3, 0, 1))
    return np.array(out)


def scalar_fit(one: Measured) -> tuple[Fit, float]:
    """Eq. 3.1 fitted to scalar waves through an amplitude pixel, and their difference from the rigorous curves.

    The difference is rms over the mean, both curves of one mean.
    """
    middle = at(one.response, len(one.fits) // 2)
    truth = middle.unpolarized[0]
    shares = scalar_shares(one.design.geometry, middle.angles, one.design.wavelength_um)
    shares = shares * truth.mean() / shares.mean()
    coarse = replace(middle, shares=np.broadcast_to(shares, middle.shares.shape))
    return fit(coarse), float(np.sqrt(np.mean((shares - truth) ** 2)) / truth.mean())


def at_heights(design: Design, heights: str) -> Design:
    """Return the design where the process has another table of heights."""
    return measure(replace(design.geometry, heights=heights), design.wavelength_um)


def axes_of(response: Response) -> dict[str, Any]:
    """Axes of response.npz: angles in rad, wavelengths in m, and polarizations."""
    return {
        "angles": response.angles,
        "wavelengths": 1e-6 * response.wavelengths_um,
        "polarizations": ["along the lines", "across the lines"],
    }
