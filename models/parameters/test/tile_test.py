"""The tile as docs/host.md (Pixel types) and [Jayasuriya2017, Sec. 3.5.1] have it, typed from there."""

import numpy as np

from talbot.models.parameters import ArrayParameters, TileParameters

ORDER = """
 0  9 20 14  3 17
12 22  5 11 18  6
 2 15 16  1  8 21
19  4 10 23  7 13
"""
# Low and high frequencies: 0, 90 and +-45 degrees; mid frequencies: +-22.5 and +-67.5; each as a quadrature pair
GAMMAS = {12: (0, 90, 45, -45), 18: (22.5, -22.5, 67.5, -67.5), 24: (0, 90, 45, -45)}


def test_order_and_types():
    tile = TileParameters()
    assert tile.type_map(4, 6).tolist() == [[int(kind) for kind in row.split()] for row in ORDER.split("\n")[1:-1]]
    types = [(beta, gamma, alpha) for beta, gammas in GAMMAS.items() for gamma in gammas for alpha in (0, np.pi / 2)]
    assert [(kind.beta, kind.gamma_deg, kind.alpha) for kind in tile.types] == types


def test_any_patch_has_an_even_mix():
    """Two types of every beta in a row, at least one in a column, whatever the order."""
    kinds = TileParameters().type_map(4, 6) // 8
    assert all(np.bincount(row, minlength=3).tolist() == [2, 2, 2] for row in kinds)
    assert all(set(column) == {0, 1, 2} for column in kinds.T)


def test_the_array_of_the_thesis():
    """96 x 64 tiles are 384 x 384 pixels; the die of 5 x 5 mm holds them at 10 um."""
    array, tile = ArrayParameters(), TileParameters()
    assert (array.rows, array.cols, array.rows / tile.rows, array.cols / tile.cols) == (384, 384, 96, 64)
    assert array.pitch == 10e-6 and array.rows * array.pitch < 5e-3
