"""PhasePath in cocotb: taps of any lanes at any pace, and resets, against the golden phase and amplitude."""

import random

import cocotb
import numpy as np

from talbot.models.digital.phase import phase_samples
from talbot.models.parameters import ChipParameters
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE, ScanMsg
from talbot.verif.bench.agents import Bench, Driver, Monitor, Stream, check

CHIP = ChipParameters(8, "radix4", 8)
LAST, LIMIT = 1 << 9, 20_000


def random_frame():
    """Return [(row, [step])]; a step is its four taps, each the samples of the enabled lanes."""

    def step():
        lanes = random.randint(1, CHIP.lanes)
        return [[random.choice((random.randrange(256), 0, 255, 128)) for _ in range(lanes)] for _ in range(4)]

    return [(random.randrange(1024), [step() for _ in range(random.randrange(4))]) for _ in range(random.randrange(4))]


def messages(frame, on, noise_floor):
    """Return (messages in, messages out) of a frame: lists of int."""
    sent, expected = [(FRAME, 0)], [(FRAME, 0)]
    for row, steps in frame:
        sent.append((ROW, row))
        expected.append((ROW, row))
        for taps in steps:
            for tap in taps:
                sent += [(SAMPLE, value | (LAST if i == len(tap) - 1 else 0)) for i, value in enumerate(tap)]
            if on:
                pairs = zip(*phase_samples(np.array(taps).T, CHIP, noise_floor))
                expected += [(SAMPLE, int(value)) for pair in pairs for value in pair]
            else:
                expected += [(SAMPLE, value) for tap in taps for value in tap]
    return tuple([int(ScanMsg(*message).to_bits()) for message in (*group, (END, 0))] for group in (sent, expected))


class PhasePathBench(Bench):
    def __init__(self, dut):
        self.source, self.sink = Driver(Stream(dut, "recv"), random), Monitor(Stream(dut, "send"), random)
        super().__init__(dut, self.source, self.sink)

    async def begin(self, reset=True):
        """Reset, or begin after the frame before, with a new configuration; returns the expected messages."""
        on, noise_floor = random.random() < 0.8, random.choice((0, 1, 20, 255))
        self.dut.on.value, self.dut.noise_floor.value = int(on), noise_floor
        self.source.pace, self.sink.pace = (random.choice((0.1, 0.5, 0.9, 1)) for _ in range(2))
        await self.again(reset)
        self.source.items, expected = messages(random_frame(), on, noise_floor)
        return expected

    async def frame(self, reset=True):
        expected = await self.begin(reset)
        await self.until(lambda: self.source.done and self.sink.quiet > 60, LIMIT)
        check(self.sink.items, expected)


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def any_taps_at_any_pace(dut):
    bench = PhasePathBench(dut)
    await bench.frame()
    for _ in range(25):
        await bench.frame(reset=random.random() < 0.2)


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def reset_in_the_middle_of_anything(dut):
    bench = PhasePathBench(dut)
    for _ in range(15):
        await bench.begin()
        for _ in range(random.randrange(1, 120)):
            await bench.cycle()
        await bench.frame()
