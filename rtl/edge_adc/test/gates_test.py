"""EdgeAdc as gates: every threshold with every sequence of answers and every level, and random lanes, in parallel."""

from itertools import product

import numpy as np
import pytest

from talbot.models.digital.sar import convert
from talbot.rtl.edge_adc import EdgeAdc
from talbot.rtl.edge_adc.edge_adc_cl import LaneCycles
from talbot.rtl.edge_adc.test.many_lanes import ManyLanes
from talbot.rtl.harness.gates import Gates, packed, unpacked

COPIES = 1 << 17


@pytest.fixture(scope="module")
def gates():
    return Gates(EdgeAdc(), COPIES)


def cycle(gates, lanes, go, unsigned, threshold, ternary, comparator, rdy, reset):
    """Run a cycle of the gates and of ``lanes``, which must agree; ``comparator``: a function of the DAC codes."""
    lanes.look(unsigned, threshold, ternary)
    answers = comparator(lanes.dac)
    for name, value, width in (
        ("go", go, 1),
        ("unsigned_", unsigned, 1),
        ("threshold", threshold, 7),
        ("ternary", ternary, 1),
        ("comparator", answers, 1),
        ("out.rdy", rdy, 1),
        ("reset", reset, 1),
    ):
        gates[name] = packed(value, width) if isinstance(value, np.ndarray) else int(value)
    gates.tick()
    expected = {"busy": lanes.busy, "free": lanes.free, "out.val": lanes.ready > 0}
    for name, value in expected.items():
        assert (gates[name] == packed(value)).all(), name
    for mask, pairs in (
        (lanes.running, (("dac", lanes.dac),)),
        (lanes.ready > 0, (("out.msg", lanes.elder & 0xFF), ("converted", lanes.elder >> 8))),
    ):
        for name, value in pairs:
            got = gates[name]
            wrong = np.bitwise_or.reduce((got ^ packed(value, len(got))) & packed(mask), 0)
            if wrong.any():
                at = np.flatnonzero(unpacked(wrong[None]))[0]
                at = [np.ravel(x)[at] for x in np.broadcast_arrays(unsigned, threshold, ternary)]
                raise AssertionError(f"{name}: unsigned, threshold, ternary = {at}")
    lanes.tick(go, answers, rdy, reset)


def begin(gates):
    """Reset from any registers; the outputs follow from then on."""
    zero, none = np.zeros(COPIES, np.int16), np.zeros(COPIES, bool)
    gates["reset"] = 1
    gates.tick()
    gates["reset"] = 0
    lanes = ManyLanes(COPIES)
    cycle(gates, lanes, none, none, zero, none, lambda dac: none, none, none)
    assert not gates["dac"].any() and not gates["converted"].any()
    return lanes


def test_every_threshold_and_every_sequence_of_answers(gates):
    """Consistent and inconsistent ones, as from a noisy comparator; signed, unsigned and ternary."""
    at, yes, lanes = np.arange(COPIES), np.ones(COPIES, bool), begin(gates)
    other = at * 0x2545F % COPIES
    for turn, unsigned, ternary in (at, ~yes, ~yes), (other, yes, ~yes), (other, ~yes, yes), (at, yes, yes):
        threshold, answers = turn >> 10, turn & 1023
        for number in range(-1, 12):
            given = answers >> np.clip(9 - number, 0, 9) & 1 == 1
            cycle(gates, lanes, yes if number < 0 else ~yes, unsigned, threshold, ternary, lambda dac: given, yes, ~yes)


def test_every_level_of_an_ideal_comparator(gates):
    """Values at and near every level, at every threshold: the code is the golden model's."""
    signed, thresholds = np.arange(-130.5, 130, 0.25), (0, 1, 127)
    sets = [
        *product((False,), range(128), (False,), signed[signed % 1 > 0.1]),
        *product((True,), thresholds, (False,), np.arange(-1, 258, 0.25)),
        *product((False,), thresholds, (True,), signed[signed % 1 > 0.1]),
    ]
    assert len(sets) <= COPIES
    unsigned, threshold, ternary, value = (np.resize(np.array(x), COPIES) for x in zip(*sets))
    golden = np.zeros(COPIES, np.int64)
    for u, t, only in {(u, t, only) for u, t, only, _ in sets}:
        mine = (unsigned == u) & (threshold == t) & (ternary == only)
        found = convert(value[mine], u, t, ternary=only)
        golden[mine] = found.converted.astype(np.int64) << 8 | found.codes & 0xFF
    lanes, yes = begin(gates), np.ones(COPIES, bool)
    for number in range(-1, 11):
        cycle(
            gates,
            lanes,
            yes if number < 0 else ~yes,
            unsigned,
            threshold,
            ternary,
            lambda dac: value >= dac - np.where(unsigned, 0, 128) - 0.5,
            ~yes,
            ~yes,
        )
    assert (lanes.ready == 1).all() and (lanes.elder == golden).all()


def test_any_go_any_rdy_and_any_reset(gates):
    """The configuration changes in every lane that is idle."""
    random = np.random.default_rng(1)
    lanes, threshold = begin(gates), np.zeros(COPIES, np.int64)
    unsigned, ternary = np.zeros((2, COPIES), bool)
    often = random.random((3, COPIES))
    for _ in range(40):
        chance = random.random((3, COPIES), np.float32)
        lanes.look(unsigned, threshold, ternary)
        change = ~lanes.busy & (chance[0] < 0.5)
        threshold = np.where(change, random.integers(0, 128, COPIES), threshold)
        unsigned = np.where(change, chance[1] < 0.2, unsigned)
        ternary = np.where(change, chance[2] < 0.3, ternary)
        go, rdy, reset = chance[0] < often[0] + 0.1, chance[1] < often[1], chance[2] < 0.03 * often[2]
        given = random.integers(0, 2, COPIES) == 1
        cycle(gates, lanes, go, unsigned, threshold, ternary, lambda dac: given, rdy, reset)


def test_many_lanes_are_lanes():
    """The reference of these tests has the cycles of LaneCycles."""
    random, many, single = np.random.default_rng(1), ManyLanes(32), [LaneCycles() for _ in range(32)]
    threshold, unsigned = random.integers(0, 2, 32) * random.integers(0, 128, 32), random.integers(0, 3, 32) == 0
    ternary = random.integers(0, 3, 32) == 0
    for _ in range(400):
        many.look(unsigned, threshold, ternary)
        go, rdy, given = random.integers(0, 2, (3, 32)) == 1
        for i, lane in enumerate(single):
            assert (lane.busy, lane.free, lane.result is not None) == (many.busy[i], many.free[i], many.ready[i] > 0)
            assert not lane.run or lane.dac == many.dac[i]
            assert lane.result is None or lane.result[0] & 0xFF | lane.result[1] << 8 == many.elder[i]
            lane.tick(go[i], unsigned[i], int(threshold[i]), ternary[i], given[i], lane.result is not None and rdy[i])
        many.tick(go, given, rdy, np.zeros(32, bool))
