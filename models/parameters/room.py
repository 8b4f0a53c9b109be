"""The light in a room and the photocurrent that it gives a diode: lux, W/m^2, electrons."""

from dataclasses import dataclass, replace
from typing import NamedTuple

from talbot.models.parameters.checks import check_real
from talbot.models.parameters.electrical import ELEMENTARY_CHARGE, PHOTON
from talbot.models.parameters.energy import LightParameters
from talbot.models.parameters.sensor import SensorParameters
from talbot.models.parameters.sources import sourced


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


@dataclass(frozen=True)
class RoomParameters:
    """Ordinary light, and what a diode makes of it.

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
    """

    illuminance: float = sourced(500.0, "EN 12464-1: offices, writing and reading", "lux")
    efficacy: float = sourced(243.0, "CIE V: 683 lm/W times 106.9 nm, for equal energy from 400 to 700 nm", "lm/W")
    wavelength: float = sourced(550e-9, "our choice: the middle of 400 to 700 nm", "m")
    quantum_efficiency: float = sourced(0.5, "assumed")
    signal: float = sourced(0.8, "our choice: headroom for highlights")

    def __post_init__(self) -> None:
        check_real("lux", self.illuminance, 1e-3, 1e6)
        check_real("efficacy", self.efficacy, 50, 683)
        check_real("wavelength", self.wavelength, 400e-9, 700e-9)
        for name in ("quantum_efficiency", "signal"):
            check_real(name, getattr(self, name), 0.01, 1)

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
        white = self.white(sensor.array.pitch, sensor.optics.nu_max, light)
        return replace(sensor, electrical=replace(sensor.electrical, white_current=white.current))

    def white(self, pitch: float, nu_max: float, light: LightParameters | None = None) -> Lit:
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

        Returns
        -------
        Lit
            Every step.
        """
        light = light or LightParameters()
        sensor = self.illuminance * light.transmission * nu_max**2 / (1 + nu_max**2)
        irradiance = sensor / self.efficacy
        power = irradiance * pitch**2 * light.fill
        electrons = power * self.wavelength / PHOTON * self.quantum_efficiency * light.gratings
        return Lit(self.illuminance, sensor, irradiance, power, electrons, electrons * ELEMENTARY_CHARGE)
