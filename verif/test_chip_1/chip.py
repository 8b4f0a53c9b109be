"""TestChip1's Verilog in Verilator, with a host at its pins."""

from dataclasses import dataclass
from functools import cache

from talbot.base.tools import ToolError
from talbot.rtl.harness.ports import places, ports_of, split
from talbot.rtl.harness.translate import translate_component
from talbot.rtl.harness.verilated import in_verilator
from talbot.rtl.test_chip_1 import TestChip1
from talbot.rtl.test_chip_1.golden import CONTROL, WRITE, header

TOP = "TestChip1"


@cache
def _design() -> tuple[str, tuple]:
    """Return the chip's Verilog and ports."""
    chip = TestChip1()
    chip.elaborate()
    return translate_component(TestChip1(), TOP), ports_of(chip)


@dataclass
class Chip:
    """A chip, reset. cycles: since then."""

    cycles: int = 0

    def __post_init__(self) -> None:
        verilog, ports = _design()
        self.simulation = in_verilator(TOP, TOP, ports, verilog)
        inputs, outputs = split(ports)
        self.inputs = {port.path: low for port, low in places(inputs).items()}
        self.outputs = {port.path: low for port, low in places(outputs).items()}
        self.pins = 0
        self.drive(reset=1)
        self.tick()
        self.drive()
        self.cycles = 0

    def drive(self, reset: int = 0, val: int = 0, octet: int = 0, rdy: int = 0) -> None:
        """Set the input pins."""
        values = {"reset": reset, "host2chip.val": val, "host2chip.msg": octet, "chip2host.rdy": rdy}
        self.pins = sum(value << self.inputs[name] for name, value in values.items())

    def tick(self) -> None:
        """Let a cycle pass."""
        self.simulation.step(True, self.pins)
        self.cycles += 1

    def pin(self, name: str, bits: int = 1) -> int:
        """Return an output."""
        return self.simulation.step(False, self.pins) >> self.outputs[name] & ((1 << bits) - 1)

    def transfer(self, sent: bytes, answers: int = 0) -> bytes:
        """Send bytes, then return ``answers`` of the chip."""
        answer = b""
        for octet in sent:
            self.drive(val=1, octet=octet)
            while not self.pin("host2chip.rdy"):
                self.tick()
            self.tick()
        self.drive(rdy=1)
        while len(answer) < answers:
            if self.pin("chip2host.val"):
                answer += bytes([self.pin("chip2host.msg", 8)])
            self.tick()
        self.drive()
        return answer

    def write(self, address: int, data: bytes) -> None:
        """Write ``data`` to memory, from the word at the byte ``address`` on."""
        data += bytes(-len(data) % 4)
        self.transfer(header(address // 4 | WRITE, len(data) // 4) + data)

    def read(self, address: int, count: int) -> bytes:
        """Return ``count`` bytes, whole words of memory, from the byte ``address`` on."""
        return self.transfer(header(address // 4, count // 4), count)

    def run(self, program: bytes, limit: int = 10_000_000) -> int:
        """Run ``program`` until it stops or has a word for the host; returns its cycles. Raises ToolError."""
        self.transfer(header(CONTROL | WRITE, 1) + bytes(4))
        self.write(0, program)
        self.transfer(header(CONTROL | WRITE, 1) + b"\1\0\0\0")
        begin, stop = self.cycles, 1 << self.outputs["halted"] | 1 << self.outputs["word_waits"]
        step, pins = self.simulation.step, self.pins
        for cycles in range(limit):
            if step(True, pins) & stop:
                self.cycles = begin + cycles + 1
                return cycles + 1
        raise ToolError(f"the program does not stop within {limit} cycles")
