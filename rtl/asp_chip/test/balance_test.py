"""The trim at the pins is the one of the pixel's type."""

import pytest

from models.parameters import TileParameters
from rtl.asp_chip.balance_rtl import Balance
from rtl.harness.testbench import build

SMALL_TILE = TileParameters(3, 2, TileParameters().types[:6], (5, 0, 3, 1, 4, 2))


@pytest.mark.parametrize("tile", [TileParameters(), SMALL_TILE])
def test_balance_follows_the_tile(tile):
    sim = build(Balance(tuple(tile.order), tile.rows, tile.cols, 10, 16))
    trims = [(37 * t + 5) & 0x3FF for t in range(24)]
    sim.trims @= sum(trim << 16 * t for t, trim in enumerate(trims))
    kinds = tile.type_map(12, tile.cols)
    for row in range(12):
        for k in range(tile.cols):
            sim.row @= row + 120
            sim.k @= k
            sim.sim_eval_combinational()
            assert int(sim.balance) == trims[kinds[row, k]]
