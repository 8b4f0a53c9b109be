"""Size of the pixel array [Jayasuriya2017, Sec. 3.5.1]."""

from dataclasses import dataclass

from talbot.models.parameters.checks import check_int, check_real
from talbot.models.parameters.sources import sourced

ROWS_MAX, COLS_MAX = 1024, 1536  # 256 tiles each way: tile addresses are 8 bits


@dataclass(frozen=True)
class ArrayParameters:
    """Size of the pixel array. Tiles at the far edges may be partial.

    Attributes
    ----------
    rows, cols : int
        Pixels, 1..1024 and 1..1536.
    pitch : float
        Pixel pitch, 1e-7..1e-3 m.
    """

    rows: int = 384
    cols: int = 384
    pitch: float = sourced(10e-6, "[Jayasuriya2017], Sec. 3.5.1", "m")

    def __post_init__(self) -> None:
        check_int("rows", self.rows, 1, ROWS_MAX)
        check_int("cols", self.cols, 1, COLS_MAX)
        check_real("pitch", self.pitch, 1e-7, 1e-3)

    @property
    def pitch_um(self) -> float:
        """Pixel pitch in um, to a picometre."""
        return round(1e6 * self.pitch, 6)
