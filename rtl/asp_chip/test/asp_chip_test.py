"""AspChip at every level: whole frames over its pins against the golden chip."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.models.chip import golden_frame
from talbot.models.digital.host import command, frame_writes, read_transfer
from talbot.models.digital.pattern import PatternEnd
from talbot.models.parameters import (
    MODES,
    NO_DIVIDER,
    SHORT_TIMING,
    ArrayParameters,
    ChipParameters,
    FrameParameters,
    ParameterError,
    SensorParameters,
    Window,
)
from talbot.models.parameters.registers import register_map
from talbot.rtl.asp_chip import AspChip, AspChipFL
from talbot.rtl.asp_chip.test.chip_bench import ChipBench
from talbot.rtl.harness.testbench import build

ROWS, COLS, LANES = 8, 13, 2
SENSOR = SensorParameters(array=ArrayParameters(ROWS, COLS), chip=ChipParameters(lanes=LANES))
# Another order of types, and no phase path
OTHER = replace(
    SENSOR,
    tile=replace(SENSOR.tile, order=tuple(np.random.default_rng(24).permutation(24).tolist())),
    chip=replace(SENSOR.chip, divider=NO_DIVIDER),
)
FULL = SENSOR.full_window
PATTERN = PatternEnd(ROWS, COLS)
CHIP = register_map()


def pattern_frame(window=FULL, mode="edge", exposure=0, **fields):
    return FrameParameters(window, mode, test_pattern=True, timing=replace(SHORT_TIMING, exposure=exposure), **fields)


FRAMES = {
    "edge": pattern_frame(frame_number=7),
    "every sample": pattern_frame(threshold=0, overlap=False),
    "ternary": pattern_frame(mode="ternary", threshold=6),
    "image, some types": pattern_frame(mode="image", mask=0x8040A1),
    "a lead of the reset pointer": pattern_frame(exposure=3, overlap=False),
    "raw, a window": pattern_frame(Window(1, 1, 1, 2), "raw"),
    "tof, decimated": pattern_frame(mode="tof", mask=0x03, decimation=1),
}
PHASE = pattern_frame(Window(1, 1, 0, 2), "tof", mask=0x000F0F, phase=True, noise_floor=20)


class ChipTests:
    """One chip per class; the tests that are short enough for a simulation in Python."""

    component, verilog, examples, sensor = None, False, 5, SENSOR

    def bench(self, **kw):
        cls = type(self)
        if cls.__dict__.get("sim") is None:
            tile, chip = self.sensor.tile, self.sensor.chip
            cls.sim = build(
                self.component(
                    ROWS,
                    COLS,
                    LANES,
                    tuple(tile.order),
                    tile.rows,
                    tile.cols,
                    chip.divider,
                    chip.n_frac,
                    chip.cordic_iterations,
                ),
                self.verilog,
                "AspChip",
            )
        return ChipBench(cls.sim, LANES, **kw)

    @property
    def has_phase(self):
        return self.sensor.chip.has_phase_path

    def golden(self, frame, end=PATTERN):
        return golden_frame(None, self.sensor, replace(frame, phase=frame.phase and self.has_phase), end)

    def check(self, bench, frame, golden, trims=None):
        """Run one frame and check its bytes, its counters and its end."""
        bench.write(frame_writes(frame, trims))
        bench.start()
        assert bytes(bench.stream) == golden.stream
        assert all(bench.sync)
        status = bench.status()
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

    def test_phase_and_loop_back(self):
        bench = self.bench()
        self.check(bench, PHASE, self.golden(PHASE))
        bench.stream.clear()
        options, loop = CHIP["loop_enable"], CHIP["loop_back"].byte
        bench.write([(options.byte, 1 << options.shift)])
        bench.sync.clear()
        bench.spi.transfer(bytes((0x80 | loop, *b"Talbot\xff\0")))
        assert bytes(bench.stream) == b"Talbot\xff\0" and not any(bench.sync)


class FrameTests(ChipTests):
    """The other tests: they take too long for the RTL level in PyMTL."""

    @pytest.mark.parametrize("name", FRAMES)
    def test_pattern(self, name):
        frame = FRAMES[name]
        self.check(self.bench(), frame, self.golden(frame))

    def test_front_end_at_the_pins(self):
        """Random values at the comparators, and a slow link: no sample is lost or repeated."""
        held = np.random.default_rng(3).normal(0, 30, (1, ROWS, COLS))

        class FrontEnd(PatternEnd):
            def values(self, mode):
                return held

        frame = FrameParameters(FULL, threshold=20, timing=SHORT_TIMING)
        trims = [(-1) ** t * (20 * t + 3) for t in range(24)]
        bench = self.bench(held=held, stall=0.7)
        self.check(bench, frame, self.golden(frame, FrontEnd(ROWS, COLS)), trims)
        kinds, width = self.sensor.tile.type_map(ROWS, COLS), CHIP.trims[0].width
        assert bench.pins == {
            (0, row, col, trims[kinds[row, col]] % (1 << width)) for row in range(ROWS) for col in range(COLS)
        }

    def test_any_frame(self):
        """Any configuration, any stall: the golden bytes, or an error if there is nothing to read."""
        tiles = [st.tuples(st.integers(0, last), st.integers(0, last)).map(sorted) for last in (FULL.row1, FULL.col1)]

        @settings(max_examples=self.examples, deadline=None, suppress_health_check=[HealthCheck.too_slow])
        @given(
            st.sampled_from(MODES),
            st.integers(1, 2**24 - 1),
            *tiles,
            st.integers(0, 127),
            st.integers(0, 3),
            st.booleans(),
            st.booleans(),
            st.integers(0, 12),
            st.floats(0, 0.9),
        )
        def check(mode, mask, rows, cols, threshold, decimation, phase, overlap, exposure, stall):
            frame = pattern_frame(
                Window(*rows, *cols),
                mode,
                exposure,
                mask=mask,
                threshold=threshold,
                decimation=decimation,
                phase=phase and mode == "tof",
                overlap=overlap,
                noise_floor=threshold,
            )
            bench = self.bench(stall=stall, seed=mask)
            try:
                golden = self.golden(frame)
            except ParameterError:
                bench.write(frame_writes(frame))
                bench.start()
                assert bench.status()["cfg_err"] and not bench.stream
            else:
                self.check(bench, frame, golden)

        check()

    def test_phase_counts_in_tof_mode_only(self):
        bench, frame = self.bench(), FRAMES["raw, a window"]
        writes = dict(frame_writes(frame))
        writes[CHIP["phase"].byte] |= 1 << CHIP["phase"].shift
        bench.write(sorted(writes.items()))
        bench.start()
        assert bytes(bench.stream) == self.golden(frame).stream

    def test_two_frames(self):
        """A frame does not depend on the frame before, after a change of everything."""
        bench = self.bench()
        for name in ("raw, a window", "edge"):
            frame = FRAMES[name]
            bench.stream.clear()
            self.check(bench, frame, self.golden(frame))

    def test_one_cycle_of_reset_within_a_frame(self):
        """No `done` for the frame that the reset ended; the next frame is complete."""
        bench, frame = self.bench(), FRAMES["raw, a window"]
        bench.write(frame_writes(frame))
        bench.spi.transfer(command("start"))
        while not bench.sim.frame_sync:
            bench.tick()
        bench.sim.reset @= 1
        bench.sim.sim_tick()
        bench.sim.reset @= 0
        status = bench.status()
        assert not status["busy"] and not status["done"]
        bench.registers = CHIP.image(CHIP.configuration)
        bench.stream.clear()
        bench.sync.clear()
        self.check(bench, frame, self.golden(frame))

    def test_status_within_a_frame(self):
        """Busy and not done while the frame's bytes are sent."""
        bench, frame = self.bench(stall=0.9), FRAMES["every sample"]
        bench.write(frame_writes(frame))
        bench.spi.transfer(command("start"))
        while not bench.sim.frame_sync:
            bench.tick()
        flags = bench.spi.transfer(read_transfer(CHIP["busy"].byte, 1))[1]
        assert bench.sim.frame_sync and flags >> CHIP["busy"].shift & 1 and not flags >> CHIP["done"].shift & 1
        while bench.sim.busy:
            bench.tick()
        assert bytes(bench.stream) == self.golden(frame).stream and bench.status()["done"]

    def test_impossible_frames_do_not_start(self):
        """Each is refused, and a valid frame starts after them."""
        bench = self.bench()
        field = {f.name: f for f in CHIP.configuration}
        good = CHIP.image(CHIP.configuration, {"row1": FULL.row1, "col1": FULL.col1})
        for name, value, amp_err in 2 * (("row1", 2, False), ("col0", 3, False), ("t_int", 0, True)):
            wrong = CHIP.image([field[name]], {name: value})
            bench.write(sorted(wrong.items()))
            bench.start()
            status = bench.status()
            assert status["cfg_err"] and status["amp_err"] == amp_err and not status["busy"] | status["done"], name
            assert not bench.stream
            bench.write([(address, good[address]) for address in sorted(wrong)])
        self.check(bench, FRAMES["edge"], self.golden(FRAMES["edge"]))


class TestFL(FrameTests):
    component = AspChipFL


class TestFLWithoutPhasePath(ChipTests):
    component, sensor = AspChipFL, OTHER


class TestRTL(ChipTests):
    component = AspChip


class VerilogTests(FrameTests):
    component, verilog = AspChip, True

    def test_state_while_the_link_stalls(self):
        """Every stream waits, some results in the converters; after the frame, and after an abort, nothing does."""
        address, size = CHIP.state[0].address, CHIP.state[0].size

        def state(bench):
            bits = int.from_bytes(bench.spi.transfer(read_transfer(address, size))[1:], "little")
            return {f.name for f in CHIP.state if bits >> f.lsb & (1 << f.width) - 1}

        bench, frame = self.bench(stall=1.0), FRAMES["every sample"]
        bench.write(frame_writes(frame))
        for ends in (True, False):
            bench.stall = 1.0
            bench.spi.transfer(command("start"))
            while not bench.sim.hold:
                bench.tick()
            bench.spi.wait(400)
            waits = {"hold_taken", "step_waits", "scan_waits", "link_waits"}
            assert state(bench) - {"converting"} == waits | {"seq_state", "encoder_state"}
            if ends:
                bench.stall = 0.0
                while bench.sim.busy:
                    bench.tick()
            else:
                bench.spi.transfer(command("abort"))
            assert state(bench) == set()
        assert bytes(bench.stream) == self.golden(frame).stream


class TestVerilog(VerilogTests):
    examples = 15

    def test_every_configuration_bit(self):
        """All bits high, then low, over SPI; the pins follow, and the next frame is complete."""
        bench, writable = self.bench(), CHIP.writable()
        first, last = min(writable), max(writable)
        for value, mode in ((0xFF, 3), (0, 0)):
            bench.spi.transfer(bytes((0x80 | first, *[value] * (last - first + 1))))
            assert bench.spi.transfer(read_transfer(first, last - first + 1))[1:] == bytes(
                value & writable.get(address, 0) for address in range(first, last + 1)
            )
            assert int(bench.sim.mode) == mode and bool(bench.sim.unsigned_) == (mode != 0) and not bench.sim.busy
            assert int(bench.sim.balance) == (0x3FF if value else 0)
        bench.registers = dict.fromkeys(writable, 0)
        self.check(bench, FRAMES["edge"], self.golden(FRAMES["edge"]))

    def test_reset_pointer_at_the_pins(self):
        """Every row is reset, and integrates from then on, three slots before it is read."""
        bench, events, was = self.bench(), [], {}
        frame = FRAMES["a lead of the reset pointer"]
        bench.write(frame_writes(replace(frame, timing=replace(frame.timing, t_reset=60))))
        bench.spi.transfer(command("start"))  # ends within the first reset
        while bench.sim.busy:
            for pin, row in (("pixel_reset", "reset_row"), ("expose", "reset_row"), ("read", "amp_row")):
                now = bool(getattr(bench.sim, pin))
                if now and not was.get(pin):
                    events.append((pin, int(getattr(bench.sim, row))))
                was[pin] = now
            bench.tick()
        expected = []
        for slot in range(ROWS + 3):
            expected += [("pixel_reset", slot), ("expose", slot)] if slot < ROWS else []
            expected += [("read", slot - 3)] if slot >= 3 else []
        assert events == expected

    def test_overlap_saves_time(self):
        """The next row integrates while one converts: the bytes are the same, the frame is shorter."""
        streams, cycles = [], []
        for overlap in (True, False):
            bench = self.bench()
            bench.write(frame_writes(pattern_frame(overlap=overlap)))
            bench.start()
            streams.append(bytes(bench.stream))
            cycles.append(bench.status()["cycles"])
        assert streams[0] == streams[1] and cycles[0] < cycles[1]


class TestVerilogWithoutPhasePath(VerilogTests):
    sensor = OTHER


class TestIcarus(TestVerilog):
    verilog, examples = "icarus", 3
