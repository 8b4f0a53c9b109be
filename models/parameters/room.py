"""The light in a room and the photocurrent that it gives a diode: lux, W/m^2, electrons, by wavelength where known."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.parameters.checks import ParameterError, check_choice, check_real
from talbot.models.parameters.electrical import ELEMENTARY_CHARGE, PHOTON
from talbot.models.parameters.energy import LightParameters
from talbot.models.parameters.sensor import SensorParameters
from talbot.models.parameters.sources import sourced
from talbot.models.parameters.spectra import LUMENS, SURFACES, Spectrum, eye, surface
from talbot.models.parameters.spectral import SpectralParameters

SEEN = 1e-3  # lm/W: light of a lower efficacy has no illuminance
Floats = npt.NDArray[np.float64]


class Lit(NamedTuple):
    """A diffuse white surface through the lens, step by step.

    Attributes
    ----------
    room_lux, sensor_lux : float
        Illuminance of the surface and of the pixels.
    irradiance : float
        Of the pixels in W/m^2.
    power : float
        On one diode in W.
    electrons : float
        Of one diode per second.
    current : float
        The same in A.
    """

    room_lux: float
    sensor_lux: float
    irradiance: float
    power: float
    electrons: float
    current: float


class Chain(NamedTuple):
    """A diffuse surface through the lens, by wavelength: the sums over the wavelengths are the integrals.

    Attributes
    ----------
    wavelengths : float64 (n,)
        In m.
    radiance : float64 (n,)
        Of the surface, W/(m^2 sr).
    irradiance : float64 (n,)
        Of the pixels, W/m^2.
    electrons : float64 (n,)
        Of one diode per second.
    """

    wavelengths: Floats
    radiance: Floats
    irradiance: Floats
    electrons: Floats


@dataclass(frozen=True)
class RoomParameters:
    """Ordinary light, and what a diode makes of it.

    With a spectrum, efficacy, wavelength and quantum_efficiency do not count: they follow from it and from the sensor's
    `SpectralParameters`.

    Attributes
    ----------
    illuminance : float
        Of a diffuse white surface, 1e-3..1e6 lux.
    efficacy : float
        Luminous efficacy of the light's visible part, 50..683 lm/W.
    wavelength : float
        Mean of the photons, 400e-9..700e-9 m.
    quantum_efficiency : float
        Of the bare diode at that wavelength, 0.01..1.
    signal : float
        Part of a full well that white is to give, 0.01..1.
    spectrum : Spectrum or None
        Of the light.
    reflectance : str
        Name of a surface, of which white is: one of `SURFACES`.
    irradiance : float or None
        Of a surface, 1e-6..1e4 W/m^2, instead of the illuminance: for light that the eye does not see.
    """

    illuminance: float = sourced(500.0, "EN 12464-1: offices, writing and reading", "lux")
    efficacy: float = sourced(243.0, "CIE V: 683 lm/W times 106.9 nm, for equal energy from 400 to 700 nm", "lm/W")
    wavelength: float = sourced(550e-9, "our choice: the middle of 400 to 700 nm", "m")
    quantum_efficiency: float = sourced(0.5, "assumed")
    signal: float = sourced(0.8, "our choice: headroom for highlights")
    spectrum: Spectrum | None = None
    reflectance: str = "gray"
    irradiance: float | None = None

    def __post_init__(self) -> None:
        check_real("lux", self.illuminance, 1e-3, 1e6)
        check_real("efficacy", self.efficacy, 50, 683)
        check_real("wavelength", self.wavelength, 400e-9, 700e-9)
        for name in ("quantum_efficiency", "signal"):
            check_real(name, getattr(self, name), 0.01, 1)
        check_choice("reflectance", self.reflectance, SURFACES)
        if self.spectrum is None and (self.irradiance is not None or self.reflectance != "gray"):
            name = "irradiance" if self.irradiance is not None else "reflectance"
            raise ParameterError(f"{name} = {getattr(self, name)!r}: must be with a light, whose spectrum it needs")
        if self.irradiance is not None:
            check_real("irradiance", self.irradiance, 1e-6, 1e4)
        elif self.spectrum is not None and self.spectrum.efficacy < SEEN:
            said = f"must be left out with light = {self.spectrum.name}, which the eye does not see: give irradiance"
            raise ParameterError(f"lux = {self.illuminance:g}: {said}")

    def lit(self, sensor: SensorParameters, light: LightParameters | None = None) -> SensorParameters:
        """Sensor in this light.

        Parameters
        ----------
        sensor : SensorParameters
            The sensor.
        light : LightParameters, optional
            As in `white`.

        Returns
        -------
        SensorParameters
            The same, its white_current that of this light.
        """
        white = self.white(sensor.array.pitch, sensor.optics.nu_max, light, sensor.spectral)
        return replace(sensor, electrical=replace(sensor.electrical, white_current=white.current))

    def white(
        self,
        pitch: float,
        nu_max: float,
        light: LightParameters | None = None,
        spectral: SpectralParameters | None = None,
    ) -> Lit:
        """White through a lens.

        Parameters
        ----------
        pitch : float
            Of the pixels in m.
        nu_max : float
            Tangent of the lens's rim at the sensor, of the angle theta: illuminance there is sin(theta)**2 times the
            surface's and the transmission.
        light : LightParameters, optional
            Transmission of the lens, fill of the pixel, efficiency of its gratings.
        spectral : SpectralParameters, optional
            Of the sensor, the default's without; counts with a spectrum.

        Returns
        -------
        Lit
            Every step.
        """
        light = light or LightParameters()
        if self.spectrum is not None:
            chain = self.by_wavelength(pitch, nu_max, light, spectral or SpectralParameters())
            v, irradiance, electrons = eye().at(chain.wavelengths), chain.irradiance, float(chain.electrons.sum())
            lux = float(np.pi * LUMENS * (chain.radiance @ v)), float(LUMENS * (irradiance @ v))
            total = float(irradiance.sum())
            return Lit(*lux, total, total * pitch**2 * light.fill, electrons, electrons * ELEMENTARY_CHARGE)
        sensor = self.illuminance * light.transmission * nu_max**2 / (1 + nu_max**2)
        irradiance = sensor / self.efficacy
        power = irradiance * pitch**2 * light.fill
        electrons = power * self.wavelength / PHOTON * self.quantum_efficiency * light.gratings
        return Lit(self.illuminance, sensor, irradiance, power, electrons, electrons * ELEMENTARY_CHARGE)

    def by_wavelength(self, pitch: float, nu_max: float, light: LightParameters, spectral: SpectralParameters) -> Chain:
        """White through a lens in light with a spectrum.

        Parameters
        ----------
        pitch, nu_max, light, spectral
            As in `white`.

        Returns
        -------
        Chain
            At the wavelengths of `Spectrum.quadrature`.
        """
        assert self.spectrum is not None
        nodes, shares = self.spectrum.quadrature()
        on_surface = self.illuminance / self.spectrum.efficacy if self.irradiance is None else self.irradiance
        radiance = on_surface * shares * surface(self.reflectance).at(nodes) / np.pi
        irradiance = np.pi * radiance * light.transmission * nu_max**2 / (1 + nu_max**2)
        photons = irradiance * pitch**2 * light.fill * nodes / PHOTON
        electrons = photons * spectral.transmission(nodes) * spectral.efficiency(nodes) * light.gratings
        return Chain(nodes, radiance, irradiance, electrons)
