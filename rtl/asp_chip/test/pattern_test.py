"""The pattern generator against its golden function, and the function against its purpose."""

import numpy as np
import pytest

from talbot.models.digital.pattern import PatternEnd, pattern_value
from talbot.models.parameters import LANES
from talbot.rtl.asp_chip.pattern_rtl import Pattern
from talbot.rtl.harness.testbench import build


def test_pattern_makes_every_code_and_runs_of_zeros():
    end = PatternEnd(64, 96)
    codes, converted, _ = end.convert(None, "edge", 10)
    assert set(np.unique(codes)) == set(range(-128, -9)) | {0} | set(range(10, 128))
    assert 0.4 < converted.mean() < 0.6
    for mode, subs in (("image", 1), ("raw", 2), ("tof", 4)):
        codes = end.convert(None, mode).codes
        assert codes.shape == (subs, 64, 96) and set(np.unique(codes)) == set(range(256))


class TestRTL:
    verilog = False
    many = LANES

    @pytest.mark.parametrize("on", (True, False))
    def test_answers_are_comparisons(self, on):
        """A sampled pixel keeps its value until the next hold, whatever the address is; when off, `analog` passes."""
        for lanes in self.many:
            self.check(build(Pattern(lanes), self.verilog, f"Pattern_{lanes}"), lanes, on)

    def check(self, sim, lanes, on):
        rng = np.random.default_rng(lanes)
        sim.on @= on
        held = np.zeros(lanes, int)
        for cycle in range(300):
            if cycle % 100 == 50:
                sim.hold @= 0
                sim.sim_reset()
                held[:] = 0
            group, k, sub, hold = (int(rng.integers(n)) for n in (256 // lanes, 6, 4, 2))
            row, analog = cycle % 256, rng.integers(0, 2, lanes)
            dac = (held + rng.integers(-1, 2, lanes)) % 256 if cycle % 2 else rng.integers(0, 256, lanes)
            sim.row @= row
            sim.group @= group
            sim.k @= k
            sim.sub @= sub
            sim.hold @= hold
            sim.dac @= int.from_bytes(dac.astype(np.uint8).tobytes(), "little")
            sim.analog @= int(sum(int(b) << i for i, b in enumerate(analog)))
            sim.sim_eval_combinational()
            want = held >= dac if on else analog
            assert [int(sim.comparator) >> i & 1 for i in range(lanes)] == want.astype(int).tolist()
            sim.sim_tick()
            if hold:
                held = pattern_value(row, group * lanes + np.arange(lanes), k, sub)


class TestVerilog(TestRTL):
    verilog = True
    many = (8,)


class TestIcarus(TestVerilog):
    verilog = "icarus"
