"""Sessions: frames, loop-back, aborts, resets and refused commands in one simulation, in any order."""

import random

import pytest

from talbot.models.chip import golden_frame
from talbot.models.digital.host import command, frame_writes, read_transfer
from talbot.models.digital.pattern import PatternEnd
from talbot.models.parameters import (
    MODES,
    AmpTiming,
    ArrayParameters,
    ChipParameters,
    FrameParameters,
    ParameterError,
    SensorParameters,
    TileParameters,
    Window,
)
from talbot.models.parameters.registers import array_resets, register_map
from talbot.rtl.asp_chip import AspChip
from talbot.rtl.asp_chip.test.chip_bench import ChipBench
from talbot.rtl.harness.testbench import build

CHIP = register_map()
STATUS, OPTIONS, LOOP = (CHIP[name].byte for name in ("busy", "loop_enable", "loop_back"))
LOOP_ENABLE, REFUSED = 1 << CHIP["loop_enable"].shift, 1 << CHIP["refused"].shift
HELD_LOW = (
    "pixel_reset",
    "integrate",
    "cm_reset",
    "read",
    "hold",
    "wake",
    "convert",
    "link_val",
    "frame_sync",
    "busy",
    "miso_oe",
)


def sensor(rows, cols, lanes, tile=None, divider="radix4"):
    tile = tile or TileParameters()
    return SensorParameters(tile=tile, array=ArrayParameters(rows, cols), chip=ChipParameters(lanes, divider))


def build_chip(of, verilog):
    array, tile, chip = of.array, of.tile, of.chip
    top = AspChip(array.rows, array.cols, chip.lanes, tuple(tile.order), tile.rows, tile.cols, chip.divider)
    return build(top, verilog, f"AspChip_{array.rows}x{array.cols}x{chip.lanes}")


class Session:
    """A chip and the checks of each step of a session."""

    def __init__(self, sim, of, seed):
        self.sim, self.sensor, self.pick = sim, of, random.Random(seed)
        array, tile, chip = of.array, of.tile, of.chip
        self.pattern = PatternEnd(array.rows, array.cols, tile)
        self.kinds = tile.type_map(array.rows, array.cols)
        self.resets = array_resets(array.rows, array.cols, chip.lanes, tile.rows, tile.cols, chip.divider)
        self.bench = ChipBench(sim, chip.lanes, tile.cols, seed=seed)
        self.bench.registers = CHIP.image(CHIP.configuration, self.resets)

    def frame(self):
        """Any frame: few rows, so that it is short."""
        pick, full = self.pick, self.sensor.full_window
        row0, col0 = pick.randint(0, full.row1), pick.randint(0, full.col1)
        row1 = min(full.row1, row0 + pick.choice((0, 0, 1)))
        col1 = full.col1 if pick.random() < 0.6 else pick.randint(col0, full.col1)
        durations = {name: pick.randint(1, 4) for name in ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard")}
        mode = pick.choice(MODES)
        kinds = self.sensor.tile.n_types
        return FrameParameters(
            Window(row0, row1, col0, col1),
            mode,
            pick.choice((pick.getrandbits(kinds), (1 << kinds) - 1, 1 << pick.randrange(kinds))),
            pick.choice((0, pick.randint(0, 127), 127)),
            pick.choice((0, 0, 1, 3)),
            mode == "tof" and pick.random() < 0.7,
            pick.choice((0, pick.randint(0, 255), 255)),
            pick.random() < 0.5,
            True,
            pick.getrandbits(16),
            AmpTiming(**durations, n_cm=pick.choice((0, 0, 1, 3))),
        )

    def configure(self, frame):
        self.trims = [self.pick.randint(-512, 511) for _ in range(self.sensor.tile.n_types)]
        self.bench.write(frame_writes(frame, self.trims))

    def clean(self):
        """Check that nothing of the previous step remains."""
        bench = self.bench
        bench.stream.clear()
        bench.sync.clear()
        bench.pins.clear()
        bench.stall = self.pick.choice((0.0, 0.3, 0.8))
        bench.spi.transfer(command("refused"))

    def flags(self):
        byte = self.bench.spi.transfer(read_transfer(STATUS, 1))[1]
        return {f.name for f in CHIP.fields if f.register == "status" and byte >> f.shift & 1}

    def a_frame(self):
        """The golden bytes, and no flag but `done`; or an error and no byte."""
        frame = self.frame()
        self.configure(frame)
        self.clean()
        try:
            golden = golden_frame(None, self.sensor, frame, self.pattern)
        except ParameterError:
            self.bench.start()
            assert self.flags() == {"cfg_err"} and not self.bench.stream, frame
            return
        self.bench.start()
        assert bytes(self.bench.stream) == golden.stream and all(self.bench.sync), frame
        for _, row, col, balance in self.bench.pins:
            assert balance == self.trims[self.kinds[row, col]] % 1024
        status = self.bench.status()
        assert {name for name, value in status.items() if value is True} == {"done"}, frame
        assert (status["conversions_made"], status["conversions_left_out"]) == (golden.made, golden.left_out), frame

    def cut_frame(self):
        """A frame cut after any time: the bytes that left are the beginning of the golden stream."""
        while True:
            frame = self.frame()
            try:
                golden = golden_frame(None, self.sensor, frame, self.pattern)
            except ParameterError:
                continue
            break
        self.configure(frame)
        self.clean()
        self.bench.spi.transfer(command("start"))
        for _ in range(int(self.pick.expovariate(1 / 400))):
            self.bench.tick()
        return golden.stream

    def an_abort(self):
        """No byte after it, `aborted` and no `done` unless the frame had ended, the machines at rest; no counter."""
        golden = self.cut_frame()
        self.bench.spi.transfer(command("abort"))
        sent = bytes(self.bench.stream)
        assert golden.startswith(sent) and not self.sim.busy and not self.sim.link_val and not self.sim.frame_sync
        flags = self.flags()
        assert flags - {"done"} == {"aborted"} and ("done" in flags) <= (sent == golden)
        state = CHIP.state[0]
        assert self.bench.spi.transfer(read_transfer(state.address, state.size))[1:] == bytes(state.size)
        status = self.bench.status()
        assert not any(status[f.name] for f in CHIP.counters) and self.written() == self.bench.registers
        self.bench.spi.wait(200)
        assert bytes(self.bench.stream) == sent

    def a_reset(self):
        """Gated pins are low at once; then everything is as after the first reset."""
        golden = self.cut_frame()
        bench, sim = self.bench, self.sim
        if self.pick.random() < 0.5:
            bench.spi.transfer(read_transfer(CHIP.counters[0].byte, 8), self.pick.randrange(1, 72))
        assert golden.startswith(bytes(bench.stream))
        sim.csn @= self.pick.getrandbits(1)
        sim.reset @= 1
        sim.sim_eval_combinational()
        for _ in range(4):
            assert not any(int(getattr(sim, name)) for name in HELD_LOW)
            sim.sim_tick()
        sim.reset @= 0
        sim.csn @= 1
        bench.stream.clear()
        bench.spi.wait(8)
        bench.registers = CHIP.image(CHIP.configuration, self.resets)
        image = CHIP.image((*CHIP.configuration, *CHIP.identity), self.resets)
        # no snapshot is taken of the counters: their bytes are those of the register that the reset cleared
        counter = CHIP.counters[0].byte
        assert not any(bench.spi.transfer(read_transfer(counter + 1, 7))[1:])
        assert list(bench.spi.transfer(read_transfer(0, 128))[1:]) == [image.get(address, 0) for address in range(128)]
        assert not bench.stream

    def written(self):
        first, last = min(self.bench.registers), max(self.bench.registers)
        reply = self.bench.spi.transfer(read_transfer(first, last - first + 1))[1:]
        return {a: byte for a, byte in enumerate(reply, first) if a in self.bench.registers}

    def a_loop_back(self):
        """Bytes written come out, with a start refused; one that waits locks the configuration; an abort drops it."""
        bench, pick = self.bench, self.pick
        options = bench.registers[OPTIONS]
        self.clean()
        bench.spi.transfer(bytes((0x80 | LOOP, 0x33)))
        assert "refused" in self.flags()
        bench.spi.transfer(command("refused"))
        bench.write([(OPTIONS, options | LOOP_ENABLE)])
        bench.stall = 0.0
        data = [pick.getrandbits(8) for _ in range(pick.randint(1, 4))]
        bench.spi.transfer(bytes((0x80 | LOOP, *data)))
        bench.spi.transfer(command("start"))
        assert bench.stream == data and not any(bench.sync) and not self.sim.busy
        assert "refused" in self.flags() and "busy" not in self.flags()
        bench.spi.transfer(command("refused"))
        bench.stall = 1.0
        bench.spi.transfer(bytes((0x80 | LOOP, 0x5A, 0x5B)))
        bench.spi.transfer(bytes((0x80 | OPTIONS, options)))
        assert self.sim.link_val and self.sim.link_data == 0x5A and "refused" in self.flags()
        assert self.written() == bench.registers, "locked"
        bench.spi.transfer(command("refused"))
        aborted = pick.random() < 0.5
        if aborted:
            bench.spi.transfer(command("abort"))
            assert not self.sim.link_val and "aborted" in self.flags()
        bench.stall = 0.0
        bench.spi.wait(3)
        bench.write([(OPTIONS, options)])
        assert bench.stream == data + [0x5A] * (not aborted)

    def step(self):
        steps = [self.a_frame, self.an_abort, self.a_reset, self.a_loop_back]
        self.pick.choices(steps, (6, 2, 1, 1))[0]()


CHIPS = {"8 x 17, 1 lane": (sensor(8, 17, 1), 10)}


class TestVerilog:
    verilog = True

    @pytest.mark.parametrize("name", CHIPS)
    def test_any_session(self, name):
        of, steps = CHIPS[name]
        session = Session(build_chip(of, self.verilog), of, seed=len(name))
        session.a_reset()
        for _ in range(steps):
            session.step()
