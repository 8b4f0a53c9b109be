"""The dividers as gates: every request at every noise floor, and random ones under stalls and resets, in parallel."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pymtl3 import Component, InPort, Wire, update, update_ff
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.models.digital.phase import divide
from talbot.models.parameters import DIVIDERS, STANDARD
from talbot.models.parameters.divider import ITERATIONS_MAX, ITERATIONS_MIN, N_FRAC_MAX, N_FRAC_MIN
from talbot.rtl.harness.gates import Gates, packed, unpacked
from talbot.rtl.messages import DivReq, div_resp
from talbot.rtl.quad_divider import quad_divider, ratio_bits, timing

DEFAULTS = [(variant, 8, 10) for variant in DIVIDERS]
SOME_FLOORS = [0, 1, 77, 128, 201, 254, 255]
SIZES = [
    *product(("radix2", "radix4", "pipelined"), range(N_FRAC_MIN, N_FRAC_MAX + 1), (10,)),
    *product(("cordic",), (8,), range(ITERATIONS_MIN, ITERATIONS_MAX + 1)),
]
REQUESTS = np.arange(1 << 18)  # a DivReq: x, y
X, Y = ((value ^ 256) - 256 for value in (REQUESTS >> 9, REQUESTS & 511))
EDGES = (-256, -255, -129, -128, -127, -1, 0, 1, 2, 127, 128, 254, 255)
FLOORS = 256
AMP_VALID = 8  # bit of a DivResp


def bits_of(config):
    """Return the width of a DivResp."""
    return div_resp(ratio_bits(*config[:2])).nbits


def responses(config):
    """Return the DivResp to each of REQUESTS with a noise floor of 0."""
    found = divide(*config, X, Y)
    out = np.zeros(REQUESTS.size, np.int64)
    widths = ("octant", 3), ("ratio", ratio_bits(*config[:2])), ("zero", 1), ("phase", 8), ("amp_valid", 1), ("amp", 8)
    for field, width in widths:
        out = out << width | getattr(found, field)
    return out


def wrong_requests(gates, config, floors):
    """(x, y, floor) of the wrong responses, of the first noise floor that has one, when every request is sent.

    Each noise floor has the requests in another order, so that every one comes after others.
    """
    (latency, interval), random = timing(*config), np.random.default_rng(3)
    golden = responses(config)
    sent, expected, amplitude = packed(REQUESTS, 18), packed(golden, bits_of(config)), golden & 255
    shifts = random.integers(0, sent.shape[1], len(floors))
    gates["reset"], gates["send.rdy"] = 1, 1
    gates.tick()
    gates["reset"] = 0
    for cycle in range((len(floors) - 1) * interval + latency + 1):
        number, wait = -(-cycle // interval), cycle % interval  # of the request that is offered
        gates["recv.val"] = number < len(floors)
        gates["noise_floor"] = int(random.integers(256))
        if number < len(floors):
            gates["recv.msg"] = np.roll(sent, shifts[number], 1)
            if not wait:
                gates["noise_floor"] = floors[number]
        gates.tick()
        answer, early = divmod(cycle - latency, interval)
        ready, offered = gates["recv.rdy"], gates["send.val"]
        assert (~ready if not wait else ready).any() == 0, f"recv.rdy in cycle {cycle}"
        offers = answer >= 0 and not early
        assert (~offered if offers else offered).any() == 0, f"send.val in cycle {cycle}"
        if offers:
            want = expected.copy()
            want[AMP_VALID] &= packed(amplitude >= floors[answer])[0]
            differs = np.bitwise_or.reduce(gates["send.msg"] ^ np.roll(want, shifts[answer], 1), 0)
            if differs.any():
                at = np.flatnonzero(unpacked(np.roll(differs, -shifts[answer])[None]))
                return [(int(X[i]), int(Y[i]), floors[answer]) for i in at]
    return []


def check_random(gates, config, seed, cycles=300):
    """Check all outputs in every cycle, with random requests, noise floors, stalls and resets for each copy."""
    latency, interval = timing(*config)
    golden, random, n = responses(config), np.random.default_rng(seed), gates.copies
    pace, willing = random.choice((0.1, 0.5, 1.0), (2, n))
    edges = np.flatnonzero(np.isin(X, EDGES) & np.isin(Y, EDGES))
    slots, valid = np.zeros((latency, n), np.int64), np.zeros((latency, n), bool)  # as in QuadDividerCL
    request, waiting, reset = np.zeros(n, np.int64), np.zeros(n, bool), np.ones(n, bool)
    for cycle in range(cycles):
        other = np.where(random.random(n) < 0.5, random.choice(edges, n), random.integers(REQUESTS.size, size=n))
        request = np.where(waiting, request, other)
        offered = waiting | (random.random(n) < pace)
        taking = random.random(n) < willing
        floor = np.where(random.random(n) < 0.5, random.integers(256, size=n), golden[request] & 255)
        inputs = {"reset": (reset, 1), "recv.val": (offered, 1), "recv.msg": (request, 18), "send.rdy": (taking, 1)}
        for path, value in (inputs | {"noise_floor": (floor, 8)}).items():
            gates[path] = packed(*value)
        gates.tick()
        moves = ~valid[-1] | taking
        ready = moves if interval == 1 else ~valid.any(0)
        if cycle:  # ahead of the first reset, nothing is known
            assert (unpacked(gates["recv.rdy"]) == ready).all(), cycle
            assert (unpacked(gates["send.val"]) == valid[-1]).all(), cycle
            assert (unpacked(gates["send.msg"]) == slots[-1])[valid[-1]].all(), cycle
        taken = offered & ready & ~reset
        response = golden[request] & ~np.where((golden[request] & 255) < floor, 1 << AMP_VALID, 0)
        valid[1:], valid[0] = np.where(moves, valid[:-1], valid[1:]), np.where(moves, taken, valid[0])
        slots[1:], slots[0] = np.where(moves, slots[:-1], slots[1:]), np.where(moves, response, slots[0])
        valid[:, reset] = False
        waiting = offered & ~ready & ~reset
        reset = random.random(n) < 0.01


class OneWrong(Component):
    """A divider whose phase is wrong for one vector at one noise floor."""

    def construct(s, config, vector, floor):
        s.recv, s.send, s.noise_floor = RecvIfcRTL(DivReq), SendIfcRTL(div_resp(config[1])), InPort(8)
        s.dut, s.hit = quad_divider(*config), Wire()
        s.dut.recv //= s.recv
        s.dut.noise_floor //= s.noise_floor
        s.dut.send.val //= s.send.val
        s.dut.send.rdy //= s.send.rdy
        x, y = vector

        @update
        def up_msg():
            s.send.msg @= s.dut.send.msg
            s.send.msg.phase @= s.dut.send.msg.phase ^ 1 if s.hit else s.dut.send.msg.phase

        @update_ff
        def up_hit():
            if s.recv.val & s.recv.rdy:
                s.hit <<= (s.recv.msg.x == x) & (s.recv.msg.y == y) & (s.noise_floor == floor)


def default(config, slow):
    return pytest.param(config, id=config[0], marks=[pytest.mark.slow] if slow else [])


class TestGates:
    verilog = "gates"  # recorders of the other levels leave it out

    @pytest.mark.slow
    @pytest.mark.parametrize("config", DEFAULTS, ids=lambda config: config[0])
    def test_every_request_at_every_noise_floor(self, config):
        order = np.random.default_rng(5).permutation(FLOORS).tolist()
        assert wrong_requests(Gates(quad_divider(*config), REQUESTS.size), config, order) == []

    @pytest.mark.parametrize("config", [default(config, config[0] != STANDARD.chip.divider) for config in DEFAULTS])
    @settings(max_examples=1, deadline=None)
    @given(seed=st.integers(0, 2**32))
    def test_stalls_and_resets(self, config, seed):
        check_random(Gates(quad_divider(*config), 1 << 12), config, seed)

    @pytest.mark.parametrize("config", [default(config, config[0] != STANDARD.chip.divider) for config in DEFAULTS])
    def test_every_vector_at_some_noise_floors(self, config):
        assert wrong_requests(Gates(quad_divider(*config), REQUESTS.size), config, SOME_FLOORS) == []

    @pytest.mark.slow
    @pytest.mark.parametrize(
        "config", [size for size in SIZES if size not in DEFAULTS], ids=lambda c: "-".join(map(str, c))
    )
    def test_every_vector_at_every_size(self, config):
        assert wrong_requests(Gates(quad_divider(*config), REQUESTS.size), config, SOME_FLOORS) == []
        check_random(Gates(quad_divider(*config), 1 << 12), config, 1, cycles=150)

    def test_finds_one_wrong_request(self):
        config = DEFAULTS[1]
        gates = Gates(OneWrong(config, (17, 3), 201), REQUESTS.size)
        assert wrong_requests(gates, config, [200, 202]) == []
        assert wrong_requests(gates, config, [7, 201]) == [(17, 3, 201)]
