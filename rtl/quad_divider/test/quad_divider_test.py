"""QuadDivider at every level: responses against the golden functions, order, back-pressure, cycles."""

import random
from dataclasses import astuple, dataclass
from functools import cache
from itertools import chain, product, repeat

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.models.parameters import DIVIDERS, ParameterError
from talbot.models.parameters.divider import ITERATIONS_MAX, ITERATIONS_MIN, N_FRAC_MAX, N_FRAC_MIN, phase_thresholds
from talbot.rtl.harness.reset import outputs_after_reset
from talbot.rtl.harness.testbench import build
from talbot.rtl.messages import DivReq
from talbot.rtl.quad_divider import QuadDividerCL, QuadDividerFL, quad_divider, timing
from talbot.rtl.quad_divider.quad_divider_fl import response

SETTINGS = settings(
    max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.differing_executors]
)
SAMPLES = st.integers(-256, 255)
PATTERN = st.lists(st.booleans(), max_size=12)  # cycles in which a side of the bench is ready
EDGES = (-256, -255, -129, -128, -127, -1, 0, 1, 2, 127, 128, 254, 255)
RUSH = ()


@dataclass(frozen=True)
class Config:
    """The component under test."""

    variant: str
    n_frac: int = 8
    iterations: int = 10

    @property
    def name(self):
        """Name of the Verilog module; the compiled model is cached by it."""
        return f"QuadDivider_{self.variant}_{self.n_frac}_{self.iterations}"


@cache
def simulator(component, verilog, config):
    return build(component(*astuple(config)), verilog, config.name)


class Bench:
    """One divider, reset; `run` is a source and a sink at its streams."""

    def __init__(self, sim, config):
        self.sim, self.config = sim, config
        sim.recv.val @= 0
        sim.send.rdy @= 0
        sim.noise_floor @= 0
        self.reset()

    def reset(self):
        self.sim.reset @= 1
        self.sim.sim_tick()
        self.sim.reset @= 0

    def run(self, vectors, source=RUSH, sink=RUSH, floors=(0,)):
        """Send the (x, y) of ``vectors``; returns [(response, cycle it was taken)], [cycle a request was taken].

        source, sink: willingness by cycle, willing ever after. floors: noise floor of each request; the last stays.
        Before a request is taken and after it another noise floor is at the port.
        """
        sim, sent, got = self.sim, [], []
        source, sink = chain(source, repeat(True)), chain(sink, repeat(True))
        waiting = False  # an offered request stays offered
        for cycle in range(100 * len(vectors) + 100):
            waiting = len(sent) < len(vectors) and (next(source) or waiting)
            if waiting:
                x, y = vectors[len(sent)]
                sim.recv.msg @= DivReq(x, y)
            sim.recv.val @= waiting
            sim.noise_floor @= floors[min(len(sent), len(floors) - 1)] if waiting else 77
            sim.send.rdy @= next(sink)
            sim.sim_eval_combinational()
            if sim.recv.val & sim.recv.rdy:
                sent.append(cycle)
                waiting = False
            if sim.send.val & sim.send.rdy:
                got.append((sim.send.msg.clone(), cycle))
            sim.sim_tick()
            if len(got) == len(vectors):
                return got, sent
        raise AssertionError(f"{len(got)} of {len(vectors)} responses after {cycle + 1} cycles")

    def check(self, vectors, source=RUSH, sink=RUSH, floors=(0,)):
        got, _ = self.run(vectors, source, sink, floors)
        floors = [*floors, *repeat(floors[-1], len(vectors))]
        for vector, floor, (message, _) in zip(vectors, floors, got):
            assert message == response(*astuple(self.config), DivReq(*vector), floor), vector


class TestFL:
    component, verilog = QuadDividerFL, False
    configs = [Config(v) for v in DIVIDERS] + [
        Config("radix4", 7),
        Config("radix2", 4),
        Config("pipelined", 16),
        Config("cordic", 8, 16),
        Config("cordic", 8, 4),
    ]

    @pytest.fixture
    def benches(self):
        return [self.bench(config) for config in self.configs]

    def bench(self, config):
        return Bench(simulator(type(self).component, self.verilog, config), config)

    def test_edges(self, benches):
        for bench in benches:
            bench.check(list(product(EDGES, EDGES)), floors=(0, 1, 127, 128, 255, 2))

    @SETTINGS
    @given(
        st.data(),
        st.lists(st.tuples(SAMPLES, SAMPLES), min_size=1, max_size=24),
        PATTERN,
        PATTERN,
        st.lists(st.integers(0, 255), min_size=1, max_size=24),
    )
    def test_any_back_pressure(self, data, vectors, source, sink, floors):
        bench = self.bench(data.draw(st.sampled_from(self.configs)))
        bench.check(vectors, source, sink, floors)

    def test_no_result_depends_on_the_one_before(self, benches):
        """A vector between any two others gives the same response."""
        vector, others = (-3, 200), [(0, 0), (-256, -256), (255, -255), (1, 0), (-7, 250)]
        for bench in benches:
            mixed = [v for other in others for v in (other, vector)]
            got, _ = bench.run(mixed)
            assert len({int(message.to_bits()) for message, _ in got[1::2]}) == 1

    def test_reset_drops_the_division_in_progress(self, benches):
        for bench in benches:
            latency, _ = timing(*astuple(bench.config))
            for ticks in (1, 2, latency - 1, latency, latency + 2):
                bench.sim.recv.msg @= DivReq(200, 100)
                bench.sim.recv.val @= 1
                bench.sim.send.rdy @= 0
                for _ in range(ticks):
                    bench.sim.sim_tick()
                bench.sim.recv.val @= 0
                bench.reset()
                bench.sim.sim_eval_combinational()
                assert not bench.sim.send.val and bench.sim.recv.rdy
                bench.check([(-5, 9), (0, 0)])

    def test_an_offered_response_stays(self, benches):
        for bench in benches:
            sim = bench.sim
            bench.check([(11, 4)])
            sim.recv.msg @= DivReq(-40, 41)
            sim.recv.val @= 1
            sim.send.rdy @= 0
            sim.noise_floor @= 41
            for _ in range(60):
                sim.sim_tick()
            held = sim.send.msg.clone()
            assert sim.send.val and not sim.recv.rdy
            assert held == response(*astuple(bench.config), DivReq(-40, 41), 41)
            sim.noise_floor @= 255
            sim.recv.val @= 0
            for _ in range(5):
                sim.sim_tick()
                assert sim.send.val and sim.send.msg == held


class TestCL(TestFL):
    component = QuadDividerCL

    def test_latency_and_interval(self, benches):
        vectors = [(3 * i - 20, 200 - 17 * i) for i in range(24)]
        for bench in benches:
            latency, interval = timing(*astuple(bench.config))
            got, sent = bench.run(vectors)
            assert [taken - requested for (_, taken), requested in zip(got, sent)] == [latency] * len(vectors)
            assert [b - a for a, b in zip(sent, sent[1:])] == [interval] * (len(vectors) - 1)

    @SETTINGS
    @given(st.data(), st.lists(st.tuples(SAMPLES, SAMPLES), min_size=1, max_size=12), PATTERN, PATTERN)
    def test_cycles_under_back_pressure(self, data, vectors, source, sink):
        config = data.draw(st.sampled_from(self.configs))
        model = Bench(simulator(QuadDividerCL, False, config), config)
        got, sent = self.bench(config).run(vectors, source, sink)
        expected, requested = model.run(vectors, source, sink)
        assert [cycle for _, cycle in got] == [cycle for _, cycle in expected] and sent == requested


class TestRTL(TestCL):
    component = staticmethod(quad_divider)

    def test_outputs_after_a_reset(self):
        for config in self.configs:
            golden = outputs_after_reset(simulator(QuadDividerFL, False, config), before=0)
            assert outputs_after_reset(simulator(type(self).component, self.verilog, config)) == golden, config


class TestVerilog(TestRTL):
    verilog = True
    configs = [Config(v) for v in DIVIDERS] + [Config("radix4", 7)]


class TestIcarus(TestVerilog):
    verilog = "icarus"

    @pytest.fixture(autouse=True)
    def on_netlists_alone(self, on_netlists):
        self.configs = on_netlists(self.configs)


def around_thresholds(n_frac):
    """Return the vectors nearest to each threshold of the phase table, on both sides."""
    larger, smaller = (v.ravel() for v in np.meshgrid(np.arange(1, 257), np.arange(257)))
    ratio = (smaller << n_frac) // larger
    for threshold in phase_thresholds(n_frac):
        for side in (ratio >= threshold, ratio < threshold):
            if (inside := np.flatnonzero(side & (smaller <= larger))).size:
                at = inside[abs(ratio[inside] - threshold).argmin()]
                yield int(larger[at]), int(smaller[at])


@pytest.mark.parametrize(
    "config",
    [
        *(Config(variant, n) for variant in DIVIDERS[:-1] for n in range(N_FRAC_MIN, N_FRAC_MAX + 1)),
        *(Config("cordic", 8, n) for n in range(ITERATIONS_MIN, ITERATIONS_MAX + 1)),
    ],
    ids=lambda config: config.name,
)
class TestEverySize:
    verilog = "icarus"

    def test_thresholds_stalls_and_a_reset(self, config, on_netlists):
        on_netlists([config])
        noise = random.Random(1)

        def turned(*pair):
            return tuple(noise.sample([noise.choice((v, -v)) if v < 256 else -v for v in pair], 2))

        bench = Bench(build(quad_divider(*astuple(config)), self.verilog, config.name), config)
        vectors = [turned(*pair) for pair in around_thresholds(config.n_frac)]
        vectors += [turned(noise.randrange(257), noise.randrange(257)) for _ in range(40)]
        noise.shuffle(vectors)
        stalls = [[noise.random() < 0.7 for _ in range(900)] for _ in range(2)]
        bench.check(vectors[:20], *stalls, [noise.randrange(256) for _ in range(20)])
        bench.sim.recv.val @= 1
        for _ in range(noise.randrange(1, timing(*astuple(config))[0] + 2)):
            bench.sim.sim_tick()
        bench.reset()
        bench.check(vectors[20:])


@pytest.mark.parametrize(
    "arguments, field",
    [
        (("radix8",), "divider = 'radix8'"),
        (("radix2", 3), "n_frac = 3"),
        (("radix4", 17), "n_frac = 17"),
        (("cordic", 8, 3), "iterations = 3"),
        (("cordic", 8, 17), "iterations = 17"),
    ],
)
def test_refuses(arguments, field):
    for make in (quad_divider, timing):
        with pytest.raises(ParameterError, match=field):
            make(*arguments)
