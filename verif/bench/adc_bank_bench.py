"""AdcBank in cocotb: steps of any lanes at any pace, with comparators, against the golden search."""

import random

import cocotb
import numpy as np

from talbot.models.digital.sar import convert
from talbot.models.parameters import MODES, SIGNED
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE, ScanMsg, step_msg
from talbot.verif.bench.agents import Bench, Driver, Monitor, Stream, check, known

LANES = 8
LAST, LIMIT = 1 << 9, 30_000
Step = step_msg(LANES)


class Comparators:
    """Sample-and-holds and comparators of the lanes: held >= level(dac) (docs/chip.md).

    values: dict (row, group, k, sub, lane) -> held value in LSB.
    """

    def __init__(self, dut, values):
        self.dut, self.values = dut, values
        self.rest()

    def rest(self):
        self.held = [0.0] * LANES
        self.dut.comparator.value = 0

    def drive(self):
        dac, base = known(self.dut.dac), 0.5 if known(self.dut.unsigned_) else 128.5
        self.dut.comparator.value = sum(
            (held >= (dac >> 8 * lane & 0xFF) - base) << lane for lane, held in enumerate(self.held)
        )

    def sample(self):
        if known(self.dut.hold):
            at = tuple(known(getattr(self.dut, name)) for name in ("row", "group", "k", "sub"))
            for lane in range(LANES):
                if known(self.dut.en) >> lane & 1:
                    self.held[lane] = self.values[*at, lane]


class AdcBankBench(Bench):
    def __init__(self, dut):
        self.values = {}
        self.source, self.sink = Driver(Stream(dut, "step"), random), Monitor(Stream(dut, "scan"), random)
        super().__init__(dut, Comparators(dut, self.values), self.source, self.sink)

    async def begin(self):
        """Reset, a configuration at the ports and a frame of steps to make; returns (messages, made, left out)."""
        mode, threshold = random.choice(MODES), random.randrange(128)
        self.dut.mode.value, self.dut.threshold.value = MODES.index(mode), threshold
        self.source.pace, self.sink.pace = (random.choice((0.1, 0.5, 1)) for _ in range(2))
        await self.reset()
        steps, out, made, left_out = [Step(FRAME, 0, 0, 0, 0, 0)], [ScanMsg(FRAME, 0)], 0, 0
        self.values.clear()
        for row in sorted(random.sample(range(1024), random.randrange(1, 4))):
            steps.append(Step(ROW, row, 0, 0, 0, 0))
            out.append(ScanMsg(ROW, row))
            for place in sorted(random.sample(range(48), random.randrange(1, 12))):
                at, en = (row, place // 6, place % 6, random.randrange(4)), random.randrange(1, 1 << LANES)
                steps.append(Step(SAMPLE, *at, en))
                lanes = [lane for lane in range(LANES) if en >> lane & 1]
                held = np.array([random.choice((random.uniform(-140, 300), random.uniform(-20, 20))) for _ in lanes])
                self.values.update({(*at, lane): float(value) for lane, value in zip(lanes, held)})
                got = convert(held, mode not in SIGNED, threshold, ternary=mode == "ternary")
                out += [
                    ScanMsg(SAMPLE, int(code) & 0xFF | (LAST if lane == lanes[-1] else 0))
                    for lane, code in zip(lanes, got.codes)
                ]
                made, left_out = made + int(got.converted.sum()), left_out + int((~got.converted).sum())
        self.source.items = [int(step.to_bits()) for step in (*steps, Step(END, 0, 0, 0, 0, 0))]
        return [int(message.to_bits()) for message in (*out, ScanMsg(END, 0))], made, left_out

    async def frame(self):
        expected, made, left_out = await self.begin()
        await self.until(lambda: self.source.done and self.sink.quiet > 60 and known(self.dut.idle), LIMIT)
        check(self.sink.items, expected)
        assert (known(self.dut.made), known(self.dut.left_out)) == (made, left_out)


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def any_steps_at_any_pace(dut):
    bench = AdcBankBench(dut)
    for _ in range(12):
        await bench.frame()


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def reset_in_the_middle_of_anything(dut):
    bench = AdcBankBench(dut)
    for _ in range(8):
        await bench.begin()
        for _ in range(random.randrange(1, 200)):
            await bench.cycle()
        await bench.frame()
