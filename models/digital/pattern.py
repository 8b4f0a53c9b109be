"""The chip's test pattern: a digital image in place of the analog front end, for bring-up.

A ramp over rows, tiles, types and sub-samples makes every code; in a checkerboard of quiet areas only its two
lowest bits are left around mid-scale, so that a window comparison has something to leave out.
"""

from dataclasses import dataclass

import numpy as np

from models.digital.sar import BIPOLAR, convert
from models.parameters import SAMPLES_PER_PIXEL, TileParameters


def pattern_value(row, tile, k, sub):
    """Value at the comparators, 0..255 (offset binary in edge mode): int array of the broadcast shape.

    row: pixel row. tile: tile column. k: column in the tile. sub: sub-sample. Integers >= 0.
    """
    row, tile, k, sub = (np.asarray(x, np.int64) for x in (row, tile, k, sub))
    ramp = (3 * row + 5 * tile + 40 * k + 37 * sub) & 0xFF
    quiet = (row >> 2 ^ tile >> 1) & 1
    return np.where(quiet, 0x80 | ramp & 3, ramp)


@dataclass(frozen=True)
class PatternEnd:
    """Stands where models.afe.FrontEnd does when the chip's test pattern is on: ideal, and blind to the scene.

    rows, cols: size of the array in pixels.
    """

    rows: int
    cols: int
    tile: TileParameters = TileParameters()

    def values(self, mode):
        """What the comparators see, in LSB: float64 (subs, rows, cols)."""
        sub, row, col = np.ogrid[: SAMPLES_PER_PIXEL[mode], : self.rows, : self.cols]
        value = pattern_value(row, col // self.tile.cols, col % self.tile.cols, sub).astype(np.float64)
        return value - BIPOLAR if mode == "edge" else value

    def convert(self, samples, mode, threshold=0):
        """The codes of a whole frame: Conversion of arrays (subs, rows, cols). samples: not looked at."""
        return convert(self.values(mode), mode != "edge", threshold)
