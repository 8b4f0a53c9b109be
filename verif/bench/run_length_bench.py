"""RunLength in cocotb: frames of every kind at any pace, and resets, against the golden encoder."""

import random

import cocotb

from talbot.models.digital.stream import StreamHeader, encode_frame
from talbot.models.digital.stream.test.frames import ports_of, samples_of
from talbot.models.parameters import MODES, FrameParameters, Window
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE, ScanMsg
from talbot.verif.bench.agents import Bench, Driver, Monitor, Stream, check

ROWS, COLS, LANES = 12, 36, 4
LIMIT = 60_000


def random_header():
    """Return the header of a random configuration of the small chip."""
    mode = random.choice(MODES)
    row0, row1 = sorted(random.choices(range(3), k=2))
    col0, col1 = sorted(random.choices(range(6), k=2))
    frame = FrameParameters(
        Window(row0, row1, col0, col1),
        mode,
        random.choice([2**24 - 1, 0xF0F, 0x800001]),
        random.randrange(128),
        random.randrange(4),
        mode == "tof" and random.random() < 0.5,
        frame_number=random.randrange(1 << 16),
        resync=random.randrange(4),
        calibration=random.randrange(1 << 8),
    )
    return StreamHeader.from_frame(ROWS, COLS, LANES, frame)


def messages(header, samples):
    """Return the scan's messages of a frame: list of int."""
    layout, out = header.layout(), [(FRAME, 0)]
    for i, row in enumerate(layout.rows.tolist()):
        codes = samples.reshape(header.rows, -1)[row, layout.places_of(i)]
        out += [(ROW, row), *((SAMPLE, int(code) & 0xFF) for code in codes)]
    return [int(ScanMsg(kind, data).to_bits()) for kind, data in (*out, (END, 0))]


class RunLengthBench(Bench):
    def __init__(self, dut):
        self.source, self.sink = Driver(Stream(dut, "recv"), random), Monitor(Stream(dut, "send"), random)
        super().__init__(dut, self.source, self.sink)

    async def begin(self, header, made, left_out):
        """Reset with the configuration of a frame at the ports."""
        counts = {"made": made, "left_out": left_out}
        for name, value in (ports_of(header) | counts).items():
            getattr(self.dut, name).value = value
        self.source.pace, self.sink.pace = (random.choice((0.1, 0.5, 0.9, 1)) for _ in range(2))
        await self.reset()

    async def frames(self, count):
        """``count`` frames on end of one configuration, after a reset."""
        header, made, left_out = random_header(), random.getrandbits(32), random.getrandbits(32)
        samples = samples_of(header, random.randrange(999), random.random(), random.choice((3, 30, 300)))
        await self.begin(header, made, left_out)
        self.source.items = messages(header, samples) * count
        await self.until(lambda: self.source.done and self.sink.quiet > 60, LIMIT)
        check(self.sink.items, encode_frame(header, samples, made, left_out) * count)


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def any_frame_at_any_pace(dut):
    bench = RunLengthBench(dut)
    for _ in range(8):
        await bench.frames(random.choice((1, 1, 2)))


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def reset_in_the_middle_of_anything(dut):
    bench = RunLengthBench(dut)
    for _ in range(6):
        header = random_header()
        await bench.begin(header, 1, 2)
        bench.source.items = messages(header, samples_of(header, 1))
        for _ in range(random.randrange(1, 300)):
            await bench.cycle()
        await bench.frames(1)
