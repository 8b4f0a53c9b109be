"""The chip in cocotb with an SPI host, a link and the real-number front end at its pins: golden bytes."""

import contextlib
import random

import cocotb

from talbot.models.chip import golden_frame
from talbot.models.digital.host import command, decode_status, frame_writes, status_transfers, write_transfers
from talbot.models.digital.pattern import PatternEnd
from talbot.models.parameters.registers import register_map
from talbot.verif.bench.agents import Bench, Monitor, Spi, Stopped, Stream, check, known
from talbot.verif.bench.exposure import FRAMES, FRONT_END, SENSOR, TRIMS, samples

CHIP = register_map()
LIMIT = 60_000


class Phases:
    """Checks that at most one phase of the amplifiers is high."""

    def __init__(self, dut):
        self.pins = dut.pixel_reset, dut.integrate, dut.cm_reset, dut.read

    def drive(self):
        """It only looks."""

    rest = drive

    def sample(self):
        on = [pin._name for pin in self.pins if known(pin)]
        assert len(on) <= 1, f"together: {', '.join(on)}"


class ChipBench(Bench):
    def __init__(self, dut):
        self.link = Monitor(Stream(dut, "link_", ("val", "rdy", "data")), random)
        super().__init__(dut, self.link, Phases(dut))
        self.spi = Spi(self)
        self.agents.append(self.spi)

    async def begin(self):
        """Reset: the registers are those of the map again."""
        self.link.pace = random.choice((0.2, 0.7, 1))
        await self.reset()
        await self.spi.wait(self.spi.half)
        reset = {"row1": SENSOR.full_window.row1, "col1": SENSOR.full_window.col1}
        self.registers = CHIP.image(CHIP.configuration, reset)

    async def write(self, frame):
        """The frame's configuration that differs from the registers."""
        writes = [w for w in frame_writes(frame, TRIMS) if self.registers.get(w[0]) != w[1]]
        for transfer in write_transfers(writes):
            await self.spi.transfer(transfer)
        self.registers.update(writes)

    async def start(self):
        await self.spi.transfer(command("start"))

    async def frame(self, frame):
        """A whole frame, from its configuration to the counters."""
        await self.write(frame)
        await self.start()
        await self.until(lambda: not known(self.dut.busy), LIMIT)
        got, self.link.items = self.link.items, []
        end = PatternEnd(SENSOR.array.rows, SENSOR.array.cols) if frame.test_pattern else FRONT_END
        golden = golden_frame(None if frame.test_pattern else samples(), SENSOR, frame, end)
        check(got, golden.stream)
        status = decode_status([await self.spi.transfer(transfer) for transfer in status_transfers()])
        assert status.pop("cycles") > 0
        assert status == {
            "busy": False,
            "done": True,
            "cfg_err": False,
            "amp_err": False,
            "refused": False,
            "aborted": False,
            "conversions_made": golden.made,
            "conversions_left_out": golden.left_out,
        }


@cocotb.test(timeout_time=5, timeout_unit="ms")
async def every_frame(dut):
    """One after the other, no reset between them."""
    bench = ChipBench(dut)
    await bench.begin()
    for name in random.sample(sorted(FRAMES), len(FRAMES)):
        cocotb.log.info(name)
        await bench.frame(FRAMES[name])


@cocotb.test(timeout_time=5, timeout_unit="ms")
async def reset_in_the_middle_of_anything(dut):
    """Of a transfer, of the start, of rows and of the trailer: the frame after it is whole."""
    bench = ChipBench(dut)
    for _ in range(5):
        await bench.begin()
        bench.stop = bench.cycles + random.randrange(9000)
        with contextlib.suppress(Stopped):
            await bench.frame(FRAMES[random.choice(("edge", "raw, a window", "test pattern"))])
        bench.stop = None
    await bench.begin()
    await bench.frame(FRAMES["edge"])
