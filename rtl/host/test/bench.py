"""The chip's Verilog in this process, at the pins of a host (bench.cpp)."""

import ctypes
from pathlib import Path

from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.verilator import bare_program

MAIN = Path(__file__).with_name("bench.cpp")
NEVER = 256  # of 256 cycles


class Bench:
    """sensor: of the chip; its comparators stay low. One a process: the library has one chip."""

    def __init__(self, sensor):
        self.library = ctypes.CDLL(str(bare_program(Build.of(sensor), main=MAIN, options=("-O0", "-shared", "-fPIC"))))
        self.library.bench_now.restype = self.library.bench_pins.restype = ctypes.c_uint32
        self.reset()

    def reset(self, cycles=4):
        """Raise the reset pin for some cycles. What the receiver holds is dropped, and it is always ready."""
        self.stall(0)
        self.library.bench_reset(cycles)

    def stall(self, of_256):
        """The receiver is not ready in this many of 256 cycles, at random."""
        self.library.bench_stall(of_256)

    def ticks(self, count):
        self.library.bench_ticks(count)

    def pins(self):
        """busy, frame_sync, link_val."""
        pins = self.library.bench_pins()
        return tuple(pins >> i & 1 for i in range(3))

    def transfer(self, out):
        into = ctypes.create_string_buffer(len(out))
        assert self.library.bench_transfer(bytes(out), into, ctypes.c_size_t(len(out))) == 0, "miso_oe"
        return into.raw

    def link(self):
        out = bytearray()
        while (byte := self.library.bench_link()) >= 0:
            out.append(byte)
        return bytes(out)

    def now(self):
        return self.library.bench_now()
