"""The electrical chain, photocurrent to 8-bit code, in SI units, with its noise sources."""

from dataclasses import dataclass
from math import sqrt

from talbot.models.parameters.checks import ParameterError, check_int, check_real
from talbot.models.parameters.sources import sourced

ELEMENTARY_CHARGE = 1.602176634e-19  # C
PHOTON = 1.98644586e-25  # J m: Planck's constant times the speed of light
BOLTZMANN = 1.380649e-23  # J/K
TEMPERATURE = 300.0  # K, assumed


@dataclass(frozen=True)
class ElectricalParameters:
    """One photodiode pair and its amplifier.

    Attributes
    ----------
    white_current : float
        Photocurrent of one diode in a flat white scene, 1e-21..1e-3 A: that of time of flight's own light; in the other
        modes that of the room's light (`RoomParameters`) takes its place.
    full_well : float
        Charge that one diode holds between common-mode resets, 100..1e9 electrons.
    difference_gain : float
        Programmable gain of the difference before conversion, 0.25..64.
    read_noise : float
        RMS, 0..1e5 electrons per diode and read: resets, pixel and column amplifier.
    dark_current : float
        0..1e-6 A per diode.
    gain_fpn : float
        RMS of the gain fixed-pattern noise, relative, 0..0.5.
    offset_fpn : float
        RMS of the offset fixed-pattern noise, 0..1e5 electrons.
    f_mod : float
        Time-of-flight modulation frequency, 1e5..1e9 Hz.
    code : int
        Chips of the m-sequence that modulates the light, 2**n - 1 of 7..4095; 0 is a sine of f_mod.
    chip_rate : float
        Of the code, 1e6..1e9 chips a second.
    code_delay : float
        Of the first tap behind the light, 0..1e-6 s; each next is a chip later.
    contrast : float
        Demodulation contrast of time of flight, 0.01..1.
    ambient_current : float
        Photocurrent of one diode in a flat white scene that is not modulated, in time of flight, 0..1e-3 A.
    swing : float
        Voltage of a full well on the integration capacitor, 0.01..10 V: makes the kT/C noise of a common-mode reset.
    column_fpn : float
        RMS offset of a column's amplifier, 0..1e5 electrons per diode.
    flicker_noise : float
        RMS 1/f noise of a column's amplifier over the rows of a frame, 0..1e5 electrons per diode.
    """

    white_current: float = sourced(0.25e-9, "assumed, of modulated light: 80 % of a full well in 51.2 us", "A")
    full_well: float = sourced(1e5, "assumed", "electrons")
    difference_gain: float = sourced(4.0, "our choice: edges reach the converter's range")
    read_noise: float = sourced(
        180.7, "make pixel-circuit: 66.9 with both resets; make analog: 167.9 of a column", "electrons"
    )
    dark_current: float = sourced(1e-15, "assumed", "A")
    gain_fpn: float = sourced(0.00456, "make pixel-circuit: mismatch of 100 diodes' transistors")
    offset_fpn: float = sourced(262.1, "make analog: mismatch of 25 pixels' switches", "electrons")
    f_mod: float = sourced(20e6, "our choice", "Hz")
    code: int = sourced(0, "a sine", "chips")
    chip_rate: float = sourced(250e6, "our choice: a tap sees 0.6 m", "Hz")
    code_delay: float = sourced(0.0, "none", "s")
    contrast: float = sourced(1.0, "ideal")
    ambient_current: float = sourced(0.0, "none", "A")
    swing: float = sourced(1.0, "assumed", "V")
    column_fpn: float = sourced(357.5, "make analog: mismatch of 200 columns", "electrons")
    flicker_noise: float = sourced(10.0, "assumed", "electrons")

    def __post_init__(self) -> None:
        check_real("white_current", self.white_current, 1e-21, 1e-3)
        check_real("full_well", self.full_well, 100, 1e9)
        check_real("difference_gain", self.difference_gain, 0.25, 64)
        check_real("read_noise", self.read_noise, 0, 1e5)
        check_real("dark_current", self.dark_current, 0, 1e-6)
        check_real("gain_fpn", self.gain_fpn, 0, 0.5)
        check_real("offset_fpn", self.offset_fpn, 0, 1e5)
        check_real("f_mod", self.f_mod, 1e5, 1e9)
        check_int("code", self.code, 0, 4095)
        if self.code and (self.code < 7 or self.code & (self.code + 1)):
            raise ParameterError(f"code = {self.code}: must be 0, or 2**n - 1 in 7..4095")
        check_real("chip_rate", self.chip_rate, 1e6, 1e9)
        check_real("code_delay", self.code_delay, 0, 1e-6)
        check_real("contrast", self.contrast, 0.01, 1)
        check_real("ambient_current", self.ambient_current, 0, 1e-3)
        check_real("swing", self.swing, 0.01, 10)
        check_real("column_fpn", self.column_fpn, 0, 1e5)
        check_real("flicker_noise", self.flicker_noise, 0, 1e5)

    @property
    def lsb_electrons(self) -> float:
        """Electrons per code of the sum of a pair (both wells full = code 255)."""
        return 2 * self.full_well / 255

    @property
    def ambient(self) -> float:
        """Unmodulated share of the light of time of flight."""
        return self.ambient_current / self.white_current

    @property
    def ktc_noise(self) -> float:
        """RMS electrons that a reset leaves on a diode's capacitor: sqrt(kT C) / q with C = full_well q / swing."""
        return sqrt(BOLTZMANN * TEMPERATURE * self.full_well / (ELEMENTARY_CHARGE * self.swing))


AMPLIFIER = ("amplifier_offset", "amplifier_gain", "amplifier_square", "amplifier_cube")


@dataclass(frozen=True)
class ConverterParameters:
    """Imperfections of one successive-approximation lane, in units of its LSB.

    Attributes
    ----------
    inl : float
        Peak of a smooth bow of the DAC, 0..4 LSB.
    dnl : float
        RMS step error of the DAC, 0..1 LSB.
    offset : float
        RMS over the lanes of the comparator's offset, 0..16 LSB.
    noise : float
        RMS noise of the comparator at each decision, 0..16 LSB.
    ktc : float
        RMS kT/C noise of the sampling capacitor, 0..16 LSB.
    unit_mismatch : float
        RMS of a unit capacitor of a binary-weighted DAC, relative, 0..0.2: code k's level is off by what 256 such units
        make of it.
    amplifier_offset, amplifier_gain, amplifier_square, amplifier_cube : float
        What the difference amplifier of every lane adds: these times 1, x, x**2 and x**3, x the value over 128 LSB from
        the amplifier's zero (0 in edge mode, else 128), -16..16 LSB each.
    seed : int
        Seed of every draw above, 0..2**32-1.
    """

    inl: float = sourced(0.0, "ideal", "LSB")
    dnl: float = sourced(0.0, "ideal", "LSB")
    offset: float = sourced(0.0, "ideal", "LSB")
    noise: float = sourced(0.0, "ideal", "LSB")
    ktc: float = sourced(0.0, "ideal", "LSB")
    unit_mismatch: float = sourced(0.0, "ideal")
    amplifier_offset: float = sourced(0.0, "ideal", "LSB")
    amplifier_gain: float = sourced(0.0, "ideal", "LSB")
    amplifier_square: float = sourced(0.0, "ideal", "LSB")
    amplifier_cube: float = sourced(0.0, "ideal", "LSB")
    seed: int = sourced(1, "any")

    def __post_init__(self) -> None:
        check_real("inl", self.inl, 0, 4)
        for name in AMPLIFIER:
            check_real(name, getattr(self, name), -16, 16)
        check_real("dnl", self.dnl, 0, 1)
        check_real("offset", self.offset, 0, 16)
        check_real("noise", self.noise, 0, 16)
        check_real("ktc", self.ktc, 0, 16)
        check_real("unit_mismatch", self.unit_mismatch, 0, 0.2)
        check_int("seed", self.seed, 0, 2**32 - 1)
