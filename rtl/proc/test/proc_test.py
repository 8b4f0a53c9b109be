"""Proc at every level: programs against the golden simulator, under any latencies and stalls; cycles."""

from itertools import product

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from talbot.rtl.harness.reset import outputs_after_reset
from talbot.rtl.proc import Proc, ProcCL, ProcFL
from talbot.rtl.proc.assembler import assemble
from talbot.rtl.proc.golden import run
from talbot.rtl.proc.isa import BRANCHES, IMMEDIATE, LOADS, MASK, REGISTER, SHIFTS, STORES
from talbot.rtl.proc.test.proc_bench import ALWAYS, Bench, simulator
from talbot.rtl.proc.test.programs import PROGRAMS, WILD_PROGRAMS

SETTINGS = settings(
    max_examples=12,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.differing_executors, HealthCheck.filter_too_much],
)
STALLS = st.lists(st.booleans(), min_size=1, max_size=23).map(lambda stalls: (*stalls, True))
LATENCIES = st.lists(st.integers(1, 5), min_size=1, max_size=7)
WORDS = st.lists(st.integers(0, 2**32 - 1), min_size=1, max_size=8)
CORNERS = 0, 1, 0xFFFFFFFF, 0x7FFFFFFF, 0x80000000, 0x12345678, 0xFFFFFFE1
STORED = "".join(f"sw x{n}, {0x600 + 4 * n}(x0)\n" for n in range(32)) + "ebreak\n"

FAULTS = (
    *(".word 0", ".word 0xffffffff", ".word 0x73", ".word 0x100f", "lw x5, 2(x6)", "lh x5, 1(x6)", "sh x5, 3(x6)"),
    *("sw x5, 1(x6)", "jal x5, 6", "jalr x5, 2(x6)", "beq x0, x0, 10", ".word 0xc0002573", ".word 0xf14312f3"),
    *(".word 0x02c585b3", ".word 0x40001013", ".word 0x7c0012f3", ".word 0x00003003", ".word 0x00002063"),
)


class TestFL:
    cls, verilog = ProcFL, False

    def bench(self, hart_id=0):
        return Bench(type(self).cls, self.verilog, hart_id)

    def check(self, program, words=(), willing=ALWAYS, latencies=(1,), hart_id=0x9E3779B9):
        """Compare a program's accesses, words to the manager and memory with the golden run; returns the bench."""
        golden = run(program, words, hart_id, limit=5000)
        if not golden.stopped:
            assume(False)  # a program of test_random_...
        bench = self.bench(hart_id)
        assert bench.run(program, words, willing, latencies)
        assert bench.accesses == golden.accesses and bench.sent == golden.sent and bench.memory == golden.memory
        return bench

    def of(self, text, words=(), **how):
        return self.check(assemble(text), words, **how)

    @SETTINGS
    @given(PROGRAMS, WORDS, STALLS, LATENCIES, st.integers(0, MASK))
    def test_random_programs(self, program, words, willing, latencies, hart_id):
        self.check(program, words * 40, willing, latencies, hart_id)

    @SETTINGS
    @given(WILD_PROGRAMS, WORDS, STALLS, LATENCIES)
    def test_random_words_and_misaligned_addresses(self, program, words, willing, latencies):
        self.check(program, words * 40, willing, latencies)

    @SETTINGS
    @given(PROGRAMS, WORDS)
    def test_random_programs_without_stalls(self, program, words):
        self.check(program, words * 40)

    @pytest.mark.parametrize("name", [*REGISTER, *IMMEDIATE, *SHIFTS])
    def test_results_of_corners(self, name):
        text, at = "", 0
        seconds = CORNERS if name in REGISTER else (0, 1, 31) if name in SHIFTS else (0, 1, -1, 2047, -2048)
        for a, b in product(CORNERS, seconds):
            text += f"li x5, {a}\n" + (f"li x6, {b}\n" if name in REGISTER else "")
            text += f"{name} x7, x5, {'x6' if name in REGISTER else b}\nsw x7, {0x400 + 4 * at}(x0)\n"
            at += 1
        self.of(f"j start\n.zero {0x600}\nstart: {text} ebreak")

    def test_branches_of_corners(self):
        for name in BRANCHES:
            text = "".join(
                f"li x5, {a}\nli x6, {b}\naddi x7, x7, 1\n{name} x5, x6, l{n}\naddi x8, x8, 1\nl{n}: sub x9, x7, x8\n"
                for n, (a, b) in enumerate(product(CORNERS[:5], CORNERS[:5]))
            )
            self.of(f"j start\n.zero {0x700}\nstart: {text}{STORED}")

    def test_every_size_at_every_address(self):
        text = "li x5, 0x8badf00d\nli x6, 0x7fee8081\nsw x5, 0x400(x0)\nsw x6, 0x404(x0)\n"
        for name, offset in product(STORES, range(4)):
            if offset % (1 << STORES[name]) == 0:
                text += f"sw x0, 0x408(x0)\n{name} x5, {0x408 + offset}(x0)\nlw x7, 0x408(x0)\ncsrw 0x7c0, x7\n"
        for name, offset in product(LOADS, range(8)):
            if offset % (1 << (LOADS[name] & 3)) == 0:
                text += f"{name} x7, {0x400 + offset}(x0)\ncsrw 0x7c0, x7\n"
        assert len(self.of(text + "ebreak").sent) == 7 + 8 * 2 + 4 * 2 + 2

    @pytest.mark.parametrize("distance", range(4))
    def test_an_operand_from_any_stage(self, distance):
        """Every kind of producer, `distance` instructions ahead of every kind of consumer, and of other registers."""
        producers = "add x5, x6, x7", "addi x5, x6, 12", "lui x5, 0x80001", "lw x5, 0x700(x0)", "csrr x5, 0xfc0"
        producers += "auipc x5, 1", "jal x5, 4", "csrr x5, 0xf14", "lbu x5, 0x701(x0)"
        consumers = "add x8, x5, x6", "sub x8, x6, x5", "andi x8, x5, -2", "sw x5, 0x704(x0)", "csrw 0x7c0, x5"
        consumers += ("beq x5, x6, 8",)
        text = "li x6, 0x1230\nli x7, 0x770\nsw x7, 0x700(x0)\n"
        others = [f"add x8, x{5 ^ 1 << bit}, x{5 ^ 1 << bit}" for bit in range(5)]
        for producer, consumer in [*product(producers, consumers), *product(producers[::3], others)]:
            text += f"{producer}\n{'addi x9, x9, 1' + chr(10) if distance else ''}" + "nop\n" * (distance - 1)
            text += f"{consumer}\nadd x10, x10, x8\n"
        self.of(f"j start\n.zero 0x800\nstart: {text}{STORED}", words=[0x1230, 7] * 9)
        self.of("lw x5, 0x40(x0)\nlw x6, 0x40(x5)\nsw x6, 0x48(x5)\nebreak")

    def test_x0_is_zero(self):
        self.of("addi x0, x0, 5\nlw x0, 0(x0)\ncsrr x0, 0xfc0\njal x0, 4\nadd x5, x0, x0\n" + STORED, words=[9])

    @pytest.mark.parametrize("fault", FAULTS)
    def test_stops(self, fault):
        """Nothing of the instruction or after it takes effect, all before it does."""
        around = "li x5, 77\nli x6, 0x700\nsw x5, 0(x6)\n"
        bench = self.of(f"{around}{fault}\nsw x6, 4(x6)\ncsrw 0x7c0, x6\nebreak\n", latencies=(3,))
        assert len(bench.accesses) == 1 and not bench.sent

    def test_branches_that_are_not_taken_do_not_fault(self):
        assert self.of("bne x0, x0, 10\njalr x5, 13(x0)\n.word 0\ncsrw 0x7c0, x5\nebreak").sent == [8]

    def test_words_from_and_to_the_manager(self):
        text = "li x7, 12\nloop: csrr x5, 0xfc0\nslli x6, x5, 1\ncsrw 0x7c0, x6\naddi x7, x7, -1\nbnez x7, loop\nebreak"
        for willing in (ALWAYS, (True, False, False), (False, True, True, False, False, False, True)):
            assert self.of(text, range(12), willing=willing).sent == [2 * n for n in range(12)]

    def test_a_reset_at_any_time(self):
        program = assemble("li x5, 5\nsw x5, 0x40(x0)\nl: lw x6, 0x40(x0)\ncsrw 0x7c0, x6\ncsrr x7, 0xfc0\nj l")
        for cycles in (1, 2, 3, 5, 7, 8, 9, 11, 13, 18):
            for latencies in ((1,), (4, 2)):
                assert not self.bench().run(program, [1, 2, 3], latencies=latencies, limit=cycles)
                self.of("addi x5, x5, 3\n" + STORED)

    def test_stopped_until_reset(self):
        bench = self.bench()
        bench.run(assemble("li x5, 1\nebreak\nsw x5, 0x40(x0)\n"))
        for name in ("imem_req", "dmem_req", "to_manager"):
            getattr(bench.sim, name).rdy @= 1
        for _ in range(9):
            bench.sim.sim_tick()
            assert bench.sim.halted and not bench.sim.dmem_req.val and not bench.sim.to_manager.val

    def test_a_path_that_a_request_waits_on(self):
        """A branch while the next instruction's request is not accepted: it stays, and its word is dropped."""
        text = "li x5, 3\nl: addi x6, x6, 1\naddi x5, x5, -1\nbnez x5, l\nadd x7, x6, x6\nsw x7, 0x40(x0)\nebreak"
        for length in (2, 3, 5, 8):
            self.of(text, willing=[True, *[False] * length])
            self.of(text, willing=[False, *[True] * length], latencies=(1, length))


class TestCL(TestFL):
    cls = ProcCL

    @SETTINGS
    @given(PROGRAMS | WILD_PROGRAMS, WORDS, STALLS, LATENCIES)
    def test_equals_the_cycle_level_in_every_cycle(self, program, words, willing, latencies):
        benches = [self.bench(3), Bench(ProcCL, False, 3)]
        for bench in benches:
            bench.run(program, words * 40, willing, latencies, limit=600)
        assert benches[0].log == benches[1].log

    @pytest.mark.parametrize("fault", FAULTS)
    def test_requests_of_the_cycle_of_a_stop(self, fault):
        """No request is for an address that the stopping instruction computes, data and jumps that it refuses."""
        program = assemble(f"li x5, 77\nli x6, 0x700\n{fault}\nnop\nebreak\n")
        benches = [self.bench(), Bench(ProcCL, False)]
        assert all(bench.run(program) for bench in benches) and benches[0].log == benches[1].log
        requests = {messages[0] for messages, _, _ in benches[0].log if messages[0]}
        assert max(int(address, 16) for address in requests) <= len(program)

    @pytest.mark.parametrize(
        "text, cycles",
        [
            ("nop\n" * 40, 40),  # an instruction a cycle
            ("lw x5, 0x700(x0)\n" * 40, 40),
            ("sw x6, 0x700(x0)\nlw x5, 0x700(x0)\n" * 20, 40),
            ("add x5, x5, x6\n" * 40, 40),
            ("lw x5, 0x700(x0)\nadd x6, x6, x5\n" * 20, 60),  # a cycle between a load and its use
            ("jal x5, 4\n" * 40, 120),  # three cycles a jump or taken branch
            ("beq x0, x0, 4\n" * 40, 120),
            ("bne x0, x0, 4\n" * 40, 40),
        ],
    )
    def test_cycles(self, text, cycles):
        empty, bench = self.bench(), self.bench()
        empty.run(assemble("ebreak"))
        assert bench.run(assemble(text + "ebreak")) and bench.cycles - empty.cycles == cycles


class TestRTL(TestCL):
    cls = Proc

    def test_outputs_after_a_reset(self):
        golden = outputs_after_reset(simulator(ProcCL, False), before=0)
        assert outputs_after_reset(simulator(self.cls, self.verilog)) == golden

    @SETTINGS
    @given(PROGRAMS, STALLS)
    def test_offers_stay(self, program, willing):
        """A stream that offers a message keeps it until it is taken."""
        bench = self.bench()
        waits = {}
        record = bench.record

        def recorded():
            record()
            for name in ("imem_req", "dmem_req", "to_manager"):
                stream = getattr(bench.sim, name)
                if name in waits:
                    assert stream.val and stream.msg == waits.pop(name)
                if stream.val and not stream.rdy:
                    waits[name] = stream.msg.clone()

        bench.record = recorded
        bench.run(program, range(400), willing, limit=400)


class TestVerilog(TestRTL):
    verilog = True


class TestIcarus(TestRTL):
    verilog = "icarus"
