"""What of a sensor depends on the wavelength: the gratings' modulation, the diodes' quantum efficiency, a filter."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.parameters.checks import ParameterError, check_real
from talbot.models.parameters.silicon import absorbed
from talbot.models.parameters.sources import sourced
from talbot.models.parameters.spectra import Spectrum, surface

OXIDE = 1.46  # refractive index of silica at 550 nm [Malitson1965]
SEEN = 1e-6  # of the photons: with fewer electrons there is no picture
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class SpectralParameters:
    """Wavelengths of a sensor. They count in light that has a spectrum (`LIGHT=`).

    Attributes
    ----------
    wavelength : float
        At which the modulation depth m of Eq. 3.1 and the quantum efficiency hold, 400e-9..1000e-9 m.
    quantum_efficiency : float
        Of the bare diode at that wavelength, 0.01..1.
    grating_distance : float
        Of a pixel's two gratings in the oxide, 1e-7..1e-4 m: m falls with the wavelength's distance from its own, the
        faster the greater beta is.
    collection_depth : float
        Down to which the silicon's electrons reach a diode, 1e-7..1e-3 m.
    filter_wavelength : float
        Centre of the filter's passband, 380e-9..1000e-9 m.
    filter_width : float
        Full width at half maximum of the filter, a Gaussian, 5e-9..1e-6 m; 0 is no filter.
    filter_peak : float
        Transmission of the filter at its centre, 0.01..1.

    References
    ----------
    [Jayasuriya2017], Sec. 2.2.
    """

    wavelength: float = sourced(550e-9, "our choice: the middle of 400 to 700 nm", "m")
    quantum_efficiency: float = sourced(0.5, "assumed")
    grating_distance: float = sourced(3.5e-6, "assumed: metals three apart", "m")
    collection_depth: float = sourced(5e-6, "assumed", "m")
    filter_wavelength: float = sourced(550e-9, "our choice: that of m", "m")
    filter_width: float = sourced(0.0, "none", "m")
    filter_peak: float = sourced(0.9, "assumed")

    def __post_init__(self) -> None:
        check_real("wavelength", self.wavelength, 400e-9, 1000e-9)
        check_real("quantum_efficiency", self.quantum_efficiency, 0.01, 1)
        check_real("grating_distance", self.grating_distance, 1e-7, 1e-4)
        check_real("collection_depth", self.collection_depth, 1e-7, 1e-3)
        check_real("filter_wavelength", self.filter_wavelength, 380e-9, 1000e-9)
        check_real("filter_width", self.filter_width, 0, 1e-6)
        if 0 < self.filter_width < 5e-9:
            raise ParameterError(f"filter_width = {self.filter_width!r}: must be 0, or a number in [5e-09, 1e-06]")
        check_real("filter_peak", self.filter_peak, 0.01, 1)

    def transmission(self, wavelength: npt.ArrayLike) -> Floats:
        """Transmission of the filter, 0..1; 1 without one. wavelength: in m."""
        at = np.asarray(wavelength, float)
        if not self.filter_width:
            return np.ones(at.shape)
        return self.filter_peak * np.exp(-4 * np.log(2) * ((at - self.filter_wavelength) / self.filter_width) ** 2)

    def efficiency(self, wavelength: npt.ArrayLike) -> Floats:
        """Quantum efficiency of the bare diode, in proportion to the share absorbed in the collection depth.

        wavelength: in m. Returns 0..1. Source: [Green2008].
        """
        depth = self.collection_depth
        share = absorbed(wavelength, depth) / absorbed(self.wavelength, depth)
        return np.minimum(self.quantum_efficiency * share, 1)

    def modulation(self, beta: float, wavelength: npt.ArrayLike) -> Floats:
        """Factor on the modulation depth of a type: cos(pi k (wavelength / own wavelength - 1)).

        Between gratings of period d at a distance z in the oxide, of index n, the fringes move by z theta / n, so that
        beta = 2 pi z / (n d) is the same at every wavelength. Their depth follows the phase between the diffracted
        orders and the straight one, pi wavelength z / (n d**2): k = n beta**2 own wavelength / (4 pi**2 z) is the
        distance in half Talbot lengths at the own wavelength, where m is at its peak.

        beta: of the type. wavelength: in m. Returns -1..1; below 0 the fringes are inverted.
        """
        orders = OXIDE * beta**2 * self.wavelength / (4 * np.pi**2 * self.grating_distance)
        return np.cos(np.pi * orders * (np.asarray(wavelength, float) / self.wavelength - 1))

    def electrons(self, lamp: Spectrum, reflectance: str = "gray") -> tuple[Floats, Floats]:
        """Weights of the wavelengths in a diode's electrons, for averages of a response over them.

        lamp: the light. reflectance: name of the surface that it falls on. Returns wavelengths in m (n,), and weights
        (n,) of sum 1: power times reflectance, filter, quantum efficiency and wavelength. Raises ParameterError where
        less than 1e-6 of the photons become electrons.
        """
        nodes, shares = lamp.quadrature()
        photons = shares * nodes
        seen = photons * surface(reflectance).at(nodes) * self.transmission(nodes) * self.efficiency(nodes)
        if not seen.sum() > SEEN * photons.sum():
            left = f"surface and filter leave {seen.sum() / photons.sum():.1g} of its photons"
            raise ParameterError(f"light = {lamp.name!r}: must reach the diodes; {left}")
        return nodes, seen / seen.sum()

    def depth(self, beta: float, lamp: Spectrum, reflectance: str = "gray") -> float:
        """Factor on the modulation depth of a type in a light, -1..1: the mean of `modulation` over `electrons`.

        beta: of the type. lamp, reflectance: as in `electrons`.
        """
        nodes, weights = self.electrons(lamp, reflectance)
        return float(weights @ self.modulation(beta, nodes))
