"""PhasePath as gates: consecutive frames with changes of `on` and the noise floor, many copies in parallel."""

from itertools import product

import numpy as np
import pytest

from talbot.models.digital.phase import phase_samples
from talbot.models.parameters import ChipParameters
from talbot.rtl.harness.gates import WIDE, Gates, packed, unpacked
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.rtl.phase_path import PhasePath

CHIPS = [
    ChipParameters(1, "radix2", 13),
    ChipParameters(2, "cordic", 8, 7),
    *(ChipParameters(lanes, divider) for lanes, divider in product((1, 2, 4, 8), ("radix4", "pipelined"))),
    ChipParameters(16, "radix2"),
    ChipParameters(32, "cordic"),
]
FRAMES, SCRIPTS = 6, 32  # frames of a script; scripts, each run by several copies at different paces
LAST = 1 << 9
PATIENCE = 120  # cycles in which a message moves, where both sides are willing


def frame(random, chip, on, noise_floor):
    """Return (messages in, messages out) of a random frame."""
    sent, expected = [(FRAME, 0)], [(FRAME, 0)]
    for _ in range(random.integers(3)):
        row = int(random.integers(1024))
        sent.append((ROW, row))
        expected.append((ROW, row))
        for _ in range(random.integers(4)):
            samples = chip.lanes if random.random() < 0.5 else random.integers(1, chip.lanes + 1)
            shape = 4 if on else random.integers(1, 5), samples  # other modes have one tap
            taps = np.where(
                random.random(shape) < 0.3, random.choice((0, 1, 255), shape), random.integers(256, size=shape)
            )
            at_floor = random.random(samples) < 0.2
            taps[:, at_floor] = 0
            taps[0, at_floor] = max(noise_floor - random.integers(2), 0)
            sent += [(SAMPLE, int(tap[i]) | LAST * (i == samples - 1)) for tap in taps for i in range(samples)]
            out = np.stack(phase_samples(taps.T, chip, noise_floor), 1) if on else taps
            expected += [(SAMPLE, int(value)) for value in out.ravel()]
    return [[kind << 10 | data for kind, data in [*group, (END, 0)]] for group in (sent, expected)]


class Scripts:
    """SCRIPTS sequences of FRAMES random frames, as arrays: a row for each script.

    sent, expected: messages. ends: the number of messages up to the end of each frame, in and out. on, floor: of each
    frame; the last column repeats.
    """

    def __init__(self, random, chip):
        self.on = random.random((SCRIPTS, FRAMES + 1)) < 0.6
        self.floor = random.choice((0, 1, 20, 128, 201, 255), (SCRIPTS, FRAMES + 1))
        frames = [
            [frame(random, chip, self.on[s, f], int(self.floor[s, f])) for f in range(FRAMES)] for s in range(SCRIPTS)
        ]
        self.ends = np.cumsum([[[len(group) for group in pair] for pair in script] for script in frames], axis=1)
        size = self.ends.max() + 1
        self.sent, self.expected = np.zeros((2, SCRIPTS, size), np.int64)
        for s, script in enumerate(frames):
            for array, groups in zip((self.sent, self.expected), zip(*script)):
                flat = [message for group in groups for message in group]
                array[s, : len(flat)] = flat


def check(chip, seed):
    """Check every message in every cycle, and progress: a reset would also end a frame that hangs."""
    random = np.random.default_rng(seed)
    gates = Gates(PhasePath(chip.lanes, chip.divider, chip.n_frac, chip.cordic_iterations), WIDE)
    scripts, script = Scripts(random, chip), np.arange(WIDE) % SCRIPTS
    number, between = np.zeros(WIDE, int), np.ones(WIDE, bool)  # of the frame; nothing of it has been offered
    taken_in, sent_out = np.zeros(WIDE, int), np.zeros(WIDE, int)
    waiting, stuck, reset = np.zeros(WIDE, bool), np.zeros(WIDE, bool), np.ones(WIDE, bool)
    pace, asleep = np.ones((2, WIDE)), np.zeros(WIDE, int)
    for cycle in range(20_000):
        busy = number < FRAMES
        if not busy.any():
            return
        pace = np.where(random.random((2, WIDE)) < 0.03, random.choice((0, 0.3, 0.8, 1, 1), (2, WIDE)), pace)
        between &= ~(busy & (random.random(WIDE) < 0.3) & ~reset)
        at = np.minimum(number, FRAMES - 1)
        end_in, end_out = scripts.ends[script, at].T
        offered = ~between & (taken_in < end_in) & (waiting | (random.random(WIDE) < pace[0]))
        ready = random.random(WIDE) < pace[1]
        on = np.where(between, random.random(WIDE) < 0.5, scripts.on[script, number])
        floor = np.where(between, random.integers(256, size=WIDE), scripts.floor[script, number])
        inputs = {"recv.val": (offered, 1), "recv.msg": (scripts.sent[script, taken_in], 12), "send.rdy": (ready, 1)}
        for path, value in (inputs | {"on": (on, 1), "noise_floor": (floor, 8), "reset": (reset, 1)}).items():
            gates[path] = packed(*value)
        gates.tick()
        valid, room = unpacked(gates["send.val"]) == 1, unpacked(gates["recv.rdy"]) == 1
        if cycle:  # ahead of the first reset, nothing is known
            right = unpacked(gates["send.msg"]) == scripts.expected[script, sent_out]
            assert (~valid | right & ~between & (sent_out < end_out)).all(), f"a wrong message in cycle {cycle}"
            assert (valid | ~stuck).all(), f"a message is withdrawn in cycle {cycle}"
        moves = offered & room | valid & ready
        asleep = np.where(moves | between | reset | (pace == 0).any(0), 0, asleep + 1)
        assert (asleep < PATIENCE).all(), f"nothing moves up to cycle {cycle}"
        taken_in += offered & room & ~reset
        sent_out += valid & ready & ~reset
        waiting, stuck = offered & ~room & ~reset, valid & ~ready & ~reset
        ended = busy & ((sent_out == end_out) | (reset & ~between))
        assert (taken_in == end_in)[ended & ~reset].all()
        taken_in, sent_out = np.where(ended, end_in, taken_in), np.where(ended, end_out, sent_out)
        number, between = number + ended, between | ended
        reset = random.random(WIDE) < 0.002
    raise AssertionError(f"{busy.sum()} copies do not end")


class TestGates:
    verilog = "gates"  # recorders of the other levels leave it out

    @pytest.mark.slow
    @pytest.mark.parametrize("chip", CHIPS, ids=lambda chip: f"{chip.lanes}-{chip.divider}")
    def test_frames_one_after_the_other(self, chip):
        check(chip, 1)
