"""The trim at the pins is that of the pixel's type, in every row of the largest array.

Tiles of 4 x 6 in two orders, 1 x 6, 4 x 1 and 1 x 1 are proven by fast proofs, the others here by slow ones, too.
"""

import numpy as np
import pytest

from talbot.models.parameters import TileParameters
from talbot.models.parameters.array import ROWS_MAX
from talbot.rtl.asp_chip.balance_rtl import Balance
from talbot.rtl.harness.testbench import build

TILES = {f"{rows}x{cols}": TileParameters.small(rows, cols) for rows, cols in ((3, 5), (2, 4), (3, 1))}
for rows, cols in ((3, 6), (4, 5), (3, 2)):
    any_order = np.random.default_rng(rows * cols).permutation(rows * cols).tolist()
    TILES[f"{rows}x{cols} shuffled"] = TileParameters(rows, cols, TileParameters().types[: rows * cols], any_order)


class TestRTL:
    verilog = False

    @pytest.mark.parametrize("tile", TILES)
    def test_balance_follows_the_tile(self, tile):
        tile = TILES[tile]
        sim = build(Balance(tuple(tile.order), tile.rows, tile.cols, 10, 16), self.verilog, "Balance")
        rng = np.random.default_rng(tile.n_types)
        for row, kinds in enumerate(tile.type_map(ROWS_MAX, tile.cols)):
            if row % 64 == 0:  # bits 15..10 of a register have no meaning
                trims = rng.integers(0, 1 << 16, 24).tolist()
                sim.trims @= sum(trim << 16 * t for t, trim in enumerate(trims))
            sim.row @= row
            for k, kind in enumerate(kinds):
                sim.k @= k
                sim.sim_eval_combinational()
                assert int(sim.balance) == trims[kind] & 0x3FF
