"""AdcBank as gates with any number of lanes, many banks in parallel: every output in every cycle.

The comparators answer at random, so every lane has different codes; the steps come in any order.
"""

import numpy as np
import pytest

from talbot.rtl.adc_bank import AdcBank
from talbot.rtl.edge_adc.test.many_lanes import ManyLanes
from talbot.rtl.harness.gates import WIDE, Gates, packed
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE

FIELDS = {"kind": 2, "row": 10, "group": 8, "k": 3, "sub": 2}  # of a StepMsg, then `en`


class ManyBanks:
    """Model of ``copies`` banks after README.md; rtl/edge_adc/test compares ManyLanes with the golden model."""

    def __init__(self, lanes, copies):
        self.each = np.arange(lanes)[:, None]
        self.lanes = ManyLanes((lanes, copies))
        self.pins = {name: np.zeros(copies, np.int64) for name in (*FIELDS, "en")}
        self.hold, self.waits, self.mark = (np.zeros(copies, bool) for _ in range(3))  # waits: a step is at the pins
        self.kind, self.row, self.remaining, self.made, self.left_out = (np.zeros(copies, np.int64) for _ in range(5))

    def look(self, mode, threshold):
        """Compute what depends on registers and the configuration."""
        self.lanes.look(mode & 3 != 0, threshold, mode == 4)
        self.rdy = ~self.hold & ~self.waits & self.lanes.free.all(0)
        self.idle = ~self.hold & ~self.lanes.busy.any(0)
        self.turn = self.remaining & -self.remaining
        self.mine = (self.turn >> self.each & 1).astype(bool)
        self.last = self.turn == self.remaining
        self.val = self.mark | (self.mine & (self.lanes.ready > 0)).any(0)
        self.result = np.where(self.mine, self.lanes.elder, 0).sum(0)  # converted << 8 | code
        sample = SAMPLE << 10 | self.last.astype(int) << 9 | self.result & 0xFF
        self.msg = np.where(self.mark, self.kind << 10 | self.row, sample)

    def tick(self, val, step, comparator, rdy, reset):
        """End the cycle that `look` computed; ``step``: by field."""
        sent, take = self.val & rdy, val & self.rdy
        go = self.hold & (self.pins["en"] >> self.each & 1).astype(bool)
        self.lanes.tick(go, comparator, self.mine & rdy, reset)
        clear, counted = sent & self.mark & (self.kind == FRAME), sent & ~self.mark
        converted = self.result >> 8 == 1
        self.made = np.where(clear | reset, 0, self.made + (counted & converted))
        self.left_out = np.where(clear | reset, 0, self.left_out + (counted & ~converted))
        moves = ~self.mark & (self.remaining == 0) | sent & (self.mark | self.last)
        leaves, samples = moves & self.waits, self.pins["kind"] == SAMPLE
        self.mark = ~reset & np.where(leaves, ~samples, self.mark & ~sent)
        self.remaining = np.where(leaves & samples, self.pins["en"], self.remaining & ~np.where(counted, self.turn, 0))
        self.remaining[reset] = 0
        self.kind, self.row = (
            np.where(leaves, self.pins[n], old) for n, old in (("kind", self.kind), ("row", self.row))
        )
        self.hold = ~reset & take & (step["kind"] == SAMPLE)
        self.waits = ~reset & (take | self.waits & ~moves)
        self.pins = {n: np.where(reset, 0, np.where(take, step[n], old)) for n, old in self.pins.items()}


class Pair:
    """The gates and their reference, cycle by cycle."""

    def __init__(self, lanes, copies):
        self.count, self.copies = lanes, copies
        self.gates, self.banks = Gates(AdcBank(lanes), copies), ManyBanks(lanes, copies)
        self.gates["reset"] = 1
        self.gates.tick()

    def cycle(self, mode, threshold, val, step, comparator, rdy, reset):
        """A cycle with these inputs, each an array of the copies or one value; comparator: (lanes, copies)."""
        banks, gates, number = self.banks, self.gates, 0
        banks.look(mode, threshold)
        for name, width in FIELDS.items():
            number = number << width | step[name]
        message = np.concatenate([packed(step["en"], self.count), packed(number, sum(FIELDS.values()))])
        gates["step.msg"], gates["step.val"], gates["scan.rdy"] = message, packed(val), packed(rdy)
        gates["mode"], gates["threshold"], gates["reset"] = packed(mode, 3), packed(threshold, 7), packed(reset)
        gates["comparator"] = np.concatenate([packed(answer) for answer in comparator])
        gates.tick()
        outputs = {"step.rdy": banks.rdy, "scan.val": banks.val, "idle": banks.idle, "hold": banks.hold}
        outputs |= {name: banks.pins[name] for name in ("row", "group", "k", "sub", "en")}
        outputs |= {"unsigned_": mode & 3 != 0, "made": banks.made, "left_out": banks.left_out}
        for name, value in outputs.items():
            got = gates[name]
            assert (got == packed(value, len(got))).all(), name
        assert not ((gates["scan.msg"] ^ packed(banks.msg, 12)) & packed(banks.val)).any()
        for lane in range(self.count):
            wrong = gates["dac"][8 * lane : 8 * lane + 8] ^ packed(banks.lanes.dac[lane], 8)
            assert not (wrong & packed(banks.lanes.running[lane])).any(), f"dac of lane {lane}"
        banks.tick(val, step, comparator, rdy, reset)


@pytest.mark.slow
@pytest.mark.parametrize("lanes, copies, cycles", [(8, 4096, 70), *((lanes, WIDE, 150) for lanes in (1, 2, 4, 16, 32))])
def test_any_steps_any_stalls_and_any_resets(lanes, copies, cycles):
    """Every pattern of `en` at 8 lanes, some hundred times; the configuration changes while a bank is empty."""
    random, pair = np.random.default_rng(lanes), Pair(lanes, copies)
    share = random.random((3, copies)) ** 0.5
    share[:2, : copies // 4] = 1  # without a stall
    mode, threshold = np.zeros((2, copies), np.int16)
    step = None
    for _ in range(cycles):
        banks, chance = pair.banks, random.random((5, copies), np.float32)
        banks.look(mode, threshold)
        empty = banks.idle & ~banks.waits & ~banks.mark & (banks.remaining == 0) & (chance[4] < 0.5)
        mode = np.where(empty, random.choice((0, 0, 0, 4, 4, 1, 2, 3, 5, 7), copies), mode)
        threshold = np.where(empty, random.integers(0, 128, copies), threshold)
        new = {name: random.integers(0, 1 << width, copies) for name, width in (FIELDS | {"en": lanes}).items()}
        new["kind"] = random.choice((FRAME, ROW, END, *[SAMPLE] * 12), copies)
        few = (1 << random.integers(lanes, size=(2, copies))).sum(0) & (1 << lanes) - 1  # one lane, two or none
        new["en"] = np.where(random.random(copies) < 0.4, few, new["en"])
        step = {name: np.where(banks.rdy, value, step[name]) if step else value for name, value in new.items()}
        reset = (chance[2] < 0.01) & (share[2] < 0.5)
        pair.cycle(
            mode,
            threshold,
            chance[0] < share[0],
            step,
            random.random((lanes, copies)) < 0.5,
            chance[1] < share[1],
            reset,
        )
