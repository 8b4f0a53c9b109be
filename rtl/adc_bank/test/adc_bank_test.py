"""AdcBank at every level, with the analog front end at its pins: steps in, the golden model's codes out, in order."""

import contextlib
import random
from functools import cache
from itertools import combinations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pymtl3 import Bits3, Bits7, Component, InPort, OutPort, connect
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.models.afe import Converter, FrontEnd
from talbot.models.digital.scan import Scan
from talbot.models.parameters import MODES, ConverterParameters, FrameParameters, Window
from talbot.rtl.adc_bank import AdcBank, AdcBankCL, AdcBankFL
from talbot.rtl.adc_bank.test.afe_fl import AfeFL
from talbot.rtl.harness.reset import outputs_after_reset
from talbot.rtl.harness.testbench import build
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE, ScanMsg, step_msg

ROWS, COLS, LANES = 3, 104, 8  # three groups, the last one partial
WIDE = 6 * 32  # columns of one group of the most lanes
RNG = np.random.default_rng(5)
SAMPLES = RNG.uniform(0, 127.5, (4, ROWS, WIDE, 2))
SAMPLES[:, 0, :, 1] = SAMPLES[:, 0, :, 0] + RNG.choice((-1, 1), (4, WIDE)) * RNG.uniform(15, 90, (4, WIDE))  # no zeros
SAMPLES[:, 1, :, 1] = SAMPLES[:, 1, :, 0]  # zeros
SAMPLES[:, 2, :, 1] = SAMPLES[:, 2, :, 0] + RNG.normal(0, 3, (4, WIDE))  # around the window

SETTINGS = settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.differing_executors])
ALWAYS = [(True, True)]
patterns = st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=40).filter(
    lambda p: any(v for v, _ in p) and any(r for _, r in p)
)


def front_end(lanes, rough=True):
    imperfect = ConverterParameters(inl=1, dnl=0.3, offset=1, noise=0.7, ktc=0.5, seed=4)
    return FrontEnd(4.0, (0,) * 24, lanes, Converter.draw(imperfect, lanes) if rough else None)


class Harness(Component):
    """The bank with the front end at its pins; its streams and settings are ports."""

    def construct(s, dut, lanes, rough):
        s.step = RecvIfcRTL(step_msg(lanes))
        s.scan = SendIfcRTL(ScanMsg)
        s.mode, s.threshold = InPort(Bits3), InPort(Bits7)
        s.hold, s.wake, s.idle = OutPort(), OutPort(), OutPort()

        s.dut = dut
        s.afe = AfeFL(front_end(lanes, rough), SAMPLES)

        connect(s.step, s.dut.step)
        connect(s.dut.scan, s.scan)
        for name in ("mode", "threshold", "hold", "wake", "idle"):
            connect(getattr(s, name), getattr(s.dut, name))
        connect(s.mode[0:2], s.afe.mode)
        for name in ("row", "group", "k", "sub", "en", "dac", "hold", "unsigned_", "comparator"):
            connect(getattr(s.dut, name), getattr(s.afe, name))

    def line_trace(s):
        return f"{s.dut.line_trace()} {s.afe.line_trace()}"


@cache
def simulator(cls, verilog, lanes=LANES, rough=True):
    return build(Harness(cls(lanes), lanes, rough), verilog, f"AdcBank{lanes}")


class Run:
    """A run of a bank with a list of StepMsg: messages with their cycles; hold, wake, idle in every cycle; counters.

    counted: made and left_out at its begin, of the RTL in PyMTL.
    """

    def __init__(self, sim, steps, mode, threshold, pattern=ALWAYS, limit=None, counted=()):
        sim.mode @= MODES.index(mode)
        sim.threshold @= threshold
        sim.step.val @= 0
        sim.scan.rdy @= 0
        sim.reset @= 1
        sim.sim_tick()
        sim.reset @= 0
        for register, value in zip((sim.dut.made, sim.dut.left_out), counted):
            register @= value
            register <<= value
        self.messages, self.sent_at, self.hold, self.idle, self.counts = [], [], [], [], []
        self.wake = []
        self.held = []  # row, group, k, sub, en at each hold
        limit = limit or (len(steps) + 4) * (20 + 2 * sim.dut.en.nbits * len(pattern))  # far more than it takes
        steps, cycle, ends = list(steps), 0, sum(int(m.kind) == END for m in steps)
        while ends > len(self.counts) or steps or self.idle[-1:] != [True]:
            offer, ready = pattern[cycle % len(pattern)]
            sim.step.val @= bool(steps) and offer
            if steps:
                sim.step.msg @= steps[0]
            sim.scan.rdy @= ready
            sim.sim_eval_combinational()
            if steps and offer and sim.step.rdy:
                steps.pop(0)
            self.hold.append(bool(sim.hold))
            self.wake.append(bool(sim.wake))
            if sim.hold:
                self.held.append(tuple(int(getattr(sim.dut, name)) for name in ("row", "group", "k", "sub", "en")))
            self.idle.append(bool(sim.idle))
            if sim.scan.val and ready:
                self.messages.append((int(sim.scan.msg.kind), int(sim.scan.msg.data)))
                self.sent_at.append(cycle)
                if sim.scan.msg.kind == END:
                    self.counts.append((int(sim.dut.made), int(sim.dut.left_out)))
            sim.sim_tick()
            cycle += 1
            assert cycle < limit


def steps_of(scan):
    """StepMsg of a frame."""
    Step = step_msg(scan.lanes)
    out = [Step(FRAME, 0, 0, 0, 0, 0)]
    for row in scan.row_list.tolist():
        out.append(Step(ROW, row, 0, 0, 0, 0))
        out += [Step(SAMPLE, row, x.group, x.k, x.sub, x.enable) for x in scan.steps(row)]
    return out + [Step(END, 0, 0, 0, 0, 0)]


def expected(steps, lanes, mode, threshold, rough=True):
    """Messages, and (made, left out) of every END, of a list of StepMsg by the golden model."""
    golden = front_end(lanes, rough).convert(SAMPLES, mode, threshold)
    messages, counts = [], []
    for step in steps:
        if step.kind != SAMPLE:
            messages.append((int(step.kind), int(step.row)))
            if step.kind == FRAME:
                counts.append([0, 0])
            continue
        enabled = [lane for lane in range(lanes) if step.en[lane]]
        for lane in enabled:
            at = int(step.sub), int(step.row), 6 * (lanes * int(step.group) + lane) + int(step.k)
            messages.append((SAMPLE, (lane == enabled[-1]) << 9 | int(golden.codes[at]) & 0xFF))
            counts[-1][0 if golden.converted[at] else 1] += 1
    return messages, [tuple(c) for c in counts]


def frame(rows, cols, lanes, mode, **kw):
    return Scan(rows, cols, lanes, FrameParameters(Window(0, -(-rows // 4) - 1, 0, -(-cols // 6) - 1), mode=mode, **kw))


def lane_sets(lanes):
    """Any lanes enabled: none, one, all but one, neighbours and all more often than at random."""
    one = st.integers(0, lanes - 1).map(lambda lane: 1 << lane)
    every = (1 << lanes) - 1
    few = st.sampled_from([0, every, every >> 1, every & ~1])
    return st.one_of(
        st.integers(0, every), one, one.map(lambda bit: every ^ bit), one.map(lambda bit: every & 3 * bit), few
    )


@st.composite
def step_lists(draw, lanes=LANES):
    """Two frames of any steps."""
    Step = step_msg(lanes)
    groups = st.integers(0, lanes < 32)  # inside WIDE columns
    out = []
    for _ in range(2):
        out.append(Step(FRAME, 0, 0, 0, 0, 0))
        for row in draw(st.lists(st.integers(0, ROWS - 1), max_size=2)):
            out.append(Step(ROW, row, 0, 0, 0, 0))
            out += [
                Step(SAMPLE, row, draw(groups), draw(st.integers(0, 5)), 0, draw(lane_sets(lanes)))
                for _ in range(draw(st.integers(0, 6)))
            ]
        out.append(Step(END, 0, 0, 0, 0, 0))
    return out


class TestAdcBankFL:
    """Inherited by every level; a level overrides ``cls`` and ``verilog``."""

    cls, verilog = AdcBankFL, False

    def run(self, *args, lanes=LANES, rough=True):
        return Run(simulator(self.cls, self.verilog, lanes, rough), *args)

    def check(self, steps, mode, threshold, pattern=ALWAYS, lanes=LANES):
        got = self.run(steps, mode, threshold, pattern, lanes=lanes)
        assert (got.messages, got.counts) == expected(steps, lanes, mode, threshold)
        assert got.hold == [False, *got.wake[:-1]]  # a cycle ahead

    @pytest.mark.parametrize("mode", MODES)
    def test_a_frame_of_every_mode(self, mode):
        self.check(steps_of(frame(ROWS, COLS, LANES, mode, mask=0x00431001)), mode, 10)

    @SETTINGS
    @given(step_lists(), st.integers(0, 127), patterns)
    def test_any_steps_and_any_timing(self, steps, threshold, pattern):
        self.check(steps, "edge", threshold, pattern)
        self.check(steps, "ternary", threshold, pattern)

    @SETTINGS
    @given(step_lists(), patterns)
    def test_is_not_idle_while_it_converts(self, steps, pattern):
        """From the hold to the last decision (two for the zeros of row 1, ten at most) `idle` is low."""
        got = self.run(steps, "edge", 10, pattern)
        enabled = [bool(step.en) for step in steps if step.kind == SAMPLE]
        holds = np.flatnonzero(got.hold)
        assert len(holds) == len(enabled)
        for at, some in zip(holds, enabled):
            assert not any(got.idle[at : at + (3 if some else 1)])
        assert got.idle[-1]

    def test_all_bits_of_the_address(self):
        """Row, group, k and sub are at the pins unchanged; without a lane nothing is sampled there."""
        Step = step_msg(LANES)
        values = 0x3FF, 0, 0x155, 0x2AA
        steps = [Step(FRAME, 0, 0, 0, 0, 0)]
        for value in values:
            steps += [Step(ROW, value, 0, 0, 0, 0), Step(SAMPLE, value, value & 0xFF, value & 7, value & 3, 0)]
        got = self.run([*steps, Step(END, 0, 0, 0, 0, 0)], "edge", 10)
        assert got.messages == [(FRAME, 0), *((ROW, value) for value in values), (END, 0)]
        assert got.held == [(value, value & 0xFF, value & 7, value & 3, 0) for value in values]

    @pytest.mark.parametrize("row", (0, 1))
    def test_one_lane_alone(self, row):
        """The result of the only lane is sent when it is ready, and not before; until then `idle` is low."""
        Step = step_msg(LANES)
        steps = [Step(SAMPLE, row, 0, 2, 0, 1 << lane) for lane in range(LANES)]
        steps = [Step(FRAME, 0, 0, 0, 0, 0), *steps, Step(END, 0, 0, 0, 0, 0)]
        got = self.run(steps, "edge", 10)
        assert (got.messages, got.counts) == expected(steps, LANES, "edge", 10)
        assert not any(any(got.idle[at : at + 3]) for at in np.flatnonzero(got.hold))

    def test_pins_after_reset(self):
        self.test_all_bits_of_the_address()
        sim = simulator(self.cls, self.verilog)
        sim.sim_reset()
        assert not any(
            int(getattr(sim.dut, name)) for name in ("row", "group", "k", "sub", "en", "hold", "made", "left_out")
        )
        assert sim.idle and not sim.scan.val

    def test_reset_at_any_moment(self):
        """A reset drops the steps, conversions and results in progress."""
        Step = step_msg(LANES)
        steps = [Step(FRAME, 0, 0, 0, 0, 0), *[Step(SAMPLE, 0, 1, 2, 0, 0xDB)] * 3, Step(END, 0, 0, 0, 0, 0)]
        for cycles in range(2, 40, 6):
            with contextlib.suppress(AssertionError):  # it does not end: nothing is taken after some cycles
                self.run(steps, "edge", 1, [(True, True)] * 20 + [(True, False)] * 40, cycles)
            self.check(steps, "edge", 10)


class TestAdcBankCL(TestAdcBankFL):
    cls = AdcBankCL

    @SETTINGS
    @given(step_lists(), st.integers(0, 127), patterns)
    def test_same_cycles_as_the_cycle_level(self, steps, threshold, pattern):
        got = self.run(steps, "edge", threshold, pattern)
        reference = Run(simulator(AdcBankCL, False), steps, "edge", threshold, pattern)
        assert vars(got) == vars(reference)

    @pytest.mark.parametrize(
        "row, mode, threshold, interval",
        [
            (1, "edge", 10, [8, 8]),
            (0, "ternary", 10, [8, 8]),
            (0, "edge", 1, [10, 10]),
            (0, "edge", 0, [10, 8]),
            (0, "image", 0, [10, 8]),
        ],
    )
    def test_cycles_a_step(self, row, mode, threshold, interval):
        """Zeros and signs take the eight cycles of sending the results; samples that convert, their ten decisions.

        Without a window a step has eight decisions, and every other one waits for the last lane's result to leave.
        """
        Step = step_msg(LANES)
        steps = [Step(FRAME, 0, 0, 0, 0, 0), *[Step(SAMPLE, row, 0, 0, 0, 255)] * 9, Step(END, 0, 0, 0, 0, 0)]
        got = self.run(steps, mode, threshold)
        holds = np.diff(np.flatnonzero(got.hold))
        assert sorted(holds[-2:]) == sorted(interval) and sorted(holds[-4:-2]) == sorted(interval)

    @pytest.mark.parametrize("row, threshold, latency", [(1, 10, 3), (0, 1, 11)])
    def test_latency(self, row, threshold, latency):
        """From the hold to the first result at the output."""
        Step = step_msg(LANES)
        steps = [Step(FRAME, 0, 0, 0, 0, 0), Step(SAMPLE, row, 0, 0, 0, 255), Step(END, 0, 0, 0, 0, 0)]
        got = self.run(steps, "edge", threshold)
        assert got.sent_at[1] - got.hold.index(True) == latency
        assert np.diff(got.sent_at[1:]).tolist() == [1] * 8


class TestAdcBankRTL(TestAdcBankCL):
    cls = AdcBank

    def test_outputs_after_a_reset(self):
        golden = outputs_after_reset(build(AdcBankFL(LANES)), before=0)
        assert outputs_after_reset(build(self.cls(LANES), self.verilog, f"AdcBank{LANES}")) == golden


class TestAdcBankVerilog(TestAdcBankRTL):
    verilog = True

    def test_every_pair_of_lanes_behind_a_scan_that_waits(self):
        """Each pair is at the pins of an empty bank, whose scan waits as the results come."""
        Step = step_msg(LANES)
        pairs = sorted({1 << a | 1 << b for a in range(LANES) for b in range(LANES)})
        sets = [Step(SAMPLE, 0, 1, en % 6, 0, en) for en in pairs]
        steps = [Step(FRAME, 0, 0, 0, 0, 0), Step(ROW, 0, 0, 0, 0, 0), *sets, Step(END, 0, 0, 0, 0, 0)]
        pattern = [(True, False), *13 * [(False, False)], *4 * [(False, True)]]
        run = Run(simulator(self.cls, self.verilog), steps, "image", 0, pattern)
        assert (run.messages, run.counts) == expected(steps, LANES, "image", 0)


class TestAdcBankIcarus(TestAdcBankRTL):
    verilog = "icarus"


@pytest.mark.parametrize("cls", [AdcBankFL, AdcBankCL, AdcBank])
@pytest.mark.parametrize("lanes", [1, 2, 4, 16, 32])
class TestOtherNumbersOfLanes:
    @settings(SETTINGS, max_examples=5)
    @given(st.data(), st.sampled_from(MODES), st.integers(0, 127), patterns)
    def test_any_steps(self, cls, lanes, data, mode, threshold, pattern):
        steps = data.draw(step_lists(lanes))
        got = Run(simulator(cls, False, lanes), steps, mode, threshold, pattern)
        assert (got.messages, got.counts) == expected(steps, lanes, mode, threshold)
        assert got.hold == [False, *got.wake[:-1]]  # a cycle ahead
        if cls is AdcBank:
            assert vars(got) == vars(Run(simulator(AdcBankCL, False, lanes), steps, mode, threshold, pattern))

    def test_each_lane_alone_and_all_others(self, cls, lanes):
        Step, every = step_msg(lanes), (1 << lanes) - 1
        ones = [1 << lane for lane in range(lanes)]
        steps = [Step(SAMPLE, 2, 0, 3, 0, en) for en in (*ones, *(every ^ one for one in ones))]
        begin, end = Step(FRAME, 0, 0, 0, 0, 0), Step(END, 0, 0, 0, 0, 0)
        steps = [begin, *steps, end, begin, end]  # the second frame's counts start at 0
        got = Run(simulator(cls, False, lanes), steps, "edge", 3, [(True, True), (True, False), (False, True)])
        assert (got.messages, got.counts) == expected(steps, lanes, "edge", 3)


@pytest.mark.parametrize("lanes", [2, 4, 16, 32])
@settings(SETTINGS, max_examples=1)
@given(seed=st.integers(0, 2**32))
def test_pairs_of_lanes(lanes, seed):
    """Any two lanes of the RTL, of 32 lanes some: both signs are sent, in order."""
    Step, pick = step_msg(lanes), random.Random(seed)
    pairs = [1 << a | 1 << b for a, b in combinations(range(lanes), 2)]
    steps = [Step(SAMPLE, 0, 0, pick.randrange(6), 0, en) for en in pick.sample(pairs, min(len(pairs), 120))]
    begin, end = Step(FRAME, 0, 0, 0, 0, 0), Step(END, 0, 0, 0, 0, 0)
    steps = [begin, *steps, end, begin, end]  # the counters fall from where they are
    got = Run(simulator(AdcBank, False, lanes), steps, "ternary", 3)
    assert (got.messages, got.counts) == expected(steps, lanes, "ternary", 3)


@pytest.mark.sets_registers
@pytest.mark.parametrize("bit", (8, 16, 24, 31, 32))
def test_carries_of_the_counters(bit):
    """Each counter of the RTL passes a power of two, here soon after a reset."""
    Step = step_msg(LANES)
    begin, end = Step(FRAME, 0, 0, 0, 0, 0), Step(END, 0, 0, 0, 0, 0)
    steps = [Step(SAMPLE, row, 0, 1, 0, 0x11) for row in (0, 1) * 3]
    _, [counts] = expected([begin, *steps, end], LANES, "edge", 10)
    for counted in ((1 << bit) - 1, 5), (3, (1 << bit) - 2):
        got = Run(simulator(AdcBank, False), [*steps, end], "edge", 10, counted=counted)
        assert got.counts == [tuple((a + b) % 2**32 for a, b in zip(counted, counts))]
