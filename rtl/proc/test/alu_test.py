"""The Alu alone against the golden instructions."""

from itertools import product

import pytest

from talbot.rtl.proc.alu_rtl import Alu
from talbot.rtl.proc.isa import BRANCHES, MASK, REGISTER, TABLE, compute, taken
from talbot.rtl.proc.test.proc_bench import simulator

CORNERS = 0, 1, 0xFFFFFFFF, 0x7FFFFFFF, 0x80000000, 0x12345678, 0xEDCBA987


def evaluated(name, a, b):
    """Return result and decision of the Alu for an instruction."""
    sim, (_, _, funct3, funct7) = simulator(Alu), TABLE[name]
    sim.funct3 @= funct3
    sim.alternative @= funct7 == 0x20
    sim.a @= a
    sim.b @= b
    sim.sim_eval_combinational()
    return int(sim.out), bool(sim.taken)


@pytest.mark.parametrize("name", REGISTER)
def test_results(name):
    """Every amount of a shift, corners, and neighbours in both orders."""
    pairs = [*product(CORNERS, range(32)), *product(CORNERS, CORNERS)]
    pairs += [(a, a + step & MASK) for a in (*CORNERS, *(1 << bit for bit in range(32))) for step in (-1, 0, 1)]
    for a, b in pairs:
        assert evaluated(name, a, b)[0] == compute(name, a, b), (hex(a), hex(b))


@pytest.mark.parametrize("name", BRANCHES)
def test_decisions(name):
    """Corners, and words that differ in a bit or by 1."""
    pairs = [*product(CORNERS, CORNERS), *((a, a ^ 1 << bit) for a in CORNERS for bit in range(32))]
    pairs += [(a, a + step & MASK) for a in (*CORNERS, *(1 << bit for bit in range(32))) for step in (-1, 0, 1)]
    for a, b in pairs:
        assert evaluated(name, a, b)[1] == taken(name, a, b), (hex(a), hex(b))
