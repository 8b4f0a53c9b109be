"""Every copy of a block as gates equals the block in PyMTL; the copies have different inputs."""

import numpy as np
import pytest

from talbot.rtl.harness.gates import WIDE, Gates, packed, unpacked
from talbot.rtl.harness.test.driven_test import Counter
from talbot.rtl.harness.testbench import build


@pytest.mark.parametrize("width", [1, 8, 30])
def test_packed_and_unpacked(width):
    values = np.random.default_rng(1).integers(0, 1 << width, 2 * WIDE)
    assert packed(values, width).shape == (width, 2 * WIDE // 64)
    assert (unpacked(packed(values, width)) == values).all()


def test_each_copy_is_the_block():
    random, copies, gates, sim = np.random.default_rng(1), (0, 64, 700, 1023), Gates(Counter(), 1024), []
    steps, resets = random.integers(0, 16, (20, 1024)), random.random((20, 1024)) < 0.1
    resets[0] = True
    for copy in copies:
        sim = build(Counter())
        for cycle in range(20):
            gates["step"], gates["reset"] = packed(steps[cycle], 4), packed(resets[cycle])
            gates.tick()
            sim.step @= steps[cycle, copy]
            sim.reset @= resets[cycle, copy]
            sim.sim_eval_combinational()
            assert cycle == 0 or (unpacked(gates["value"])[copy], unpacked(gates["carry"])[copy]) == (
                sim.value,
                sim.carry,
            )
            sim.sim_tick()


def test_one_value_for_all_copies():
    gates = Gates(Counter(), WIDE)
    for reset in (1, 0, 0):
        gates["reset"], gates["step"] = reset, 5
        gates.tick()
    assert set(unpacked(gates["value"])) == {5}
