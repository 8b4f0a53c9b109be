"""The agents of the cocotb benches: stream drivers and monitors, an SPI host, a scoreboard, and their clock.

Agents are called twice a cycle: `drive` after the clock edge, with registers settled, and `sample` before the next,
with everything settled. So the simulator's scheduling has no effect on a bench.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol

from cocotb.triggers import Timer

HALF = 5  # ns of half a clock


def known(handle: Any) -> int:
    """Return the value of a signal. Raises AssertionError where a bit is X or Z."""
    value = handle.value
    assert value.is_resolvable, f"{handle._name} = {value}: X or Z"
    return int(value)


class Stopped(Exception):
    """A bench reaches the cycle at which it stops."""


class Agent(Protocol):
    """Drives or watches pins of the design."""

    def rest(self) -> None:
        """Drive the pins as in reset and start again."""

    def drive(self) -> None:
        """Drive the pins after a clock edge."""

    def sample(self) -> None:
        """Look at the pins before the next clock edge."""


class Bench:
    """A design and its agents, in the order in which they are called. stop: cycle that raises Stopped, or None."""

    def __init__(self, dut: Any, *agents: Agent) -> None:
        self.dut, self.agents, self.cycles = dut, list(agents), 0
        self.stop: int | None = None
        dut.clk.value = 0
        dut.reset.value = 1

    async def cycle(self) -> None:
        """Run one clock cycle. Raises Stopped."""
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

    async def reset(self, cycles: int = 2) -> None:
        """Reset for ``cycles``; agents start again."""
        self.dut.reset.value = 1
        for agent in self.agents:
            agent.rest()
        for _ in range(cycles):
            self.dut.clk.value = 0
            await Timer(HALF, "ns")
            self.dut.clk.value = 1
            await Timer(HALF, "ns")
        self.dut.reset.value = 0

    async def again(self, reset: bool = True) -> None:
        """Reset; or agents alone start again, where the design has nothing left to do."""
        if reset:
            await self.reset()
        for agent in self.agents:
            agent.rest()

    async def until(self, done: Callable[[], object], limit: int) -> None:
        """Run cycles until ``done()``. Raises AssertionError after ``limit`` of them."""
        for _ in range(limit):
            if done():
                return
            await self.cycle()
        assert done(), f"no end after {limit} cycles"


class Stream:
    """The signals of a val/rdy stream of ``dut``: recv__val, recv__rdy and recv__msg, or what ``parts`` names."""

    def __init__(self, dut: Any, name: str, parts: Sequence[str] = ("__val", "__rdy", "__msg")) -> None:
        self.val, self.rdy, self.msg = (getattr(dut, f"{name}{part}") for part in parts)


class Driver:
    """Offers ``items`` (ints), in a share ``pace`` of the cycles; what is offered stays until it is taken."""

    def __init__(self, stream: Stream, random: Any, items: Iterable[int] = (), pace: float = 1.0) -> None:
        self.stream, self.random, self.items, self.pace = stream, random, list(items), pace
        self.rest()

    def rest(self) -> None:
        """Drive the pins as in reset and start again."""
        self.sent, self.offered = 0, False
        self.stream.val.value = 0
        self.stream.msg.value = 0

    def drive(self) -> None:
        """Drive the pins after a clock edge."""
        self.offered = self.sent < len(self.items) and (self.offered or self.random.random() < self.pace)
        self.stream.val.value = int(self.offered)
        # the msg of an idle stream is random
        self.stream.msg.value = self.items[self.sent] if self.offered else self.random.getrandbits(len(self.stream.msg))

    def sample(self) -> None:
        """Look at the pins before the next clock edge."""
        if known(self.stream.rdy) and self.offered:
            self.sent += 1
            self.offered = False

    @property
    def done(self) -> bool:
        """Return whether every item is taken."""
        return self.sent == len(self.items)


class Monitor:
    """Takes ``items`` from a stream in a share ``pace`` of the cycles. An offer must not change until it is taken."""

    def __init__(self, stream: Stream, random: Any, pace: float = 1.0) -> None:
        self.stream, self.random, self.pace = stream, random, pace
        self.rest()

    def rest(self) -> None:
        """Drive the pins as in reset and start again."""
        self.items, self.held, self.ready, self.quiet = [], None, False, 0
        self.stream.rdy.value = 0

    def drive(self) -> None:
        """Drive the pins after a clock edge."""
        self.ready = self.random.random() < self.pace
        self.stream.rdy.value = int(self.ready)

    def sample(self) -> None:
        """Look at the pins before the next clock edge."""
        offer = known(self.stream.msg) if known(self.stream.val) else None
        assert self.held in (None, offer), f"an offer of {self.held} became {offer}"
        self.quiet = 0 if offer is not None else self.quiet + 1
        self.held = None if self.ready else offer
        if self.ready and offer is not None:
            self.items.append(offer)


class Spi:
    """An SPI host, mode 0; half: cycles of half an SPI clock, at least 4."""

    def __init__(self, bench: Bench, half: int = 4) -> None:
        self.bench, self.dut, self.half = bench, bench.dut, half
        self.rest()

    def rest(self) -> None:
        """Drive the pins as in reset and start again."""
        self.dut.csn.value, self.dut.sclk.value, self.dut.mosi.value = 1, 0, 0

    def drive(self) -> None:
        """Do nothing: the pins move in `transfer`."""

    sample = drive

    async def wait(self, cycles: int) -> None:
        """Run ``cycles`` of the bench."""
        for _ in range(cycles):
            await self.bench.cycle()

    async def transfer(self, data: bytes) -> bytes:
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


def check(got: Iterable[object], expected: Iterable[object]) -> None:
    """Compare with the golden items. Raises AssertionError with the first one that differs."""
    got, expected = list(got), list(expected)
    for number, (item, want) in enumerate(zip(got, expected)):
        assert item == want, f"item {number} of {len(expected)}: expected {want}, got {item}"
    assert len(got) == len(expected), f"expected {len(expected)} items, got {len(got)}"
