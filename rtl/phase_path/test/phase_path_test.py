"""PhasePath at every level: taps in, the golden model's phase and amplitude out, marks in order."""

import contextlib
from functools import cache

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.models.digital.phase import phase_samples
from talbot.models.parameters import ChipParameters
from talbot.rtl.harness.reset import outputs_after_reset
from talbot.rtl.harness.testbench import build
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.rtl.phase_path import PhasePath, PhasePathCL, PhasePathFL

LANES = 8
SETTINGS = settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.differing_executors])
ALWAYS = [(True, True)]
LAST = 1 << 9
patterns = st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=30).filter(
    lambda p: any(v for v, _ in p) and any(r for _, r in p)
)
bytes_ = st.one_of(st.integers(0, 255), st.sampled_from([0, 1, 127, 128, 254, 255]))


def steps_of(lanes):
    """The taps of a step: any number of lanes."""
    return st.sampled_from(sorted({1, lanes, *range(1, min(lanes, 8)), max(1, lanes - 1)})).flatmap(
        lambda n: st.lists(st.lists(bytes_, min_size=n, max_size=n), min_size=4, max_size=4)
    )


steps = steps_of(LANES)
short_rows = st.lists(st.tuples(st.integers(0, 1023), st.lists(steps, max_size=1)), max_size=1)
floors = st.sampled_from([0, 1, 20, 201, 255])
rows = st.lists(st.tuples(st.integers(0, 1023), st.lists(steps, max_size=3)), max_size=3)


def messages(frame):
    """The bank's messages of [(row, [step])]; a step is its four taps, each the samples of the enabled lanes."""
    out = [(FRAME, 0)]
    for row, row_steps in frame:
        out.append((ROW, row))
        for taps in row_steps:
            for tap in taps:
                out += [(SAMPLE, value | (LAST if i == len(tap) - 1 else 0)) for i, value in enumerate(tap)]
    return [*out, (END, 0)]


def unmarked(frame):
    """The messages that leave when off."""
    return [(kind, data & 0xFF if kind == SAMPLE else data) for kind, data in messages(frame)]


def expected(frame, chip, noise_floor):
    out = [(FRAME, 0)]
    for row, row_steps in frame:
        out.append((ROW, row))
        for taps in row_steps:
            phase, amplitude = phase_samples(np.array(taps).T, chip, noise_floor)
            out += [(SAMPLE, int(value)) for pair in zip(phase, amplitude) for value in pair]
    return [*out, (END, 0)]


@cache
def simulator(cls, verilog, chip):
    return build(
        cls(chip.lanes, chip.divider, chip.n_frac, chip.cordic_iterations),
        verilog,
        f"PhasePath_{chip.lanes}_{chip.divider}",
    )


class Run:
    """Frames without a reset between them: the messages sent, and the cycles in which messages are taken and sent."""

    def __init__(self, sim):
        self.sim, self.cycle = sim, 0
        self.messages, self.in_at, self.out_at = [], [], []
        sim.recv.val @= 0
        sim.send.rdy @= 0
        sim.reset @= 1
        sim.sim_tick()
        sim.reset @= 0

    @property
    def seen(self):
        return self.messages, self.in_at, self.out_at

    def frame(self, sent, on, noise_floor=0, pattern=ALWAYS, limit=None):
        """Send the messages ``sent`` of a frame; ends with END. limit: cycles, by default far more than it takes."""
        sim, sent, begin = self.sim, list(sent), self.cycle
        sim.on @= on
        sim.noise_floor @= noise_floor
        limit = begin + (limit or (len(sent) + 4) * (20 + 2 * len(pattern)))
        ended = False
        while not ended:
            offer, ready = pattern[(self.cycle - begin) % len(pattern)]
            sim.recv.val @= bool(sent) and offer
            if sent:
                sim.recv.msg.kind @= sent[0][0]
                sim.recv.msg.data @= sent[0][1]
            sim.send.rdy @= ready
            sim.sim_eval_combinational()
            if sent and offer and sim.recv.rdy:
                sent.pop(0)
                self.in_at.append(self.cycle)
            if ready and sim.send.val:
                self.messages.append((int(sim.send.msg.kind), int(sim.send.msg.data)))
                self.out_at.append(self.cycle)
                ended = self.messages[-1][0] == END
            sim.sim_tick()
            self.cycle += 1
            assert self.cycle < limit
        return self

    def idle(self, configuration):
        """Between frames: a cycle for each (on, noise floor)."""
        self.sim.recv.val @= 0
        for on, noise_floor in configuration:
            self.sim.on @= on
            self.sim.noise_floor @= noise_floor
            self.sim.sim_tick()
            self.cycle += 1


class TestPhasePathFL:
    """Inherited by every level; a level overrides ``cls`` and ``verilog``."""

    cls, verilog = PhasePathFL, False
    chip = ChipParameters(LANES, "radix4", 8)

    def run(self, *args):
        return self.fresh().frame(*args)

    def fresh(self):
        return Run(simulator(self.cls, self.verilog, self.chip))

    @SETTINGS
    @given(rows, st.sampled_from([0, 1, 20, 255]), patterns)
    def test_any_taps_and_any_timing(self, frame, noise_floor, pattern):
        got = self.run(messages(frame), True, noise_floor, pattern)
        assert got.messages == expected(frame, self.chip, noise_floor)

    @SETTINGS
    @given(
        st.lists(st.tuples(st.booleans(), floors, short_rows, st.lists(st.tuples(st.booleans(), floors))), max_size=4)
    )
    def test_frames_without_a_reset(self, frames):
        """The configuration changes between frames, several times too."""
        run, wanted = self.fresh(), []
        for on, noise_floor, frame, between in frames:
            if not on:  # other modes have one tap
                frame = [(row, [taps[: 1 + row % 4] for taps in row_steps]) for row, row_steps in frame]
            run.frame(messages(frame), on, noise_floor)
            wanted += expected(frame, self.chip, noise_floor) if on else unmarked(frame)
            run.idle(between)
        assert run.messages == wanted

    def test_every_sample_of_full_steps(self):
        """The taps of all lanes of a step are stored, whatever their values."""
        rng = np.random.default_rng(2)
        frame = [(1, rng.integers(0, 256, (20, 4, LANES)).tolist())]
        assert self.run(messages(frame), True).messages == expected(frame, self.chip, 0)

    @SETTINGS
    @given(rows, patterns)
    def test_passes_samples_without_the_last_flag_when_off(self, frame, pattern):
        got = self.run(messages(frame), False, 200, pattern)
        assert got.messages == unmarked(frame)

    def test_the_four_quadrants_and_none(self):
        """x = i0 - i180, y = i270 - i90."""
        taps = [[200, 100, 0, 100, 100], [100, 0, 100, 200, 100], [0, 100, 200, 100, 100], [100, 200, 100, 0, 100]]
        got = self.run(messages([(7, [taps])]), True)
        assert got.messages[1:-1] == [(ROW, 7), *((SAMPLE, v) for v in (0, 200, 64, 200, 128, 200, 192, 200, 0, 0))]

    def test_amplitude_under_the_noise_floor_is_zero(self):
        taps = [[30, 31], [0, 0], [0, 0], [0, 0]]
        got = self.run(messages([(0, [taps])]), True, 31)
        assert [data for _, data in got.messages[2:-1]] == [0, 0, 0, 31]

    def test_reset_at_any_moment(self):
        """A reset drops the message inside, the taps of a step and the division in progress."""
        frame = [(3, [[[200, 9, 77], [30, 8, 76], [10, 7, 75], [99, 6, 74]]] * 2)]
        for cycles in range(1, 50, 4):
            for on in (True, False):
                with contextlib.suppress(AssertionError):  # it does not end: nothing is sent after some cycles
                    self.run(messages(frame), on, 0, [(True, True)] * 30 + [(True, False)] * 30, cycles)
                assert self.run(messages(frame), True).messages == expected(frame, self.chip, 0), cycles


class TestPhasePathCL(TestPhasePathFL):
    cls = PhasePathCL

    @SETTINGS
    @given(rows, st.booleans(), patterns)
    def test_same_cycles_as_the_cycle_level(self, frame, on, pattern):
        got = self.run(messages(frame), on, 20, pattern)
        reference = Run(simulator(PhasePathCL, False, self.chip)).frame(messages(frame), on, 20, pattern)
        assert got.seen == reference.seen

    def test_passes_a_message_a_cycle_when_off(self):
        sent = messages([(1, [[[1] * 8] * 4] * 2)])
        got = self.run(sent, False)
        assert (np.diff(got.out_at) == 1).all() and got.out_at[0] == got.in_at[0] + 1

    def test_cycles_of_a_step_when_on(self):
        """24 taps a message a cycle, then the divider's interval a sample, the last response in two messages."""
        sent = messages([(1, [[[9] * 8] * 4] * 3)])
        got = self.run(sent, True)
        fourth = np.array(got.in_at[2:-1]).reshape(3, 4, 8)
        assert (np.diff(fourth[:, :3].reshape(3, 24)[:, 1:]) == 1).all()
        assert set(np.diff(fourth[:, 3])[:, 1:].ravel()) == {7}
        assert (np.diff(fourth[:, 0, 0]) == 74).all()


class TestPhasePathRTL(TestPhasePathCL):
    cls = PhasePath

    def test_outputs_after_a_reset(self):
        golden = outputs_after_reset(simulator(PhasePathCL, False, self.chip), before=0)
        assert outputs_after_reset(simulator(self.cls, self.verilog, self.chip)) == golden


class TestPhasePathVerilog(TestPhasePathRTL):
    verilog = True


class TestPhasePathIcarus(TestPhasePathRTL):
    verilog = "icarus"


CHIPS = [
    ChipParameters(1, "radix2", 4),
    ChipParameters(2, "radix4", 5),
    ChipParameters(4, "cordic", 8, 6),
    ChipParameters(16, "pipelined", 16),
    ChipParameters(32, "pipelined", 12),
]


@pytest.mark.parametrize("cls", [PhasePathCL, PhasePath])
@pytest.mark.parametrize("chip", CHIPS, ids=lambda c: f"{c.lanes}-{c.divider}")
@settings(SETTINGS, max_examples=8)
@given(st.data())
def test_two_frames_of_any_configuration(cls, chip, data):
    """Any samples a step, `on`, noise floor and stalls in each frame."""
    run, wanted = Run(simulator(cls, False, chip)), []
    for _ in range(2):
        on, noise_floor, pattern = data.draw(st.booleans()), data.draw(floors), data.draw(patterns)
        frame = [(data.draw(st.integers(0, 1023)), data.draw(st.lists(steps_of(chip.lanes), max_size=2)))]
        run.frame(messages(frame), on, noise_floor, pattern)
        wanted += expected(frame, chip, noise_floor) if on else unmarked(frame)
    assert run.messages == wanted


def extremes(rng, lanes):
    """Eight steps of all lanes: each lane has every pair of extremes in taps 0 and 2, then in taps 1 and 3."""
    pairs, steps = np.array([(0, 0), (0, 255), (255, 0), (255, 255)]), rng.integers(0, 256, (8, 4, lanes))
    for number, step in enumerate(steps):
        step[number // 4 :: 2] = pairs[(np.arange(lanes) + number) % 4].T
    return steps.tolist()


@pytest.mark.parametrize("cls", [PhasePathCL, PhasePath])
@pytest.mark.parametrize("chip", CHIPS, ids=lambda c: f"{c.lanes}-{c.divider}")
def test_other_lanes_and_dividers(cls, chip):
    rng = np.random.default_rng(8)
    count = 2 if chip.lanes < 8 else 1
    any_taps = [(row, [rng.integers(0, 256, (4, chip.lanes)).tolist() for _ in range(count)]) for row in (0, 5)]
    stalls = [(True, False), (True, True), (False, True), (True, False), (True, False)]
    for frame, pattern in (([(9, extremes(rng, chip.lanes))], ALWAYS), (any_taps, ALWAYS), (any_taps, stalls)):
        got = Run(simulator(cls, False, chip)).frame(messages(frame), True, 10, pattern)
        assert got.messages == expected(frame, chip, 10)
        reference = Run(simulator(PhasePathCL, False, chip)).frame(messages(frame), True, 10, pattern)
        assert got.seen == reference.seen


@pytest.mark.parametrize("divider, cycles", [("radix2", 102), ("radix4", 74), ("pipelined", 32), ("cordic", 116)])
def test_cycles_of_a_full_step(divider, cycles):
    """From tap 0 of one step of eight samples to tap 0 of the next, without stalls."""
    chip = ChipParameters(LANES, divider)
    got = Run(simulator(PhasePathCL, False, chip)).frame(messages([(1, [[[9] * 8] * 4] * 3)]), True)
    assert np.diff(np.array(got.in_at[2:-1]).reshape(3, 32)[:, 0]).tolist() == [cycles, cycles]
