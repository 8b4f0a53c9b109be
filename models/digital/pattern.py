"""Test pattern of the chip: a digital image instead of the analog front end, for bring-up.

A ramp over rows, tiles, types and sub-samples contains every code. In a checkerboard of quiet areas only its two
lowest bits remain, around mid-scale, so that the window comparison leaves out some conversions.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.digital.sar import BIPOLAR, Conversion, convert
from talbot.models.parameters import SAMPLES_PER_PIXEL, SIGNED, TileParameters


def pattern_value(
    row: npt.ArrayLike, tile: npt.ArrayLike, k: npt.ArrayLike, sub: npt.ArrayLike
) -> npt.NDArray[np.int64]:
    """Value of the pattern at the comparators.

    row, tile, k, sub: pixel row, tile column, column in the tile and sub-sample; 0 or more, broadcastable. Returns
    0..255 (offset binary in edge and ternary mode), of the broadcast shape.
    """
    y, t, x, s = (np.asarray(place, np.int64) for place in (row, tile, k, sub))
    ramp = (3 * y + 5 * t + 40 * x + 37 * s) & 0xFF
    quiet = (y >> 2 ^ t >> 1) & 1
    return np.where(quiet, 0x80 | ramp & 3, ramp)


@dataclass(frozen=True)
class PatternEnd:
    """Replacement of models.afe.FrontEnd when the test pattern is on: ideal, and independent of the scene.

    rows, cols: size of the array in pixels.
    tile: the tile.
    """

    rows: int
    cols: int
    tile: TileParameters = TileParameters()

    def values(self, mode: str) -> npt.NDArray[np.float64]:
        """Values at the comparators.

        mode: one of MODES. Returns (subs, rows, cols), in LSB.
        """
        sub, row, col = np.ogrid[: SAMPLES_PER_PIXEL[mode], : self.rows, : self.cols]
        value = pattern_value(row, col // self.tile.cols, col % self.tile.cols, sub).astype(np.float64)
        return value - BIPOLAR if mode in SIGNED else value

    def convert(self, samples: npt.ArrayLike, mode: str, threshold: int = 0) -> Conversion:
        """Convert a whole frame.

        samples: ignored. mode: one of MODES. threshold: 0..127 codes. Returns Conversion: of arrays (subs, rows, cols).
        """
        return convert(self.values(mode), mode not in SIGNED, threshold, ternary=mode == "ternary")
