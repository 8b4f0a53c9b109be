"""Specifications of the circuits, from the sensor's parameters, the chip's timing and Table 6.1's power."""

from dataclasses import dataclass
from typing import Self

from talbot.models.parameters import EnergyParameters, ParameterError, SensorParameters, check_real
from talbot.models.parameters.energy import DECISIONS

CODES = 256


def one_digit(value: float) -> float:
    """Return ``value`` to one significant digit, as the powers of Table 6.1."""
    return float(f"{value:.0e}")


@dataclass(frozen=True)
class LaneSpec:
    """A converter lane: what converts ``lane_a - lane_b`` into a code, and its parts.

    Code d is reached from (d - 128 - 0.5) LSB on: value + 128 in edge mode, the value itself in the others, whose zero
    is 128 LSB below the reference level.

    Attributes
    ----------
    supply : float
        V, 1.2..2; limits hold for 10 % around it.
    refn, refp : float
        Reference levels, 0..2 V; an LSB is their difference / 256.
    vcm : float
        Level of the capacitors' common plate while it samples, 0..2 V: the comparator's common mode.
    reference_resistance : float
        Ohm, 0..1e4, of each external reference up to the lane.
    f_clk : float
        The chip's clock, Hz: a decision a cycle, its first half for the DAC, its second for the comparator.
    offset, noise, ktc : float
        Limits in LSB, rms: of the comparator over lanes, of a decision, of the sample.
    inl, dnl : float
        Limits in LSB, peak.
    settling : float
        Limit in LSB of what is left when the comparator is strobed.
    enob : float
        Least effective number of bits.
    decision_energy : float
        J: a decision's part of the converters' power in Table 6.1, to one digit.
    comparator_share : float
        Of it, for the comparator; the rest is for capacitors and switches.
    droop : float
        Limit in LSB over a conversion.
    """

    supply: float = 1.8
    refn: float = 0.2
    refp: float = 1.4
    vcm: float = 0.8
    reference_resistance: float = 50.0
    f_clk: float = 10e6
    offset: float = 0.5
    noise: float = 0.25
    ktc: float = 0.15
    inl: float = 0.5
    dnl: float = 0.5
    settling: float = 0.5
    enob: float = 7.3
    decision_energy: float = 3e-12
    comparator_share: float = 0.5
    droop: float = 0.5

    def __post_init__(self) -> None:
        check_real("supply", self.supply, 1.2, 2.0)
        for name in ("refn", "refp", "vcm"):
            check_real(name, getattr(self, name), 0.0, 2.0)
        if not self.refn + 0.1 <= self.refp <= self.supply:
            raise ParameterError(f"refp = {self.refp}: must be in {self.refn + 0.1:g}..{self.supply:g} V")
        check_real("reference_resistance", self.reference_resistance, 0, 1e4)
        check_real("f_clk", self.f_clk, 1e3, 1e9)
        for name in ("offset", "noise", "ktc", "inl", "dnl", "settling", "droop"):
            check_real(name, getattr(self, name), 0.01, 16)
        check_real("enob", self.enob, 1, 8)
        check_real("decision_energy", self.decision_energy, 1e-18, 1e-6)
        check_real("comparator_share", self.comparator_share, 0.05, 0.95)

    @classmethod
    def of(cls, sensor: SensorParameters | None = None, energy: EnergyParameters | None = None) -> Self:
        """The lane of a sensor: its clock and Table 6.1's power."""
        sensor, energy = sensor or SensorParameters(), energy or EnergyParameters()
        return cls(
            f_clk=sensor.chip.f_clk,
            decision_energy=one_digit(energy.adcs / (energy.frame_rate * energy.pixels * DECISIONS)),
        )

    @property
    def lsb(self) -> float:
        """An LSB at the lane's input, V."""
        return (self.refp - self.refn) / CODES

    @property
    def half_cycle(self) -> float:
        """Time for the DAC to settle, and for the comparator to decide, s."""
        return 0.5 / self.f_clk

    @property
    def unit_mismatch(self) -> float:
        """Rms of a unit capacitor at which three sigma of the step at mid-scale, sqrt(255) units, are ``dnl``."""
        return self.dnl / 3 / (CODES - 1) ** 0.5
