"""The dividers in cocotb: any requests at any pace, and resets, against the golden functions."""

import os
import random

import cocotb

from talbot.rtl.messages import DivReq
from talbot.rtl.quad_divider.quad_divider_fl import response
from talbot.verif.bench.agents import Bench, Driver, Monitor, Stream, check

VARIANT, N_FRAC, ITERATIONS = os.environ.get("BENCH_VARIANT", "radix4"), 8, 10
EDGES = (-256, -255, -128, -127, -1, 0, 1, 127, 128, 254, 255)
LIMIT = 50_000


def random_request():
    return DivReq(*(random.choice((random.choice(EDGES), random.randrange(-256, 256))) for _ in range(2)))


class DividerBench(Bench):
    def __init__(self, dut):
        self.source, self.sink = Driver(Stream(dut, "recv"), random), Monitor(Stream(dut, "send"), random)
        super().__init__(dut, self.source, self.sink)

    async def begin(self, count, reset=True):
        """Reset or go on, with ``count`` requests to make and a noise floor at the port; returns the responses."""
        floor = random.choice((0, 1, 40, 201, 255))
        self.dut.noise_floor.value = floor
        self.source.pace, self.sink.pace = (random.choice((0.1, 0.5, 1)) for _ in range(2))
        await self.again(reset)
        requests = [random_request() for _ in range(count)]
        self.source.items = [int(request.to_bits()) for request in requests]
        return [int(response(VARIANT, N_FRAC, ITERATIONS, request, floor).to_bits()) for request in requests]

    async def requests(self, count, reset=True):
        expected = await self.begin(count, reset)
        await self.until(lambda: self.source.done and self.sink.quiet > 60, LIMIT)
        check(self.sink.items, expected)


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def any_requests_at_any_pace(dut):
    bench = DividerBench(dut)
    await bench.requests(60)
    for _ in range(11):
        await bench.requests(60, reset=random.random() < 0.2)


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def reset_in_the_middle_of_anything(dut):
    bench = DividerBench(dut)
    for _ in range(20):
        await bench.begin(40)
        for _ in range(random.randrange(1, 60)):
            await bench.cycle()
        await bench.requests(5)
