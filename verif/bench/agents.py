"""What surrounds a design in cocotb: cycles, streams' sources and sinks, an SPI host, a comparison.

Agents are called twice a cycle: `drive` ahead of it, with registers settled after the clock edge; `sample` in it, with
everything settled ahead of the next edge. So a bench is the same in every simulator, whatever its scheduling.
"""

from cocotb.triggers import Timer

HALF = 5  # ns of half a clock


def known(handle):
    """Value of a signal: int. AssertionError where a bit of it is X or Z."""
    value = handle.value
    assert value.is_resolvable, f"{handle._name} = {value}: X or Z"
    return int(value)


class Stopped(Exception):
    """The cycle at which a bench was to stop."""


class Bench:
    """A design and its agents, in the order in which they are called. stop: cycle that raises Stopped, or None."""

    def __init__(self, dut, *agents):
        self.dut, self.agents, self.cycles, self.stop = dut, list(agents), 0, None
        dut.clk.value = 0
        dut.reset.value = 1

    async def cycle(self):
        if self.cycles == self.stop:
            raise Stopped
        self.dut.clk.value = 0
        for agent in self.agents:
            agent.drive()
        await Timer(HALF, "ns")
        for agent in self.agents:
            agent.sample()
        self.cycles += 1
        self.dut.clk.value = 1
        await Timer(HALF, "ns")

    async def reset(self, cycles=2):
        """A reset as long as ``cycles``; agents rest in it and begin anew."""
        self.dut.reset.value = 1
        for agent in self.agents:
            agent.rest()
        for _ in range(cycles):
            self.dut.clk.value = 0
            await Timer(HALF, "ns")
            self.dut.clk.value = 1
            await Timer(HALF, "ns")
        self.dut.reset.value = 0

    async def until(self, done, limit):
        """Cycles until ``done()``; AssertionError after ``limit`` of them."""
        for _ in range(limit):
            if done():
                return
            await self.cycle()
        assert done(), f"no end after {limit} cycles"


class Stream:
    """The signals of a val/rdy stream of ``dut``: recv__val, recv__rdy and recv__msg, or what ``parts`` names."""

    def __init__(self, dut, name, parts=("__val", "__rdy", "__msg")):
        self.val, self.rdy, self.msg = (getattr(dut, f"{name}{part}") for part in parts)


class Driver:
    """Offers ``items`` (ints), in a share ``pace`` of the cycles; what is offered stays until it is taken."""

    def __init__(self, stream, random, items=(), pace=1.0):
        self.stream, self.random, self.items, self.pace = stream, random, list(items), pace
        self.rest()

    def rest(self):
        self.sent, self.offered = 0, False
        self.stream.val.value = 0
        self.stream.msg.value = 0

    def drive(self):
        self.offered = self.sent < len(self.items) and (self.offered or self.random.random() < self.pace)
        self.stream.val.value = int(self.offered)
        # an idle stream's msg says nothing, so it may say anything
        self.stream.msg.value = self.items[self.sent] if self.offered else self.random.getrandbits(len(self.stream.msg))

    def sample(self):
        if known(self.stream.rdy) and self.offered:
            self.sent += 1
            self.offered = False

    @property
    def done(self):
        return self.sent == len(self.items)


class Monitor:
    """Takes what a stream offers, in a share ``pace`` of the cycles: `items`. An offer must stand until it is taken."""

    def __init__(self, stream, random, pace=1.0):
        self.stream, self.random, self.pace = stream, random, pace
        self.rest()

    def rest(self):
        self.items, self.standing, self.ready, self.quiet = [], None, False, 0
        self.stream.rdy.value = 0

    def drive(self):
        self.ready = self.random.random() < self.pace
        self.stream.rdy.value = int(self.ready)

    def sample(self):
        offer = known(self.stream.msg) if known(self.stream.val) else None
        assert self.standing in (None, offer), f"an offer of {self.standing} became {offer}"
        self.quiet = 0 if offer is not None else self.quiet + 1
        self.standing = None if self.ready else offer
        if self.ready and offer is not None:
            self.items.append(offer)


class Spi:
    """An SPI host, mode 0; half: cycles of half an SPI clock, at least 4."""

    def __init__(self, bench, half=4):
        self.bench, self.dut, self.half = bench, bench.dut, half
        self.rest()

    def rest(self):
        self.dut.csn.value, self.dut.sclk.value, self.dut.mosi.value = 1, 0, 0

    def drive(self):
        """Its pins move in `transfer`."""

    sample = drive

    async def wait(self, cycles):
        for _ in range(cycles):
            await self.bench.cycle()

    async def transfer(self, data):
        """Send ``data``; returns as many bytes from miso."""
        dut, received = self.dut, []
        dut.csn.value = 0
        await self.wait(self.half)
        for bit in (byte >> i & 1 for byte in data for i in range(7, -1, -1)):
            dut.mosi.value = bit
            await self.wait(self.half)
            received.append(known(dut.miso))
            dut.sclk.value = 1
            await self.wait(self.half)
            dut.sclk.value = 0
        await self.wait(self.half)
        dut.csn.value = 1
        await self.wait(2 * self.half)
        return bytes(sum(bit << 7 - i for i, bit in enumerate(received[n : n + 8])) for n in range(0, len(received), 8))


def check(got, expected):
    """The golden scoreboard: AssertionError that names the first item that differs."""
    got, expected = list(got), list(expected)
    for number, (item, want) in enumerate(zip(got, expected)):
        assert item == want, f"item {number} of {len(expected)}: expected {want}, got {item}"
    assert len(got) == len(expected), f"expected {len(expected)} items, got {len(got)}"
