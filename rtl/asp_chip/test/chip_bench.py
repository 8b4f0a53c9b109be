"""The chip on a bench: an SPI host, a link that stalls, and a front end in Python."""

import random

import numpy as np

from talbot.models.digital.host import command, decode_status, status_transfers, write_transfers
from talbot.models.parameters.registers import register_map
from talbot.rtl.reg_file.test.spi_host import SpiHost

CHIP = register_map()
MAX_CYCLES = 60_000


class ChipBench:
    """Resets ``sim`` and drives every pin of it.

    held: float64 (subs, rows, cols), what the ideal sample-and-holds take, in LSB; None: the comparators stay low.
    stall: the link is not ready in this share of the cycles, 0..1.
    """

    def __init__(self, sim, lanes, tile_cols=6, held=None, stall=0.0, seed=1):
        self.sim, self.lanes, self.tile_cols, self.held = sim, lanes, tile_cols, held
        self.stall, self.random = stall, random.Random(seed)
        self.stream, self.sync, self.taken = [], [], np.zeros(lanes)
        self.registers = CHIP.image(CHIP.configuration)
        self.pins = set()
        self.before = False, False, False, 0  # busy, wake, convert and dac of the cycle before
        sim.link_rdy @= 0
        sim.comparator @= 0
        sim.reset @= 1
        sim.sim_tick()
        sim.sim_tick()
        sim.reset @= 0
        self.spi = SpiHost(sim, self.tick)

    def tick(self):
        """Run one cycle: the comparators decide, the link takes a byte if there is one."""
        sim = self.sim
        answers = self.answers() if self.held is not None else 0
        ready = self.random.random() >= self.stall
        if ready != sim.link_rdy or answers != sim.comparator:
            sim.link_rdy @= ready
            sim.comparator @= answers
            sim.sim_eval_combinational()
        if sim.link_val and ready:
            self.stream.append(int(sim.link_data))
            self.sync.append(int(sim.frame_sync))
        if sim.hold:
            self.sample()
        self.watch()
        sim.sim_tick()

    def sample(self):
        """The enabled lanes sample the pixels at the pins' address."""
        sim = self.sim
        assert int(sim.en) != 0
        for lane in range(self.lanes):
            if sim.en[lane]:
                col = self.tile_cols * (self.lanes * int(sim.group) + lane) + int(sim.k)
                where = int(sim.sub), int(sim.row), col
                self.pins.add((*where, int(sim.balance)))
                if self.held is not None:
                    self.taken[lane] = self.held[where]

    def answers(self):
        """Return the comparators: held value >= level(dac), half an LSB built into the DAC (docs/chip.md)."""
        sim = self.sim
        codes = np.array([int(sim.dac) >> 8 * lane & 0xFF for lane in range(self.lanes)])
        levels = codes - (0.5 if sim.unsigned_ else 128.5)
        return int(sum(int(above) << lane for lane, above in enumerate(self.taken >= levels)))

    def watch(self):
        """Check in every cycle: at most one of the amplifier's phases is high; what `wake` and `convert` promise.

        In a frame `hold` follows `wake` by a cycle, and the converters' codes change while `convert` is high only.
        """
        sim, (busy, woken, converted, dac) = self.sim, self.before
        assert int(sim.pixel_reset) + int(sim.integrate) + int(sim.cm_reset) + int(sim.read) <= 1
        self.before = bool(sim.busy), bool(sim.wake), bool(sim.convert), int(sim.dac)
        assert woken if sim.hold else not (woken and sim.busy)
        assert sim.convert or not sim.hold
        assert sim.busy or not sim.convert
        assert converted or not (busy and sim.busy) or self.before[3] == dac

    def write(self, writes):
        """Set the registers to ``writes``, (address, byte) pairs, sending only the bytes that differ."""
        for transfer in write_transfers([w for w in writes if self.registers.get(w[0]) != w[1]]):
            self.spi.transfer(transfer)
        self.registers.update(writes)

    def start(self):
        """Start a frame and wait for its end."""
        self.spi.transfer(command("start"))
        cycles = 0
        while self.sim.busy or cycles < 8:
            self.tick()
            cycles += 1
            assert cycles < MAX_CYCLES, f"the frame has not ended after {cycles} cycles"

    def status(self):
        """Return status and counters, read over SPI."""
        return decode_status([self.spi.transfer(t) for t in status_transfers()])
