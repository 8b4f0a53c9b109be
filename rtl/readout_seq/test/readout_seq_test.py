"""ReadoutSeq at every level: the golden scan's messages and rows, with any timing at the other ports."""

from itertools import count

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.models.digital.amp_ctrl import row_cycles
from talbot.models.parameters import AmpTiming, ParameterError
from talbot.rtl.harness.reset import outputs_after_reset
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.rtl.readout_seq import ReadoutSeq, ReadoutSeqCL, ReadoutSeqFL
from talbot.rtl.readout_seq.test.bench import (
    AFTER_RESET,
    SMALL_TILE,
    Bench,
    Record,
    Size,
    amp_ctrl,
    amplifiers,
    bank,
    check,
    check_given_up,
    messages,
    randomly,
    simulator,
)

# A test that several levels inherit runs on each of them, as intended.
SETTINGS = settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.differing_executors])
SIZES = (
    Size(7, 31, 2),
    Size(1, 1, 1),
    Size(13, 45, 4),
    Size(1, 75, 8),
    Size(9, 1, 1),
    Size(6, 130, 32),
    Size(8, 26, 4, *SMALL_TILE),
)
LARGEST = Size(1024, 1536, 1)
seeds = st.integers(0, 2**32)
masks = st.one_of(st.just(2**24 - 1), st.integers(0, 23).map(lambda t: 1 << t), st.integers(0, 2**24 - 1))


@st.composite
def configurations(draw, size):
    """Values of the configuration ports; most of them are valid."""
    ports = {
        "mode": draw(st.integers(0, 3)),
        "mask": draw(masks),
        "decimation": draw(st.integers(0, 3)),
        "overlap": draw(st.integers(0, 1)),
        "exposure": draw(st.just(0) | st.integers(1, 12)),
    }
    for axis, tiles in zip(("row", "col"), size.tiles):
        low, high = sorted(draw(st.tuples(*[st.integers(0, tiles - 1)] * 2)))
        ports |= {f"{axis}0": low, f"{axis}1": high}
    return ports


def steadily(integrate, read, conversion):
    return amplifiers(lambda: integrate, lambda: read), bank(lambda: 1, lambda: conversion)


class TestReadoutSeqFL:
    """Inherited by every level; a level overrides ``cls``, ``verilog`` and ``sizes``."""

    cls, verilog, sizes, overlaps = ReadoutSeqFL, False, SIZES, False

    def bench(self, size, surroundings):
        return Bench(simulator(self.cls, size, self.verilog), *surroundings)

    def check(self, record, scan, overlap, before=None):
        check(record, scan, overlap if self.overlaps else None, before)

    @SETTINGS
    @given(st.data(), seeds)
    def test_any_frame(self, data, seed):
        size = data.draw(st.sampled_from(self.sizes))
        surroundings, noise = randomly(seed)
        bench = self.bench(size, surroundings)
        for ports in data.draw(st.lists(configurations(size), min_size=1, max_size=2)):
            before = bench.cycle(Record())
            record = bench.frame(ports, noise)
            self.check(record, size.scan(ports), ports["overlap"], before | {"four_tap": ports["mode"] == 3})

    def test_messages_by_hand(self):
        """The types at k = 0 and k = 4 of a tile's second row; the array ends in partial tiles."""
        size = Size(7, 31, 2)  # 2 x 6 tiles, the last ones with 3 rows and 1 column
        ports = size.whole(mask=1 << size.order[6] | 1 << size.order[10], col0=1)
        record = self.bench(size, steadily(3, 1, 0)).frame(ports)
        steps = [(0, 0, 0b10), (0, 1, 0b11), (0, 2, 0b11), (4, 0, 0b10), (4, 1, 0b11), (4, 2, 0b01)]
        expected = [(FRAME, 0, 0, 0, 0, 0)]
        for row in (1, 5):
            expected += [(ROW, row, 0, 0, 0, 0)] + [(SAMPLE, row, group, k, 0, en) for k, group, en in steps]
        assert record.messages == expected + [(END, 0, 0, 0, 0, 0)]

    @pytest.mark.parametrize(
        "ports",
        [
            dict(mask=0),
            dict(row0=1, row1=0),
            dict(row1=2),
            dict(row1=255),
            dict(col0=3, col1=2),
            dict(col1=6),
            dict(row0=1, mask=sum(1 << t for t in Size(1, 1, 1).order[18:])),  # only in the last tile's missing row
            dict(
                col0=5, mask=2**24 - 1 - sum(1 << t for t in Size(1, 1, 1).order[::6])
            ),  # it has its first column only
        ],
        ids=str,
    )
    def test_refused(self, ports):
        size = Size(7, 31, 2)
        bench = self.bench(size, steadily(3, 1, 0))
        assert size.scan(size.whole(**ports)) is None
        bench.drive(**size.whole(**ports))
        record = Record()
        bench.cycle(record, start=1)
        for _ in range(20):
            pins = bench.cycle(record)
            assert pins["cfg_err"] and not pins["busy"] and not pins["amp_start"] and pins["offer"] is None
        record = bench.frame(size.whole())
        assert record.pins[0]["cfg_err"] and not any(pins["cfg_err"] for pins in record.pins[1:])
        assert record.messages == messages(size.scan(size.whole()))

    def test_nothing_of_a_frame_outlives_a_reset(self):
        """After a reset the first offer is 0 in every bit, whatever was sent before."""
        size, offers = Size(7, 31, 2), set()
        bench = self.bench(size, steadily(1, 1, 0))
        for col1 in (1, 5):
            bench.frame(size.whole(col1=col1))
            bench.reset()
            bench.drive(**size.whole())
            record = Record()
            bench.cycle(record, start=1)
            while record.standing is None and not record.taken:
                bench.cycle(record)
                offers |= {int(bench.sim.step.msg.to_bits())} if bench.sim.step.val else set()
        assert offers == {0}  # FRAME

    @SETTINGS
    @given(st.integers(0, 3), st.integers(0, 1), st.integers(0, 80), seeds)
    def test_reset_at_any_moment(self, mode, overlap, cycles, seed):
        size = self.sizes[0]
        ports = size.whole(mask=0x842, mode=mode, overlap=overlap)
        bench = self.bench(size, randomly(seed)[0])
        bench.drive(**ports)
        record = Record()
        bench.cycle(record, start=1)
        for _ in range(cycles):
            bench.cycle(record)
        bench = self.bench(size, randomly(seed)[0])
        pins = bench.cycle(Record())
        assert pins == AFTER_RESET | {"four_tap": ports["mode"] == 3}
        self.check(bench.frame(ports), size.scan(ports), ports["overlap"])

    @SETTINGS
    @given(
        st.sampled_from([0x10C842, 0x842]),
        st.integers(0, 3),
        st.integers(0, 30),
        st.integers(0, 1),
        st.integers(0, 1),
        seeds,
    )
    def test_amplifiers_refuse(self, mask, row, cycles, with_done, overlap, seed):
        """amp_err: the current offer is taken, then nothing more; the next frame is complete."""
        size = self.sizes[0]
        ports = size.whole(overlap=overlap, mask=mask)
        golden = messages(size.scan(ports))
        bench = self.bench(size, randomly(seed, (row, cycles, with_done))[0])
        record = bench.frame(ports)
        check_given_up(record, size.scan(ports))
        if (row, cycles) == (0, 0):
            assert not record.messages
        assert bench.cycle(Record())["cfg_err"]
        record = bench.frame(ports)  # amp_err stays high until its first amp_start
        assert record.messages == golden and record.pins[-1]["done"]

    @pytest.mark.parametrize("row", [0, 1])
    def test_amplifiers_refuse_whatever_is_on_offer(self, row):
        """amp_err in any cycle of FRAME, ROW, the steps, and while the bank converts the last of them."""
        size = self.sizes[0]
        ports = size.whole(overlap=1, mask=0x842)
        golden, seen = messages(size.scan(ports)), set()
        for cycles in range(1, 60, 5):
            turns = count()
            bench = self.bench(
                size,
                (
                    amplifiers(lambda: 25, lambda: 2, (row, cycles, 0)),
                    bank(lambda turns=turns: int(next(turns) % 6 == 5), lambda: 9),
                ),
            )
            record = bench.frame(ports)
            assert record.messages == golden[: len(record.messages)] and record.pins[-1]["cfg_err"]
            seen.add(len(record.messages))
            assert bench.frame(ports).messages == golden
        assert len(seen) > (row if self.overlaps else 0)

    def test_a_start_in_the_cycle_of_done_is_taken(self):
        size = Size(7, 31, 2)
        ports = size.whole(mask=1)
        bench, record = self.bench(size, steadily(3, 1, 0)), Record()
        bench.drive(**ports)
        bench.cycle(record, start=1)
        for _ in range(2):
            while not bench.sim.done:
                bench.cycle(record)
                assert len(record.pins) < 2000
            bench.cycle(record, start=1)
        assert record.messages == 2 * messages(size.scan(ports)) and bench.sim.busy

    @pytest.mark.parametrize("overlap, mode", [(0, 0), (1, 1), (1, 3)])
    def test_with_amp_ctrl(self, overlap, mode):
        size, timing = Size(7, 31, 2), AmpTiming(3, 9, 2, 2, 4, 1, n_cm=1)
        ports = size.whole(overlap=overlap, mode=mode, mask=0x842)
        _, converters = steadily(0, 0, 5)
        bench = Bench(simulator(self.cls, size, self.verilog), amp_ctrl(timing, mode == 3), converters)
        for _ in range(2):
            record = bench.frame(ports)
            self.check(record, size.scan(ports), overlap)
            for (start, _), done in zip(record.starts, record.dones):
                waits = sum(not pins["hold_free"] for pins in record.pins[start:done])
                assert row_cycles(timing, mode == 3) < done - start <= row_cycles(timing, mode == 3) + 1 + waits
        bench.surround(amp_ctrl(None, 0), bench.converters)  # all durations 0
        record = bench.frame(ports)
        assert not record.taken and record.pins[-1]["cfg_err"] and len(record.starts) == 1

    @pytest.mark.parametrize("exposure, mode", [(0, 0), (1, 2), (3, 0), (6, 0), (7, 2), (40, 0), (0, 3), (40, 3)])
    def test_reset_pointer(self, exposure, mode):
        """A row is reset as many slots ahead of its read; rows that are not read take none, time of flight none."""
        size = Size(7, 31, 2)
        for cut in (dict(), dict(row0=1), dict(mask=0x842), dict(mask=0x842, col0=1, decimation=1)):
            for overlap in (0, 1):
                ports = size.whole(**cut, exposure=exposure, mode=mode, overlap=overlap)
                self.check(self.bench(size, steadily(5, 2, 3)).frame(ports), size.scan(ports), overlap)

    def test_longest_exposure(self):
        size = Size(7, 31, 2)
        ports = size.whole(exposure=1023, overlap=1)
        record = self.bench(size, steadily(1, 1, 0)).frame(ports)
        self.check(record, size.scan(ports), 1)
        assert len(record.starts) == 7 + 1023

    def test_addresses_of_the_largest_array(self):
        size = LARGEST
        bench = self.bench(size, steadily(3, 1, 0))
        for ports in (
            size.whole(row0=254, col0=253, mode=3, overlap=1),
            size.whole(row0=200, col0=1, decimation=3),
            size.whole(row1=0, col1=0),
        ):
            ports["mask"] = 1 << size.order[23]
            self.check(bench.frame(ports), size.scan(ports), ports["overlap"])

    @pytest.mark.parametrize(
        "arguments",
        [
            dict(rows=0),
            dict(rows=1025),
            dict(cols=1537),
            dict(lanes=3),
            dict(lanes=64),
            dict(order=(0,) * 24),
            dict(tile_cols=4, order=tuple(range(16)), cols=1028),
            dict(tile_rows=5),
        ],
        ids=str,
    )
    def test_parameters(self, arguments):
        with pytest.raises(ParameterError):
            self.cls(**dict(rows=8, cols=12, lanes=2, order=Size(1, 1, 1).order) | arguments).elaborate()


class TestReadoutSeqCL(TestReadoutSeqFL):
    cls, overlaps = ReadoutSeqCL, True

    @pytest.mark.parametrize("integrate, overlap", [(10, 0), (10, 1), (400, 1)])
    def test_cycles(self, integrate, overlap):
        """Without overlap, with a row that converts longer than it integrates, and the other way round."""
        size, read, conversion = Size(7, 31, 2), 4, 6
        ports = size.whole(mask=2**24 - 1, overlap=overlap, mode=2)
        record = self.bench(size, steadily(integrate, read, conversion)).frame(ports)
        rows, steps = 7, 2 * 6 * 3  # a tile row: six columns, three groups, two diodes
        amp, convert = integrate + read + 1, steps + 3 + conversion
        first, last = 1 + amp, convert + 1
        if not overlap:
            between = amp + convert
        elif integrate == 400:
            between = amp + 1
        else:
            between = read + 1 + convert
        assert record.pins[-1]["cycles"] == first + (rows - 1) * between + last - 1
        taken = [cycle for cycle, msg in record.taken if msg[0] == SAMPLE and msg[1] == 0]
        assert taken == list(range(taken[0], taken[0] + steps))

    @SETTINGS
    @given(st.data(), seeds)
    def test_same_cycles_as_the_cycle_level(self, data, seed):
        size = data.draw(st.sampled_from(self.sizes))
        ports = data.draw(configurations(size))
        err_at = data.draw(st.none() | st.tuples(st.integers(0, 3), st.integers(0, 50), st.integers(0, 1)))

        def trace(cls, verilog):
            surroundings, noise = randomly(seed, err_at)
            return Bench(simulator(cls, size, verilog), *surroundings).frame(ports, noise).pins

        assert trace(self.cls, self.verilog) == trace(ReadoutSeqCL, False)


class TestReadoutSeqRTL(TestReadoutSeqCL):
    cls = ReadoutSeq

    def test_outputs_after_a_reset(self):
        for size in self.sizes:
            golden = outputs_after_reset(simulator(ReadoutSeqFL, size, False), before=0)
            assert outputs_after_reset(simulator(self.cls, size, self.verilog)) == golden, size


class TestReadoutSeqVerilog(TestReadoutSeqRTL):
    verilog = True
    sizes = Size(7, 31, 2), Size(13, 75, 8)


class TestReadoutSeqIcarus(TestReadoutSeqVerilog):
    verilog = "icarus"
