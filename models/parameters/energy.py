"""Energy of an event on the chip, from the measured power of the thesis's sensor [Jayasuriya2017, Table 6.1]."""

from dataclasses import dataclass

from .checks import check_int, check_real


@dataclass(frozen=True)
class EnergyParameters:
    """Table 6.1 gives power, not the frame rate it was measured at: `frame_rate` is our assumption.

    pixel_array, amplifiers, timing, adcs: 0..1 W at 384 x 384 pixels.
    frame_rate: 0.1..1e5 frames a second.
    pixels: of the measured sensor, 1..2**31. decisions: of the comparator in one full conversion, 1..64.
    """

    pixel_array: float = 300e-6
    amplifiers: float = 900e-6
    timing: float = 500e-6
    adcs: float = 100e-6
    frame_rate: float = 30.0
    pixels: int = 384 * 384
    decisions: int = 8

    def __post_init__(self):
        for name in ("pixel_array", "amplifiers", "timing", "adcs"):
            check_real(name, getattr(self, name), 0, 1)
        check_real("frame_rate", self.frame_rate, 0.1, 1e5)
        check_int("pixels", self.pixels, 1, 2**31)
        check_int("decisions", self.decisions, 1, 64)

    def frame(self, resets, amplified, seconds, decisions):
        """Energy of one frame in J, by part: dict.

        resets: pixels reset and integrated (whole rows, once a tap). amplified: pixels whose column amplifier ran.
        seconds: duration of the frame. decisions: comparator decisions, window and search together.
        """
        each = 1 / (self.frame_rate * self.pixels)
        return {
            "pixel_array": self.pixel_array * each * resets,
            "amplifiers": self.amplifiers * each * amplified,
            "timing": self.timing * seconds,
            "adcs": self.adcs * each / self.decisions * decisions,
        }
