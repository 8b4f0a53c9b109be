"""EdgeAdc at every level: held values in, the golden model's codes out, whatever the timing of go and rdy."""

import contextlib
from functools import cache

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.models.afe import Converter
from talbot.models.digital.sar import convert
from talbot.models.parameters import ConverterParameters
from talbot.rtl.edge_adc import EdgeAdc, EdgeAdcCL, EdgeAdcFL
from talbot.rtl.harness.reset import outputs_after_reset
from talbot.rtl.harness.testbench import build

ROUGH = Converter.draw(ConverterParameters(inl=2, dnl=0.5, offset=2, noise=1.5, ktc=1, seed=3), 1)
IDEAL = Converter.ideal(1)
EVERY_CYCLE = [(0, True)]
SETTINGS = settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.differing_executors])

patterns = st.lists(st.tuples(st.integers(0, 12), st.booleans()), min_size=1, max_size=30).filter(
    lambda p: any(ready for _, ready in p)
)


@cache
def simulator(cls, verilog):
    return build(cls(), verilog, "EdgeAdc")


class Bench:
    """Drives one lane. Each conversion: cycle of `go`, first cycle of its result at the port, DAC codes."""

    def __init__(self, sim, values, unsigned, threshold, converter=IDEAL, ternary=False):
        self.sim, self.converter, self.unsigned = sim, converter, unsigned
        sim.unsigned_ @= unsigned
        sim.threshold @= threshold
        sim.ternary @= ternary
        sim.go @= 0
        sim.out.rdy @= 0
        sim.reset @= 1
        sim.sim_tick()
        sim.reset @= 0
        self.held = [converter.held(v, 0, i) for i, v in enumerate(values)]
        self.go_at, self.result_at, self.results, self.dacs, self.taken_at = [], [], [], [], []
        self.cycle = 0

    def run(self, pattern=EVERY_CYCLE, limit=20_000):
        """Convert all values; ``pattern``: (idle cycles ahead of a go, rdy in this cycle), cyclic."""
        sim, was_free, wait = self.sim, False, 0
        while len(self.results) < len(self.held):
            gap, ready = pattern[self.cycle % len(pattern)]
            number = len(self.go_at)
            go = was_free and wait == 0 and number < len(self.held)
            wait = gap if go else max(0, wait - 1)
            sim.go @= go
            sim.out.rdy @= ready
            self.compare()
            sim.sim_eval_combinational()
            if sim.out.val and len(self.result_at) == len(self.results):
                self.result_at.append(self.cycle)
            if sim.out.val and ready:
                self.results.append((int(sim.out.msg), bool(sim.converted)))
                self.taken_at.append(self.cycle)
            was_free = bool(sim.free) and not go
            if go:
                self.go_at.append(self.cycle)
                self.dacs.append([])
            sim.sim_tick()
            self.cycle += 1
            assert self.cycle < limit
        return self

    def compare(self):
        """Compare the DAC with the last held value."""
        sim = self.sim
        answer = False
        if self.go_at:
            sample, number = len(self.go_at) - 1, min(self.cycle - self.go_at[-1] - 1, 14)
            self.dacs[-1].append(int(sim.dac))
            answer = self.converter.compare(self.held[sample], int(sim.dac), self.unsigned, 0, sample, number)
        sim.comparator @= int(answer)


def expected(values, unsigned, threshold, converter=None, ternary=False):
    got = convert(np.array(values), unsigned, threshold, converter, 0, np.arange(len(values)), ternary)
    return [(int(c) & 0xFF, bool(k)) for c, k in zip(got.codes, got.converted)]


class TestEdgeAdcFL:
    """Inherited by every level; a level overrides ``cls`` and ``verilog``."""

    cls, verilog = EdgeAdcFL, False

    @classmethod
    def bench(cls, *args):
        return Bench(simulator(cls.cls, cls.verilog), *args)

    def test_every_code(self):
        values = [x + d for x in range(-130, 131, 3) for d in (-0.5, 0.25)]
        for unsigned, threshold in ((False, 0), (False, 10), (True, 10)):
            bench = self.bench(values, unsigned, threshold).run()
            assert bench.results == expected(values, unsigned, threshold)

    @SETTINGS
    @given(
        st.booleans(),
        st.integers(0, 127),
        st.lists(st.one_of(st.floats(-140, 300), st.floats(-20, 20)), min_size=1, max_size=20),
        patterns,
    )
    def test_any_timing(self, unsigned, threshold, values, pattern):
        bench = self.bench(values, unsigned, threshold, ROUGH).run(pattern)
        assert bench.results == expected(values, unsigned, threshold, ROUGH)

    @SETTINGS
    @given(
        st.integers(0, 127),
        st.lists(st.one_of(st.floats(-140, 140), st.floats(-9, 9)), min_size=1, max_size=20),
        patterns,
    )
    def test_ternary(self, threshold, values, pattern):
        bench = self.bench(values, False, threshold, ROUGH, True).run(pattern)
        assert bench.results == expected(values, False, threshold, ROUGH, True)

    def test_ternary_levels(self):
        values = [-10.5, -10.49, -9.51, -9.5, 0, 9.49, 9.5, 300]
        bench = self.bench(values, False, 10, IDEAL, True).run()
        assert bench.results == [(code & 0xFF, False) for code in (-1, -1, -1, 0, 0, 0, 1, 1)]
        assert {tuple(dacs[:2]) for dacs in bench.dacs} == {(138, 119)}
        assert [code for code, _ in self.bench([-0.6, -0.5, 0], False, 0, IDEAL, True).run().results] == [255, 1, 1]

    def test_extreme_thresholds(self):
        values = [-200, -128.4, -127.5, -126.9, -1, -0.5, -0.51, 0, 0.49, 0.5, 126.4, 126.5, 127, 500]
        for threshold in (0, 1, 2, 126, 127):
            assert self.bench(values, False, threshold).run().results == expected(values, False, threshold)

    def test_a_code_inside_the_window_becomes_zero(self):
        """A comparator with inconsistent decisions: outside the window, then a code inside it."""
        offset = Converter(IDEAL.levels.copy(), np.zeros(1), 0.0, 0.0, 0)
        offset.levels[0, 0, 128 + 20] -= 15  # level(T) far too low
        bench = self.bench([10.0, 25.0, -10.0], False, 20, offset).run()
        assert bench.results == [(0, True), (25, True), (0, False)]

    def test_dac_sequence(self):
        bench = self.bench([3.0, 50.2], False, 10).run()
        assert bench.dacs[0][:2] == [138, 119]
        assert bench.dacs[1][:10] == [138, 119, 128, 192, 160, 176, 184, 180, 178, 179]


class TestEdgeAdcCL(TestEdgeAdcFL):
    cls = EdgeAdcCL

    def test_latency(self):
        """From go to the result at the port, and from go to go without stalls."""
        for values, unsigned, threshold, ternary, latency, interval in (
            ([0.0] * 6, False, 10, False, 3, 4),
            ([99.0] * 6, False, 10, False, 11, 10),
            ([99.0] * 6, False, 0, False, 9, 8),
            ([99.0] * 6, True, 10, False, 9, 8),
            ([99.0, 0.0, -99.0] * 2, False, 10, True, 3, 4),
        ):
            bench = self.bench(values, unsigned, threshold, IDEAL, ternary).run()
            assert [r - g for g, r in zip(bench.go_at, bench.result_at)] == [latency] * 6
            assert set(np.diff(bench.go_at)) == {interval}

    def test_converts_once_more_while_a_result_waits(self):
        bench = self.bench([40.0, 50.0, 60.0], False, 10).run([(0, False)] * 40 + [(0, True)])
        assert len([g for g in bench.go_at if g < 40]) == 2
        assert bench.results == expected([40.0, 50.0, 60.0], False, 10)
        assert bench.taken_at[0] == 40

    def test_signs_wait_while_a_result_waits(self):
        values = [9.0, -50.0, 9.0, 50.0, -50.0, 9.0, -50.0, -50.0, 50.0, 50.0]
        for late in range(len(values)):
            some = values[late:] + values[:late]
            bench = self.bench(some, False, 10, IDEAL, True).run([(0, False)] * 20 + [(0, True)])
            assert bench.results == expected(some, False, 10, ternary=True)

    @SETTINGS
    @given(
        st.lists(st.sampled_from([0.0, 5.0, 60.0, -90.0]), min_size=1, max_size=15),
        st.sampled_from([(False, False), (True, False), (False, True)]),
        patterns,
    )
    def test_same_cycles_as_the_cycle_level(self, values, how, pattern):
        unsigned, ternary = how

        def trace(bench):
            bench.run(pattern)
            taken = convert(np.array(values), unsigned, 10, ternary=ternary).decisions  # the DAC stays after them
            return (
                bench.go_at,
                bench.result_at,
                bench.taken_at,
                bench.results,
                [dac[:n] for dac, n in zip(bench.dacs, taken)],
            )

        reference = Bench(simulator(EdgeAdcCL, False), values, unsigned, 10, IDEAL, ternary)
        assert trace(self.bench(values, unsigned, 10, IDEAL, ternary)) == trace(reference)

    def test_go_while_it_is_not_free_changes_nothing(self):
        sim = simulator(self.cls, self.verilog)
        bench = self.bench([70.0, -70.0], False, 10)
        for cycle in range(9):  # cycles 1..8: go in every one
            sim.go @= 1
            bench.compare()
            sim.sim_tick()
            if cycle == 0:
                bench.go_at, bench.dacs = [0], [[]]
            bench.cycle += 1
        assert bench.dacs[0] == [138, 119, 128, 192, 224, 208, 200, 196]

    def test_reset_at_any_moment(self):
        """A reset drops the conversion in progress and the results that wait."""
        for cycles in range(1, 26, 2):
            bench = self.bench([60.0, -50.0], False, 10)
            with contextlib.suppress(AssertionError):  # it never ends: nothing is taken
                bench.run([(0, False)], limit=cycles)
            again = self.bench([0.0, 99.0], False, 10)
            again.sim.sim_eval_combinational()
            assert not again.sim.busy and not again.sim.out.val and again.sim.free
            assert again.run().results == expected([0.0, 99.0], False, 10), cycles


class TestEdgeAdcRTL(TestEdgeAdcCL):
    cls = EdgeAdc

    def test_outputs_after_a_reset(self):
        golden = outputs_after_reset(simulator(EdgeAdcFL, False), before=0)
        assert outputs_after_reset(simulator(self.cls, self.verilog)) == golden


class TestEdgeAdcVerilog(TestEdgeAdcRTL):
    verilog = True


class TestEdgeAdcIcarus(TestEdgeAdcRTL):
    verilog = "icarus"
