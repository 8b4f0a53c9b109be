"""Packers at RTL and Verilog equal the encoders of the format comparison."""

from functools import cache

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.flow.formats.tokens import FORMATS
from talbot.models.digital.stream import encode_payload
from talbot.models.digital.stream.payload import base_of
from talbot.rtl.harness.testbench import build
from talbot.rtl.run_length import candidates

PACKERS = {name: getattr(candidates, packer) for name, (_, packer) in FORMATS.items()}
CODES = st.lists(st.one_of(st.just(0), st.just(0), st.integers(-128, 127), st.integers(-9, 9)), max_size=60)
BURSTS = st.lists(st.booleans(), min_size=1, max_size=8).filter(any)


@cache
def simulator(name, verilog):
    return build(PACKERS[name](), verilog, PACKERS[name].__name__)


def packed(name, verilog, codes, coded, threshold, bursts):
    """The bytes of one row, taken in the cycles that ``bursts`` names."""
    sim, sent, ended, out, cycle = simulator(name, verilog), 0, False, bytearray(), 0
    sim.reset @= 1
    sim.sim_tick()
    sim.reset @= 0
    sim.coded @= coded
    sim.threshold @= threshold
    while not ended or sim.val:
        sim.rdy @= bursts[cycle % len(bursts)]
        sim.restart @= cycle == 0
        sim.push @= 0
        sim.flush @= 0
        sim.code @= codes[sent] & 0xFF if sent < len(codes) else 0
        sim.sim_eval_combinational()
        if sim.val and sim.rdy:
            out.append(int(sim.octet))
        if cycle and sim.ready and not ended:
            sim.push @= sent < len(codes)
            sim.flush @= sent == len(codes)
            ended = sent == len(codes)
            sent += not ended
        sim.sim_tick()
        sim.push @= 0
        sim.flush @= 0
        sim.sim_eval_combinational()
        cycle += 1
        assert cycle < 5000
    return bytes(out)


def check(name, verilog, codes, threshold, bursts):
    encode, out = FORMATS[name][0], np.zeros(4 * len(codes) + 8, np.uint8)
    size = encode(np.array(codes, np.int16), base_of(threshold), out)
    assert packed(name, verilog, codes, True, threshold, bursts) == out[:size].tobytes()
    plain = [code & 0xFF for code in codes]
    assert packed(name, verilog, plain, False, threshold, bursts) == encode_payload(plain, False, threshold)


@pytest.mark.parametrize("name", FORMATS)
class TestPackerRTL:
    verilog = False

    @settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.differing_executors])
    @given(codes=CODES, threshold=st.integers(0, 40), bursts=BURSTS)
    def test_bytes_of_any_row(self, name, codes, threshold, bursts):
        check(name, self.verilog, codes, threshold, bursts)

    def test_long_runs(self, name):
        check(name, self.verilog, [0] * 700 + [5] + [0] * 255 + [-128] + [0] * 15 + [127], 0, [True])
