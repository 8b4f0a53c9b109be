"""RegFile at every level: an SPI host against the register map and the golden bank."""

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.models.digital.host import (
    command,
    decode_status,
    frame_writes,
    read_transfer,
    status_transfers,
    write_transfers,
)
from talbot.models.digital.registers import ADDRESS_MAX, RegisterBank
from talbot.models.parameters import DIVIDERS, MODES, NO_DIVIDER, AmpTiming, FrameParameters, Window
from talbot.models.parameters.registers import array_resets, register_map
from talbot.rtl.harness.reset import outputs_after_reset
from talbot.rtl.harness.testbench import build
from talbot.rtl.reg_file import RegFile, RegFileFL, chip_config
from talbot.rtl.reg_file.test.spi_host import SpiHost

CHIP = register_map()
FIRST = min(CHIP.writable())
ARRAY = 11, 13, 2, 4, 5, "cordic"  # rows, cols, lanes, tile_rows, tile_cols, divider: not the map's resets
RESETS = array_resets(*ARRAY)
SIZES = (1024, 1536, 32, 4, 6), (515, 1029, 16, 3, 5), (768, 255, 8, 4, 1), (1, 1, 1, 1, 1)
SETTINGS = settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.too_slow])


class Bench:
    """One simulated register file with its SPI host; collects start strobes and loop-back bytes."""

    def __init__(self, sim, half=4):
        self.sim, self.starts, self.aborts, self.loop = sim, 0, 0, []
        sim.loop.rdy @= 1
        self.status()
        sim.reset @= 1
        sim.sim_tick()
        sim.reset @= 0
        self.spi = SpiHost(sim, self.tick, half)

    def tick(self):
        sim = self.sim
        if sim.loop.val and sim.loop.rdy:  # val and msg are registers: what they are since the edge before
            self.loop.append(int(sim.loop.msg))
        sim.sim_tick()
        self.starts += int(sim.start)
        self.aborts += int(sim.abort_)

    def status(self, **fields):
        """Drive the status inputs: bits and counters by name, the rest 0."""
        counters = {f.name: fields.pop(f.name, 0) for f in CHIP.counters}
        self.sim.cycles @= counters["cycles"]
        self.sim.conversions_made @= counters["conversions_made"]
        self.sim.conversions_left_out @= counters["conversions_left_out"]
        self.sim.status @= type(self.sim.status)(**fields)

    def read(self, address, count=1):
        return self.spi.transfer(read_transfer(address, count))[1:]

    def write(self, writes):
        for transfer in write_transfers(writes):
            assert not any(self.spi.transfer(transfer)), "miso is 0 in a write"

    def enable_loop(self, on=True):
        field = CHIP["loop_enable"]
        self.write([(field.byte, on << field.shift)])

    def value(self, name):
        return int(getattr(self.sim.cfg, name))


class TestFL:
    component, verilog = RegFileFL, False
    sim = None

    def bench(self, half=4):
        cls = type(self)
        if cls.__dict__.get("sim") is None:
            cls.sim = build(self.component(*ARRAY), self.verilog, "RegFile")
        return Bench(cls.sim, half)

    def test_reset_values(self):
        bench = self.bench()
        expected = RegisterBank(RESETS)
        for name in (f.name for f in CHIP.configuration if f.name != "trim"):
            assert bench.value(name) == expected.value(name), name
        assert bench.value("trims") == 0
        assert bench.read(0, 4) == bytes((CHIP["id"].reset, CHIP["version"].reset, 0, 0))

    def test_every_address_after_reset(self):
        """Existing bits have their reset values, others read 0; read byte by byte, and all in one transfer."""
        bench, image = self.bench(), CHIP.image((*CHIP.configuration, *CHIP.identity), RESETS)
        expected = [image.get(address, 0) for address in range(128)]
        # Downwards: a counter's upper bytes before the first one, which captures it
        assert [bench.read(address)[0] for address in reversed(range(128))] == expected[::-1]
        assert list(bench.read(0, 128)) == expected

    def test_sclk_is_high_as_a_transfer_begins(self):
        """The falling edge counts as no bit: the transfer is good, and `miso` is 0 in the command byte."""
        bench = self.bench()
        for pin, level in (("sclk", 1), ("csn", 0), ("sclk", 0)):
            wire = getattr(bench.sim, pin)
            wire @= level
            bench.spi.wait(8)
        assert bench.spi.transfer(read_transfer(0, 2)) == bytes((0, CHIP["id"].reset, CHIP["version"].reset))

    def test_a_byte_alone(self):
        """Each byte in turn, over all ones and over zeros, then alone: no other bit changes in any cycle."""
        bench, writable = self.bench(), CHIP.writable()
        held = [bench.sim.cfg.clone()]

        def tick():
            Bench.tick(bench)
            if bench.sim.cfg != held[-1]:
                held.append(bench.sim.cfg.clone())

        def now():
            return int(held[-1].to_bits())

        bench.spi.tick = tick
        for value, bits in ((0xFF, sum(mask.bit_count() for mask in writable.values())), (0, 0)):
            bench.spi.transfer(bytes((0x80 | FIRST, *[value] * (max(writable) - FIRST + 1))))
            assert now().bit_count() == bits
        cfg = [int(state.to_bits()) for state in held]
        steps = [before ^ after for before, after in zip(cfg, cfg[1:])]
        assert len(steps) <= 2 * len(writable) and all(step.bit_count() <= 8 for step in steps)
        for address, mask in writable.items():  # each its own place
            bench.write([(address, 0xFF)])
            assert now().bit_count() == mask.bit_count()
            bench.write([(address, 0)])
            assert now() == 0

    def test_every_trim_has_its_place(self):
        bench = self.bench()
        for number, trim in enumerate(CHIP.trims):
            bench.write([(trim.byte, number + 1)])
        assert bench.value("trims") == sum(number + 1 << 16 * number for number in range(len(CHIP.trims)))

    def test_a_frame_is_written_and_read_back(self):
        bench = self.bench()
        frame = FrameParameters(
            Window(1, 200, 3, 250),
            "tof",
            0x8001FE,
            127,
            3,
            True,
            255,
            False,
            True,
            0xBEEF,
            AmpTiming(1, 65535, 0x1234, 2, 3, 0xFF00, 255),
        )
        trims = [(-1) ** t * (21 * t + 7) for t in range(24)]
        writes = frame_writes(frame, trims)
        bench.write(writes)
        assert MODES[bench.value("mode")] == "tof" and bench.value("decimation") == 3
        for name in ("mask", "threshold", "noise_floor", "frame_number", "phase", "overlap", "test_pattern"):
            assert bench.value(name) == getattr(frame, name), name
        for name in ("row0", "row1", "col0", "col1"):
            assert bench.value(name) == getattr(frame.window, name), name
        for name in ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard", "n_cm"):
            assert bench.value(name) == getattr(frame.timing, name), name
        field = CHIP.trims[0]
        for t, trim in enumerate(trims):
            assert bench.value("trims") >> 8 * field.size * t & 0xFFFF == trim % (1 << field.width), t
        read = bench.read(FIRST, max(CHIP.writable()) - FIRST + 1)
        assert all(read[address - FIRST] == byte for address, byte in writes)

    def test_every_bit_of_every_register(self):
        """All bytes at once: the bits that exist are kept, the others read 0; counters and loop-back the same."""
        bench, writable, last = self.bench(), CHIP.writable(), max(CHIP.writable())
        for value in (0xFF, 0):
            bench.status(**{f.name: value * 0x0101010101010101 for f in CHIP.counters})
            bench.spi.transfer(bytes((0x80 | FIRST, *[value] * (last - FIRST + 1))))
            assert bench.read(FIRST, last - FIRST + 1) == bytes(
                value & writable.get(a, 0) for a in range(FIRST, last + 1)
            )
            for counter in CHIP.counters:
                assert bench.read(counter.byte, 8) == bytes([value] * 8)
            bench.enable_loop()
            bench.spi.transfer(bytes((0x80 | CHIP["loop_back"].byte, value)))
            assert bench.loop[-1] == value

    def test_unmapped_and_read_only_addresses_ignore_writes(self):
        """All ones over zeros, then zeros over ones: no register changes, and an unmapped address reads 0."""
        bench, writable, image = self.bench(), CHIP.writable(), CHIP.image(CHIP.identity, RESETS)
        image[CHIP["done"].byte] = 1 << CHIP["done"].shift
        counters = {f.byte + i for f in CHIP.counters for i in range(f.bytes)}
        effects = {*writable, *(CHIP[name].byte for name in ("start", "busy", "loop_back"))}
        for value in (0xFF, 0):
            bench.status(done=1)
            bench.write([(address, value ^ 0xFF) for address in writable])
            cfg = bench.sim.cfg.clone()
            bench.write([(address, value) for address in range(128) if address not in effects])
            assert bench.sim.cfg == cfg
            for address in sorted({*range(128)} - {*writable} - counters):
                assert bench.read(address)[0] == image.get(address, 0), address
            for counter in CHIP.counters:
                assert bench.read(counter.byte, 8) == bytes(8)
            assert not (bench.starts or bench.aborts or bench.loop or bench.sim.loop.val)

    def test_start_is_one_strobe(self):
        bench = self.bench()
        bench.spi.transfer(command("start"))
        assert bench.starts == 1
        assert bench.read(CHIP["start"].byte) == b"\0"

    def test_busy_locks_the_configuration(self):
        bench = self.bench()
        before = bench.read(FIRST, 8)
        bench.status(busy=1)
        bench.write([(FIRST + i, byte ^ 0xFF) for i, byte in enumerate(before)])
        assert bench.read(FIRST, 8) == before
        assert bench.read(CHIP["busy"].byte)[0] == 1 << CHIP["refused"].shift | 1 << CHIP["busy"].shift
        bench.spi.transfer(command("refused"))
        assert bench.read(CHIP["busy"].byte)[0] == 1 << CHIP["busy"].shift
        bench.spi.transfer(command("start"))
        assert bench.starts == 0
        bench.status()
        assert bench.read(CHIP["busy"].byte)[0] == 1 << CHIP["refused"].shift
        bench.spi.transfer(command("start"))
        assert bench.starts == 1
        assert bench.read(CHIP["busy"].byte)[0] == 1 << CHIP["refused"].shift, "a start keeps refused"

    def test_sticky_bits(self):
        bench = self.bench()
        for name in ("done", "cfg_err", "amp_err"):
            bench.status(**{name: 1})
            bench.tick()
            bench.status()
        both = [1 << CHIP[n].shift for n in ("done", "cfg_err", "amp_err")]
        assert bench.read(CHIP["busy"].byte)[0] == sum(both)
        bench.spi.transfer(command("cfg_err"))
        assert bench.read(CHIP["busy"].byte)[0] == both[0] + both[2]
        bench.spi.transfer(command("start"))
        assert bench.read(CHIP["busy"].byte)[0] == 0

    def test_an_event_in_the_cycle_that_clears_it_stays(self):
        """An event one cycle earlier is cleared. A start clears in the cycle ahead of its strobe, and so does a 1."""
        strobe = self.tick_of_the_strobe()
        for name in ("start", "done"):
            for tick, stays in ((strobe - 1, 0), (strobe, 1), (strobe + 1, 1)):
                bench = self.bench()
                self.transfer_with_event(bench, command(name), tick)
                assert bench.read(CHIP["busy"].byte)[0] >> CHIP["done"].shift & 1 == stays, (name, tick - strobe)

    def tick_of_the_strobe(self):
        """Clock edges from the beginning of a transfer of `start` to the one after which the strobe is high."""
        bench, ticks = self.bench(), []

        def tick():
            bench.tick()
            ticks.append(bench.starts)

        bench.spi.tick = tick
        bench.spi.transfer(command("start"))
        return ticks.index(1)

    @staticmethod
    def transfer_with_event(bench, data, at):
        """A transfer with `done` high ahead of its clock edge number ``at``."""
        ticks = [0]

        def tick():
            bench.status(done=ticks[0] == at)
            bench.tick()
            ticks[0] += 1

        bench.spi.tick = tick
        bench.spi.transfer(data)
        bench.spi.tick = bench.tick

    def test_counters_are_captured_at_their_first_byte(self):
        bench = self.bench()
        counters = {f.name: 0x0123456789ABCDEF * (i + 1) & (1 << 64) - 1 for i, f in enumerate(CHIP.counters)}
        bench.status(**counters)
        replies = [bench.spi.transfer(t) for t in status_transfers()]
        flags = dict.fromkeys((f.name for f in CHIP.fields if f.register == "status"), False)
        assert decode_status(replies) == flags | counters
        first = CHIP.counters[0]
        bench.read(first.byte, 3)
        bench.status(cycles=0)
        assert bench.read(first.byte + 1, 7) == counters["cycles"].to_bytes(8, "little")[1:]
        assert bench.read(first.byte, 8) == bytes(8)

    def test_a_cut_transfer_writes_whole_bytes_only(self):
        bench = self.bench()
        a = CHIP["t_int"].byte
        for cut in range(24):
            bench.write([(a, 0x11), (a + 1, 0x22)])
            bench.spi.transfer(bytes((0x80 | a, 0x55, 0x66)), cut)
            assert bench.read(a, 2) == (b"\x55\x22" if cut >= 16 else b"\x11\x22"), cut

    def test_reset_in_a_transfer(self):
        """The rest of the transfer is ignored, until csn has been high."""
        bench = self.bench()
        for bit in range(1, 24):
            left = [bit]

            def tick(left=left):
                left[0] -= 1  # reset for one cycle, that many SPI clocks into the transfer
                bench.sim.reset @= left[0] == 0
                bench.tick()

            left[0] = 2 * bench.spi.half * bit
            bench.spi.tick = tick
            bench.spi.transfer(b"\x00" + 5 * command("start") + bytes((0x80 | FIRST, 0x05)))
            bench.spi.tick = bench.tick
            assert bench.starts == 0 and bench.read(FIRST, 2) == self.resets(), bit
            bench.write([(FIRST, 0x05)])
            assert bench.read(FIRST) == b"\x05"

    @staticmethod
    def resets():
        bank = RegisterBank(RESETS)
        return bytes(bank.read(FIRST + i, False, [0, 0, 0]) for i in range(2))

    def test_loop_back(self):
        bench, address = self.bench(), CHIP["loop_back"].byte
        refused = 1 << CHIP["refused"].shift
        bench.enable_loop()
        bench.spi.transfer(bytes((0x80 | address, *range(5, 10))))
        assert bench.loop == list(range(5, 10)) and bench.read(CHIP["busy"].byte)[0] == 0
        bench.sim.loop.rdy @= 0
        bench.spi.transfer(bytes((0x80 | address, 77, 78)))
        assert bench.read(CHIP["busy"].byte)[0] == refused
        bench.sim.loop.rdy @= 1
        bench.spi.wait(4)
        assert bench.loop[5:] == [77], "the byte without room is refused, not the one before it"

    def test_a_waiting_loop_back_byte_locks_the_configuration(self):
        """The byte on offer cannot be withdrawn by a write, and no start goes past it."""
        bench, address, refused = self.bench(), CHIP["loop_back"].byte, 1 << CHIP["refused"].shift
        bench.enable_loop()
        bench.sim.loop.rdy @= 0
        bench.spi.transfer(bytes((0x80 | address, 0x5A)))
        before = bench.read(FIRST, 0x4C)
        for data in ([(a, byte ^ 0xFF) for a, byte in enumerate(before, FIRST)], [(CHIP["start"].byte, 1)]):
            bench.write(data)
            assert bench.read(CHIP["busy"].byte)[0] == refused and bench.starts == 0
            assert bench.read(FIRST, 0x4C) == before and bench.sim.loop.val and bench.sim.loop.msg == 0x5A
            bench.spi.transfer(command("refused"))
        bench.sim.loop.rdy @= 1
        bench.enable_loop(False)
        assert bench.loop == [0x5A] and bench.value("loop_enable") == 0

    def test_loop_back_excludes_a_frame(self):
        """Without loop_enable a byte is refused, with it a start; nothing else happens."""
        bench, refused = self.bench(), 1 << CHIP["refused"].shift
        bench.spi.transfer(bytes((0x80 | CHIP["loop_back"].byte, 1, 2)))
        assert bench.read(CHIP["busy"].byte)[0] == refused
        bench.spi.transfer(command("refused"))
        bench.enable_loop()
        assert not bench.loop and not bench.sim.loop.val, "a refused byte does not come later"
        bench.spi.transfer(command("start"))
        assert bench.read(CHIP["busy"].byte)[0] == refused and not bench.starts
        bench.enable_loop(False)
        bench.spi.transfer(command("start"))
        assert bench.starts == 1

    def test_abort(self):
        """One strobe, busy or not; a waiting loop-back byte is dropped; a start in the same write is refused."""
        status = CHIP["busy"].byte
        both = 1 << CHIP["start"].shift | 1 << CHIP["abort"].shift
        aborted, refused = (1 << CHIP[name].shift for name in ("aborted", "refused"))
        for busy, byte, sticky in ((0, 2, aborted), (1, 2, aborted), (0, both, aborted | refused)):
            bench = self.bench()
            bench.status(busy=busy)
            bench.spi.transfer(bytes((0x80 | CHIP["abort"].byte, byte)))
            assert (bench.aborts, bench.starts) == (1, 0)
            assert bench.read(status)[0] == sticky | busy << CHIP["busy"].shift
            bench.status()
            bench.spi.transfer(command("start"))
            assert bench.starts == 1 and bench.read(status)[0] == sticky & refused
            bench.spi.transfer(command("abort"))
            bench.spi.transfer(command("aborted"))
            assert bench.read(status)[0] == sticky & refused
        bench = self.bench()
        bench.enable_loop()
        bench.sim.loop.rdy @= 0
        bench.spi.transfer(bytes((0x80 | CHIP["loop_back"].byte, 0x5A)))
        bench.spi.transfer(command("abort"))
        bench.sim.loop.rdy @= 1
        bench.enable_loop(False)
        assert not bench.loop and bench.value("loop_enable") == 0, "dropped, and the lock with it"

    def test_a_stalled_loop_back_byte_is_not_lost(self):
        """Each waits into the next transfer, and comes out once, in whichever cycle the link is ready."""
        bench, address = self.bench(), CHIP["loop_back"].byte
        bench.enable_loop()
        sent = []
        for ready in range(0, 72, 5):  # the only cycle of the transfer in which the link is ready
            ticks = [0]

            def tick(ready=ready, ticks=ticks):
                bench.sim.loop.rdy @= ticks[0] == ready
                bench.tick()
                ticks[0] += 1

            bench.spi.tick = tick
            bench.spi.transfer(bytes((0x80 | address, ready)))
            bench.spi.wait(20)
            sent.append(ready)
        bench.spi.tick = bench.tick
        bench.sim.loop.rdy @= 1
        bench.spi.wait(2)
        assert bench.loop == sent and bench.read(CHIP["busy"].byte)[0] == 0

    def test_a_loop_back_byte_as_the_link_takes_the_one_before(self):
        """It is refused in that cycle and accepted in the next."""
        strobe, loop_back = self.tick_of_the_strobe() + 8 * 2 * 4, CHIP["loop_back"].byte
        for ready, refused in ((strobe - 1, 0), (strobe, 1), (strobe + 1, 1)):
            bench, ticks = self.bench(), [0]
            bench.enable_loop()

            def tick(bench=bench, ready=ready, ticks=ticks):
                bench.sim.loop.rdy @= ticks[0] == ready
                bench.tick()
                ticks[0] += 1

            bench.spi.tick = tick
            bench.spi.transfer(bytes((0x80 | loop_back, 1, 2)))
            bench.spi.tick = bench.tick
            bench.sim.loop.rdy @= 1
            bench.spi.wait(2)
            assert bench.loop == [1, 2][: 2 - refused], ready - strobe
            assert bench.read(CHIP["busy"].byte)[0] >> CHIP["refused"].shift & 1 == refused

    def test_every_address_is_locked(self):
        """Each byte of the configuration, the last trim's too, while busy and while a loop-back byte waits."""
        first, last = FIRST, max(CHIP.writable())
        bench = self.bench()
        bench.enable_loop()
        before = bench.read(first, last - first + 1)
        for waits in (False, True):
            bench.status(busy=not waits)
            if waits:
                bench.sim.loop.rdy @= 0
                bench.spi.transfer(bytes((0x80 | CHIP["loop_back"].byte, 1)))
            bench.spi.transfer(bytes((0x80 | first, *(byte ^ 0xFF for byte in before))))
            assert bench.read(first, last - first + 1) == before

    def test_a_reset_clears_what_can_be_read(self):
        """Every byte but a counter's first, which takes a snapshot, in every state of the registers."""
        bench, ones = self.bench(), (1 << 64) - 1
        image = CHIP.image((*CHIP.configuration, *CHIP.identity), RESETS)
        bench.status(done=1, cfg_err=1, amp_err=1, **{f.name: ones for f in CHIP.counters})
        bench.tick()
        bench.status(**{f.name: ones for f in CHIP.counters})
        bench.spi.transfer(bytes((0x80 | FIRST, *[0xFF] * (max(CHIP.writable()) - FIRST + 1))))
        bench.spi.transfer(bytes((0x80 | CHIP["abort"].byte, 3)))
        bench.read(CHIP.counters[0].byte, 8)
        bench.sim.loop.rdy @= 0
        bench.spi.transfer(bytes((0x80 | CHIP["loop_back"].byte, 0x5A)))
        assert bench.sim.loop.val and bench.read(CHIP["busy"].byte) == b"\x3e"
        bench.sim.reset @= 1
        bench.sim.sim_tick()
        bench.sim.reset @= 0
        bench.spi.wait(4)
        firsts = [f.byte for f in CHIP.counters]
        for run in (range(firsts[0]), *(range(first + 1, first + 8) for first in firsts), range(firsts[-1] + 8, 128)):
            assert list(bench.read(run[0], len(run) - 1)) == [image.get(a, 0) for a in run[:-1]], run
        assert not bench.sim.loop.val

    def test_half_bits_of_any_length(self):
        for half in (4, 5, 8, 13):
            bench = self.bench(half)
            bench.write([(FIRST + 2, half)])
            assert bench.read(FIRST + 2)[0] == half

    def test_a_stopped_clock(self):
        """An odd number of cycles between two bytes, too: held values must not change."""
        image = CHIP.image(CHIP.configuration, RESETS)
        expected = [image.get(address, 0) for address in range(FIRST, max(CHIP.writable()) + 1)]
        for pauses in ((0,) * 7 + (1,), (1, 0, 0), (0, 0, 0, 0, 17)):
            bench = self.bench()
            bench.spi.pauses = pauses
            assert list(bench.read(FIRST, len(expected))) == expected
            for address in sorted(CHIP.writable())[::5]:
                bench.write([(address, 0xFF)])
                assert bench.read(address)[0] == CHIP.writable()[address]

    def test_any_transfers(self):
        """Any bytes at any address, complete or cut, with and without busy, equal the golden bank.

        Most transfers pass an address where something begins or ends.
        """
        ends = sorted({f.byte + by for f in CHIP.fields if f.name != "trim" for by in (-1, -2)} - {-1, -2} | {126, 127})
        place = st.integers(0, 127) | st.sampled_from(ends)
        data = st.tuples(place, st.booleans(), st.binary(max_size=5)).map(
            lambda sent: bytes((sent[0] | sent[1] << 7, *sent[2]))
        )
        a_transfer = st.tuples(data, st.integers(0, 7), st.booleans())

        @SETTINGS
        @given(st.lists(a_transfer, min_size=1, max_size=6))
        def check(transfers):
            bench = self.bench()
            bank = RegisterBank(RESETS)
            starts = 0
            for data, missing, busy in transfers:
                bench.status(busy=busy, cycles=1, conversions_made=2, conversions_left_out=3)
                got = bench.spi.transfer(data, 8 * len(data) - missing)
                whole = data[: len(data) - (missing > 0)]
                want = self.expected(bank, whole, busy)
                assert got == want[: len(whole)]
                starts += bank.take()[0]
            assert bench.starts == starts
            assert bench.value("trims") == sum(bank.value(f.key) << 8 * f.size * i for i, f in enumerate(CHIP.trims))

        check()

    @staticmethod
    def expected(bank, data, busy):
        """The golden bank's answer to the complete bytes ``data``."""
        out = bytearray(1)
        address = data[0] & 0x7F if data else 0
        for byte in data[1:]:
            if data[0] & 0x80:
                bank.write(address, byte, busy, False)
                out.append(0)
            else:
                out.append(bank.read(address, busy, [1, 2, 3]))
            address = min(address + 1, ADDRESS_MAX)
        return bytes(out)


class TestRTL(TestFL):
    component = RegFile

    def test_latency_of_the_pins(self):
        """Each SPI pin passes two flip-flops: an edge takes effect in the third cycle, on the registers and on miso."""
        assert self.tick_of_the_strobe() == 2 * 8 * 2 * 4 + 3 - 1
        bench, levels = self.bench(), []

        def tick():
            bench.tick()
            levels.append((int(bench.sim.sclk), int(bench.sim.csn), int(bench.sim.miso)))

        bench.write([(FIRST + 2, 0x7F)])
        bench.spi.tick = tick
        bench.spi.transfer(read_transfer(FIRST + 2, 1), 14)
        bench.spi.tick = bench.tick
        falls = [i for i, (one, two) in enumerate(zip(levels, levels[1:])) if one[0] > two[0]]
        changes = [i for i, (one, two) in enumerate(zip(levels, levels[1:])) if one[2] != two[2]]
        deselected = next(i for i, (one, two) in enumerate(zip(levels, levels[1:])) if one[1] < two[1])
        assert changes == [falls[8] + 2, deselected + 2]

    def test_outputs_after_a_reset(self):
        golden = outputs_after_reset(build(RegFileFL(*ARRAY)), before=0)
        assert outputs_after_reset(self.bench().sim) == golden


class TestIcarus(TestRTL):
    verilog = "icarus"


@pytest.mark.parametrize("divider, array", list(zip((*DIVIDERS, NO_DIVIDER), (*SIZES, (9, 14, 2, 2, 3)))))
def test_identity_and_window_of_every_size(divider, array):
    bench = Bench(build(RegFile(*array, divider)))
    own = array_resets(*array, divider)
    image = CHIP.image(CHIP.identity, own)
    assert bench.value("row1") == own["row1"] and bench.value("col1") == own["col1"]
    first, last = CHIP["lanes"].byte, CHIP["divider"].byte
    assert list(bench.read(first, last - first + 1)) == [image[address] for address in range(first, last + 1)]


class TestVerilog(TestRTL):
    """A subset: the text is TestIcarus's, which runs all tests in half the time of PyMTL3's import from Verilator."""

    verilog = True
    test_every_address_after_reset = test_a_byte_alone = test_every_bit_of_every_register = None
    test_unmapped_and_read_only_addresses_ignore_writes = None
    test_reset_in_a_transfer = test_a_waiting_loop_back_byte_locks_the_configuration = None
    test_every_address_is_locked = test_a_reset_clears_what_can_be_read = test_a_stopped_clock = None


def test_the_bank_resets_to_the_default_frame():
    """The map's resets are the defaults of models.parameters for the default sensor."""
    from talbot.models.parameters import SensorParameters

    frame = FrameParameters(SensorParameters().full_window)
    assert dict(frame_writes(frame)) == CHIP.image(CHIP.configuration)
    assert dict(frame_writes(replace(frame, threshold=11))) != CHIP.image(CHIP.configuration)
    assert chip_config().nbits == sum(f.width for f in CHIP.configuration if f.name != "trim") + 24 * 16
