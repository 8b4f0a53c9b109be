"""An SPI host in Python: transfers on the pins of a simulated component, mode 0."""

from itertools import cycle


class SpiHost:
    """Drives sclk, csn and mosi of ``dut`` and samples miso.

    half: system-clock cycles of half an SPI clock, at least 4. tick: called for every cycle. pauses: cycles that the
    clock is stopped before each bit of a transfer, cyclic.
    """

    def __init__(self, dut, tick, half=4):
        self.dut, self.tick, self.half, self.pauses = dut, tick, half, (0,)
        dut.csn @= 1
        dut.sclk @= 0
        dut.mosi @= 0
        self.wait(half)

    def wait(self, cycles):
        for _ in range(cycles):
            self.tick()

    def transfer(self, data, cut=None):
        """Send ``data``; returns as many bytes from miso.

        cut: stop after this many bits, raising csn in the middle of a byte; the whole bytes are returned.
        """
        dut, received = self.dut, []
        bits = [byte >> i & 1 for byte in data for i in range(7, -1, -1)][:cut]
        dut.csn @= 0
        self.wait(self.half)
        for bit, pause in zip(bits, cycle(self.pauses)):
            dut.mosi @= bit
            self.wait(self.half + pause)
            received.append(int(dut.miso))
            dut.sclk @= 1
            self.wait(self.half)
            dut.sclk @= 0
        self.wait(self.half)
        dut.csn @= 1
        self.wait(2 * self.half)
        return bytes(
            sum(bit << 7 - i for i, bit in enumerate(received[n : n + 8]))
            for n in range(0, len(received) - len(received) % 8, 8)
        )
