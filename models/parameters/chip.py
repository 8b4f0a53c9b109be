"""Parameters of the digital chip that are fixed at build time."""

from dataclasses import dataclass

from talbot.models.parameters.checks import check_choice, check_int, check_real
from talbot.models.parameters.divider import (
    DIVIDERS,
    ITERATIONS_MAX,
    ITERATIONS_MIN,
    N_FRAC_MAX,
    N_FRAC_MIN,
    NO_DIVIDER,
)

LANES = (1, 2, 4, 8, 16, 32)
SPI_INPUTS = ("sclk", "csn", "mosi")
ASYNCHRONOUS = (*SPI_INPUTS, "reset")  # pins of the chip whose edges have no relation to the clock


@dataclass(frozen=True)
class ChipParameters:
    """Build-time parameters of the digital chip.

    Attributes
    ----------
    lanes : int
        Converters side by side, a power of two in 1..32.
    divider : str
        Variant of the quadrature divider on the readout path, one of DIVIDERS, or "none": no phase path.
    n_frac : int
        Fraction bits of the divider's ratio, 4..16.
    cordic_iterations : int
        Steps of the CORDIC variant, 4..16.
    f_clk : float
        System clock, 1e3..1e9 Hz.
    """

    lanes: int = 8
    divider: str = "radix4"
    n_frac: int = 8
    cordic_iterations: int = 10
    f_clk: float = 10e6

    def __post_init__(self) -> None:
        check_choice("lanes", self.lanes, LANES)
        check_choice("divider", self.divider, (*DIVIDERS, NO_DIVIDER))
        check_int("n_frac", self.n_frac, N_FRAC_MIN, N_FRAC_MAX)
        check_int("cordic_iterations", self.cordic_iterations, ITERATIONS_MIN, ITERATIONS_MAX)
        check_real("f_clk", self.f_clk, 1e3, 1e9)

    @property
    def has_phase_path(self) -> bool:
        """Whether the chip computes phases."""
        return self.divider != NO_DIVIDER
