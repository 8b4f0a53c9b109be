"""The sorter alone: words of any length under any latencies and stalls; cycles."""

from collections import deque
from functools import cache
from itertools import cycle, product

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.rtl.harness.testbench import build
from talbot.rtl.proc.golden import Memory
from talbot.rtl.proc.isa import signed
from talbot.rtl.test_chip_1 import Sorter
from talbot.rtl.test_chip_1.ports import SortReq

SETTINGS = settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.differing_executors]
)
WORDS = st.lists(st.integers(0, 2**32 - 1) | st.sampled_from((0, 1, 2**31 - 1, 2**31, 2**32 - 1)), max_size=21)
STALLS = st.lists(st.booleans(), min_size=1, max_size=13).map(lambda stalls: (*stalls, True))
LATENCIES = st.lists(st.integers(1, 4), min_size=1, max_size=5)
ALWAYS = (True,)


@cache
def simulator(verilog):
    return build(Sorter(), verilog)


def sort(sim, words, address=5, willing=ALWAYS, latencies=(1,), limit=20_000):
    """Sort ``words`` at word ``address``; returns them, and the cycles from the request to the response."""
    memory = Memory({4 * (address + n): word for n, word in enumerate(words)})
    accepts, takes = cycle(willing), cycle(reversed(willing))
    latencies, waiting, begun = cycle(latencies), deque(), None
    sim.req.val @= 1
    sim.req.msg @= SortReq(len(words), address)
    for now in range(limit):
        sim.mem_req.rdy @= next(accepts)
        sim.mem_resp.val @= bool(waiting) and waiting[0][0] <= now
        sim.mem_resp.msg @= waiting[0][1] if waiting else 0xDEADBEEF
        sim.resp.rdy @= next(takes)
        sim.sim_eval_combinational()
        if sim.mem_resp.val & sim.mem_resp.rdy:
            waiting.popleft()
        if sim.mem_req.val & sim.mem_req.rdy:
            message = sim.mem_req.msg
            assert 4 * address <= int(message.address) < 4 * (address + 2 * len(words))
            word = memory.access(int(message.strobe), int(message.address), int(message.data))
            waiting.append((now + next(latencies), 0x5EED5EED if message.strobe else word))
        done, taken = bool(sim.resp.val & sim.resp.rdy), bool(sim.req.val & sim.req.rdy)
        sim.sim_tick()
        if done:
            assert int(sim.resp.msg) == len(words) and not waiting
            return [memory.words[4 * (address + n)] for n in range(len(words))], now - begun
        if taken:
            begun = now
            sim.req.val @= 0
    raise AssertionError("no response")


class TestRTL:
    verilog = False

    def sorted(self, words, **how):
        words_out, cycles = sort(simulator(self.verilog), words, **how)
        assert words_out == sorted(words, key=signed)
        return cycles

    @SETTINGS
    @given(WORDS, STALLS, LATENCIES)
    def test_any_words(self, words, willing, latencies):
        self.sorted(words, willing=willing, latencies=latencies)

    @pytest.mark.parametrize("length", range(18))
    def test_every_length(self, length):
        self.sorted([(0x9E3779B9 * n + 0x80000000) % 2**32 for n in range(length)])

    @pytest.mark.parametrize("length", [2, 3, 4])
    def test_every_order_of_few_words(self, length):
        for words in product((1, 2, 2**32 - 1, 2**31)[:length], repeat=length):
            self.sorted([*words])

    def test_equal_words_and_words_in_order(self):
        for words in ([7] * 9, list(range(16)), list(range(16, 0, -1)), [2**31, 2**31 - 1] * 8):
            self.sorted(words, address=100)

    def test_the_longest_at_the_end_of_the_memory(self):
        self.sorted([(2654435761 * n) % 2**32 for n in range(200)], address=4096 - 400)

    def test_a_reset_at_any_time(self):
        sim = simulator(self.verilog)
        for cycles in range(1, 40, 3):
            sim.req.val @= 1
            sim.req.msg @= SortReq(5, 0)
            sim.mem_req.rdy @= 1
            sim.mem_resp.val @= 1
            for _ in range(cycles):
                sim.sim_tick()
            sim.reset @= 1
            sim.sim_tick()
            sim.reset @= 0
            self.sorted([3, 1, 2])

    @pytest.mark.parametrize("length, cycles", [(0, 2), (1, 2), (2, 22), (3, 31), (4, 37), (16, 243)])
    def test_cycles(self, length, cycles):
        """Three a word and pass, and three a pair of runs, do not depend on the order of the words."""
        assert self.sorted([*range(length)]) == self.sorted([*range(length, 0, -1)]) == cycles


class TestVerilog(TestRTL):
    verilog = True

    def test_runs_of_more_than_half_the_memory(self):
        self.sorted([(2654435761 * n) % 2**32 for n in range(1025)], address=0, limit=50_000)


class TestIcarus(TestRTL):
    verilog = "icarus"
