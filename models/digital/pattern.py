"""The chip's test pattern: a digital image in place of the analog front end, for bring-up.

A ramp over rows, tiles, types and sub-samples makes every code; in a checkerboard of quiet areas only its two
lowest bits are left around mid-scale, so that a window comparison has something to leave out.
"""

import numpy as np


def pattern_value(row, tile, k, sub):
    """Value at the comparators, 0..255 (offset binary in edge mode): int array of the broadcast shape.

    row: pixel row. tile: tile column. k: column in the tile. sub: sub-sample. Integers >= 0.
    """
    row, tile, k, sub = (np.asarray(x, np.int64) for x in (row, tile, k, sub))
    ramp = (3 * row + 5 * tile + 40 * k + 37 * sub) & 0xFF
    quiet = (row >> 2 ^ tile >> 1) & 1
    return np.where(quiet, 0x80 | ramp & 3, ramp)


def pattern_held(rows, cols, subs, unsigned, tile_cols=6):
    """The pattern as held values of a whole array in LSB: float64 (rows, cols, subs).

    unsigned: 0..255, else -128..127.
    """
    row, col, sub = np.ogrid[:rows, :cols, :subs]
    value = pattern_value(row, col // tile_cols, col % tile_cols, sub).astype(np.float64)
    return value if unsigned else value - 128
