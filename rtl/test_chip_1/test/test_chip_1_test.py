"""TestChip1 at every level: transfers, boot, the channel, and memory under the load of all four requesters."""

import random
from itertools import cycle

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.rtl.proc.assembler import assemble
from talbot.rtl.proc.golden import Receive
from talbot.rtl.proc.isa import signed
from talbot.rtl.proc.test.programs import ITEMS, NEAR, program
from talbot.rtl.test_chip_1 import TestChip1, TestChip1FL
from talbot.rtl.test_chip_1.golden import (
    CHANNEL,
    CONTROL,
    HALTED,
    PROC_WAITS,
    RUNS,
    WRITE,
    GoldenChip,
    bytes_of,
    header,
    words_of,
)
from talbot.rtl.test_chip_1.test.chip_bench import ALWAYS, SMALL, Host

SETTINGS = settings(
    max_examples=8, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.differing_executors]
)
STALLS = st.lists(st.booleans(), min_size=1, max_size=9).map(lambda stalls: (*stalls, True))
BYTES = 32 * SMALL
# Half of the items access memory; a program is below 0x200, its data repeat from there on
PROGRAMS = st.lists(st.sampled_from((ITEMS, NEAR)).flatmap(lambda kind: kind), max_size=20).map(program)


class TestFL:
    cls, verilog = TestChip1FL, False
    words = BYTES // 4  # of the memory, written and read

    def host(self, willing=ALWAYS):
        return Host(type(self).cls, self.verilog, willing)

    @SETTINGS
    @given(st.lists(st.integers(0, 2**32 - 1), min_size=1, max_size=9), st.integers(0, BYTES // 4 - 9), STALLS)
    def test_memory(self, words, place, willing):
        host, size = self.host(willing), self.words
        place %= size - 9
        host.write(0, bytes(4 * size))
        host.write(4 * place, bytes_of(words))
        assert host.read(0, size) == [0] * place + words + [0] * (size - place - len(words))
        assert host.status() == 0

    def test_nothing_to_transfer(self):
        host = self.host()
        host.write(8, b"\1\2\3\4")
        host.write(8, b"")
        assert host.read(8, 0) == [] and host.read(8, 1) == [0x04030201]

    def test_boot_and_stop(self):
        """A program runs from 0, is stopped and started again, and the memory stays."""
        host = self.host()
        host.write(0, assemble("lw x5, 0x40(x0)\naddi x5, x5, 1\nsw x5, 0x40(x0)\nebreak"))
        host.write(0x40, b"\0\0\0\0")
        for count in (1, 2, 3):
            host.run()
            assert host.status() == RUNS | HALTED and host.read(0x40, 1) == [count]
            host.control(False)
            assert host.status() == 0

    def test_the_channel(self):
        host = self.host()
        host.write(0, assemble("l: csrr x5, 0xfc0\nadd x6, x6, x5\ncsrw 0x7c0, x6\nj l"))
        host.control(True)
        for word, total in ((7, 7), (0xFFFFFFFF, 6), (2**31, 2**31 + 6)):
            for _ in range(20):
                host.tick()
            assert host.status() == RUNS | PROC_WAITS
            host.send(word)
            assert host.receive() == [total]
        host.control(False)
        assert host.status() == 0

    @pytest.mark.parametrize("length", (0, 1, 2, 7, 20))
    def test_sorts_while_processor_and_host_use_the_memory(self, length):
        """The processor writes and checks other words as the sorter works, and the host reads."""
        host, rng = self.host(), random.Random(length)
        words = [rng.getrandbits(32) for _ in range(length)]
        text = f"""li t0, 0x8000\nli t1, {length}\nslli t1, t1, 16\naddi t1, t1, 0x80\nsw t1, 0(t0)
        li a0, 0x180\nli a1, 0x1c0\nli a2, 5
        l: sw a2, 0(a0)\nlbu a3, 0(a0)\nsub a2, a2, a3\nxor a4, a4, a2\naddi a2, a3, 3\naddi a0, a0, 4\nbne a0, a1, l
        lw a5, 0(t0)\nsw a4, 0x1c0(x0)\nsw a5, 0x1c4(x0)\nebreak"""
        host.write(0, assemble(text))
        host.write(0x200, bytes_of(words))
        host.control(True)
        for _ in range(4):
            host.read(0, 3)
        while host.status() != RUNS | HALTED:
            pass
        assert host.read(0x200, length) == sorted(words, key=signed)
        assert host.read(0x1C0, 2) == [0, length]
        assert host.read(0x180, 16) == [5 + 3 * n for n in range(16)]

    def test_a_stop_while_the_sorter_works(self):
        """Words are lost, but the chip is as after a reset."""
        host = self.host()
        host.write(0, assemble("li t0, 0x8000\nli t1, 0x200080\nsw t1, 0(t0)\ncsrr x5, 0xfc0"))
        for wait in range(20, 60, 7):
            host.control(True)
            for _ in range(wait):
                host.tick()
            host.control(False)
        self.test_sorts_while_processor_and_host_use_the_memory(7)


class TestRTL(TestFL):
    cls = TestChip1
    words = 24


class TestVerilog(TestRTL):
    verilog, words = True, TestFL.words

    @settings(SETTINGS, max_examples=15)
    @given(PROGRAMS, st.lists(st.integers(0, 2**32 - 1), min_size=1, max_size=5), STALLS, st.integers(0, 30))
    def test_random_programs(self, code, words, willing, wait):
        """Accesses of every size, as the host reads the program and answers it; the memory is the golden chip's."""
        host, golden, words = self.host(willing), GoldenChip(BYTES // 4), cycle(words)
        code += bytes(-len(code) % 4)
        load = header(WRITE, BYTES // 4) + code + random.Random(wait).randbytes(BYTES - len(code))
        for send in host.transfer, golden.host:
            send(load)
            send(header(CONTROL | WRITE, 1) + bytes_of([1]))
        while golden.request:
            assert host.read(0, 2) == words_of(code)[:2]
            for _ in range(wait):
                host.tick()
            if isinstance(golden.request, Receive):
                host.send(word := next(words))
                golden.host(header(CHANNEL | WRITE, 1) + bytes_of([word]))
            else:
                assert host.receive() == words_of(golden.host(header(CHANNEL, 1)))
        for _ in range(5000):
            if host.sim.halted:
                break
            host.tick()
        assert host.status() == golden.read(CONTROL)
        assert host.read(0, BYTES // 4) == words_of(golden.host(header(0, BYTES // 4)))

    @pytest.mark.parametrize("count", (255, 256, 257, 1030))
    def test_long_transfers(self, count):
        """All bits of the number of words count; addresses repeat."""
        host, words = self.host(), [random.Random(count).getrandbits(32) for _ in range(count)]
        memory = {n % (BYTES // 4): word for n, word in enumerate(words)}
        host.write(0, bytes_of(words))
        assert host.read(0, count) == [memory[n % (BYTES // 4)] for n in range(count)]
