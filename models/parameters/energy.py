"""Energy of an event on the chip, from the measured power of the thesis's sensor [Jayasuriya2017, Table 6.1]."""

from dataclasses import dataclass

from .checks import check_int, check_real


@dataclass(frozen=True)
class EnergyParameters:
    """Measured power of a sensor, by part, and the frame rate at which it is measured.

    Table 6.1 gives no frame rate: `frame_rate` is our assumption.

    Attributes
    ----------
    pixel_array, amplifiers, timing, adcs : float
        Power of each part, 0..1 W.
    frame_rate : float
        0.1..1e5 frames per second.
    pixels : int
        Pixels of the measured sensor, 1..2**31.
    decisions : int
        Comparator decisions of one full conversion, 1..64.

    References
    ----------
    [Jayasuriya2017], Table 6.1.
    """

    pixel_array: float = 300e-6
    amplifiers: float = 900e-6
    timing: float = 500e-6
    adcs: float = 100e-6
    frame_rate: float = 30.0
    pixels: int = 384 * 384
    decisions: int = 8

    def __post_init__(self) -> None:
        for name in ("pixel_array", "amplifiers", "timing", "adcs"):
            check_real(name, getattr(self, name), 0, 1)
        check_real("frame_rate", self.frame_rate, 0.1, 1e5)
        check_int("pixels", self.pixels, 1, 2**31)
        check_int("decisions", self.decisions, 1, 64)

    def frame(self, resets: int, amplified: int, seconds: float, decisions: int) -> dict[str, float]:
        """Energy of one frame by part.

        Parameters
        ----------
        resets : int
            Pixels reset and integrated: whole rows, once per tap.
        amplified : int
            Pixels whose column amplifier ran.
        seconds : float
            Duration of the frame.
        decisions : int
            Comparator decisions, window and search together.

        Returns
        -------
        dict of str to float
            Part to energy in J.
        """
        each = 1 / (self.frame_rate * self.pixels)
        return {
            "pixel_array": self.pixel_array * each * resets,
            "amplifiers": self.amplifiers * each * amplified,
            "timing": self.timing * seconds,
            "adcs": self.adcs * each / self.decisions * decisions,
        }
