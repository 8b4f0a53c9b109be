"""RunLength at every level: the golden encoder's bytes, whatever the timing of either side."""

import dataclasses
import random
import struct
from functools import cache
from itertools import product

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.models.digital.stream import StreamHeader, decode_stream, encode_frame, encode_marked, segments
from talbot.models.digital.stream.payload import K_MAX, TOKEN_MAX, code_sample, start
from talbot.models.digital.stream.test.frames import ports_of, samples_of
from talbot.models.digital.stream.trailer import trailer
from talbot.models.parameters import LANES as LANE_COUNTS
from talbot.models.parameters import MODES, AmpTiming, FrameParameters, Window
from talbot.models.parameters.stream_format import FIELD_BYTES, HEADER_BYTES, TRAILER_BYTES
from talbot.rtl.harness.reset import outputs_after_reset
from talbot.rtl.harness.testbench import build
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE, ScanMsg
from talbot.rtl.run_length import RunLength, RunLengthCL, RunLengthFL
from talbot.rtl.run_length.header_rtl import HeaderBytes

ROWS, COLS, LANES = 12, 36, 4
CHIP = ROWS, COLS, LANES, 4, 6
ALWAYS = [True]
SETTINGS = settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.differing_executors])
BURSTS = st.lists(st.booleans(), min_size=1, max_size=12).filter(any)


@cache
def simulator(cls, verilog, chip=CHIP):
    return build(cls(*chip), verilog, "RunLength")


def header_of(mode="edge", window=Window(0, 2, 0, 5), **frame):
    return StreamHeader.from_frame(ROWS, COLS, LANES, FrameParameters(window, mode, **frame))


def messages_of(header, samples):
    """Return the scan's messages of a frame."""
    layout, out = header.layout(), [ScanMsg(FRAME, 0)]
    for i, row in enumerate(layout.rows.tolist()):
        codes = samples.reshape(header.rows, -1)[row, layout.places_of(i)]
        out += [ScanMsg(ROW, row)] + [ScanMsg(SAMPLE, int(code) & 0xFF) for code in codes]
    return out + [ScanMsg(END, 0)]


def scan_of(rows):
    """Return the scan's messages of a frame of any rows: (index, codes)."""
    out = [ScanMsg(FRAME, 0)]
    for row, codes in rows:
        out += [ScanMsg(ROW, row), *(ScanMsg(SAMPLE, int(code) & 0xFF) for code in codes)]
    return [*out, ScanMsg(END, 0)]


def stream_of(header, rows, made, left_out):
    """Return the golden bytes of such a frame."""
    first = header.to_bytes()
    coder = header.coder
    body = b"".join(encode_marked(row, codes, *coder) for row, codes, _ in segments(header, rows))
    return first + body + trailer(first, body, made, left_out)


class Bench:
    """Sends a frame's messages and takes its bytes; ``log``: (rdy, val, byte, frame_sync) of every cycle.

    Always: frame_sync rises with a frame's first byte and falls when its last one is taken; ``frames``: how often.
    """

    def __init__(self, cls, verilog, header, made=0, left_out=0, chip=CHIP):
        self.sim = simulator(cls, verilog, chip)
        self.configure(header, made, left_out)
        self.reset()

    def configure(self, header, made=0, left_out=0):
        """Set the configuration and counts of another frame."""
        for name, value in ports_of(header).items():
            port = getattr(self.sim, name)
            port @= value
        self.counts = made, left_out

    def reset(self):
        self.log, self.frames, self.before = [], 0, (False, False)
        self.sim.recv.val @= 0
        self.sim.send.rdy @= 0
        self.sim.reset @= 1
        self.sim.sim_tick()
        self.sim.reset @= 0

    def run(self, messages, offered=ALWAYS, taken=ALWAYS, rest=30, most=None):
        """Offer messages in the cycles that ``offered`` names and take bytes in those of ``taken`` (both cyclic),

        until all messages are taken and frame_sync has been low for ``rest`` cycles and more, or for ``most`` cycles;
        returns the bytes.
        """
        sim, out, sent, quiet = self.sim, bytearray(), 0, 0
        first = len(self.log)
        while quiet < rest + len(taken) + len(offered) and (cycle := len(self.log)) - first != most:
            assert cycle - first < 50_000
            ready = taken[(cycle - first) % len(taken)]
            offer = sent < len(messages) and offered[(cycle - first) % len(offered)]
            sim.recv.val @= offer
            sim.recv.msg @= messages[sent] if offer else ScanMsg(3, 0x3FF)
            held = sent == len(messages) or messages[sent].kind in (END, FRAME) and sent
            sim.made @= self.counts[0] if held else 0  # from END to the end of the frame
            sim.left_out @= self.counts[1] if held else 0
            sim.send.rdy @= ready
            sim.sim_eval_combinational()
            state = bool(sim.recv.rdy), bool(sim.send.val), int(sim.send.msg), bool(sim.frame_sync)
            self.log.append(state)
            was_sync, was_taken = self.before
            assert state[3] or not state[1]
            assert state[3] == was_sync or (state[1] if state[3] else was_taken)
            self.frames += state[3] and not was_sync
            self.before = state[3], state[1] and ready
            quiet = 0 if state[3] or sent < len(messages) else quiet + 1
            if state[1] and ready:
                out.append(state[2])
            sent += offer and state[0]
            sim.sim_tick()
        return bytes(out)


def burst(pick):
    """Cycles in which a side is ready: always, rarely, any."""
    return pick.choice(
        (ALWAYS, [False] * pick.randint(1, 9) + [True], [pick.random() < 0.6 for _ in range(9)] + [True])
    )


def counts_of(pick):
    return pick.getrandbits(32), pick.getrandbits(32)


def any_header(pick):
    """A header of a few tiles of the small chip."""
    mode = pick.choice(MODES)
    return header_of(
        mode,
        Window(row := pick.randint(0, 2), row, col := pick.randint(0, 4), col + 1),
        phase=mode == "tof" and pick.random() < 0.5,
        mask=pick.choice([2**24 - 1, 0xF0F, 1, 0x800001]),
        threshold=pick.choice((0, 1, pick.randint(0, 127), 127)),
        decimation=pick.randint(0, 3),
        frame_number=pick.getrandbits(16),
        resync=pick.randint(0, 3),
        calibration=pick.getrandbits(8),
        timing=AmpTiming(n_cm=pick.getrandbits(8), t_int=pick.randint(1, 65535), exposure=pick.getrandbits(10)),
    )


@cache
def longest_token(place, order):
    """Codes, at threshold 4, after which the longest token begins at ``place`` in a byte; the coder's state; a run."""
    pick = random.Random(8 * place + order)
    while True:
        codes, state, sent = [], start(4), 0
        begin = [pick.choice((-40, -9, -4, 4, 5, 9)) for _ in range(pick.randrange(12))]
        while begin or state[0] < K_MAX:
            codes.append(begin.pop() if begin else 0)
            _, length, *state = code_sample(codes[-1], 4, *state)
            sent += length
        if (sent % 8, state[1] // 2 + 1, state[2]) == (place, order, 0):
            return codes, state, pick.choice((0, 682, 1365, 2047))


@st.composite
def frames(draw):
    """Header, samples and counts of a frame of the small chip."""
    mode = draw(st.sampled_from(MODES))
    row0, row1 = sorted(draw(st.integers(0, 2)) for _ in range(2))
    col0, col1 = sorted(draw(st.integers(0, 5)) for _ in range(2))
    header = header_of(
        mode,
        Window(row0, row1, col0, col1),
        phase=mode == "tof" and draw(st.booleans()),
        mask=draw(st.sampled_from([2**24 - 1, 0xF0F, 1, 0x800001])),
        threshold=draw(st.one_of(st.integers(0, 4), st.integers(0, 127))),
        decimation=draw(st.integers(0, 3)),
        frame_number=draw(st.integers(0, 65535)),
        resync=draw(st.integers(0, 3)),
        calibration=draw(st.integers(0, 255)),
    )
    count = st.integers(0, 2**32 - 1)
    samples = samples_of(header, draw(st.integers(0, 999)), draw(st.floats(0, 1)), draw(st.sampled_from([3, 30, 300])))
    return header, samples, draw(count), draw(count)


class TestRunLengthFL:
    """Inherited by every level; a level overrides ``cls`` and ``verilog``."""

    cls, verilog, many = RunLengthFL, False, 12

    @classmethod
    def bench(cls, *args):
        return Bench(cls.cls, cls.verilog, *args)

    @SETTINGS
    @given(frames(), BURSTS, BURSTS)
    def test_any_frame_and_any_timing(self, frame, offered, taken):
        header, samples, made, left_out = frame
        got = self.bench(header, made, left_out).run(messages_of(header, samples), offered, taken)
        assert got == encode_frame(header, samples, made, left_out)

    @pytest.mark.parametrize("kind", ["zeros", "noise", "alternating", "one", "last", "least", "inside", "highest"])
    def test_extreme_rows(self, kind):
        header = header_of(threshold={"inside": 5, "highest": 127}.get(kind, 0))
        samples = np.zeros((ROWS, COLS, 1), int)
        if kind == "noise":
            samples = np.random.default_rng(0).integers(-128, 128, samples.shape)
        elif kind == "alternating":
            samples[:, ::2] = -128
            samples[:, 1::2] = 127
        elif kind == "one":
            samples[:, 0] = -1
        elif kind == "last":
            samples[:, -1] = 1
        elif kind == "least":
            samples[:] = np.arange(-3, 3).repeat(6)[:, None]
        elif kind == "inside":  # codes that no converter produces with this threshold
            samples[:] = np.arange(-18, 18)[:, None] // 2
        elif kind == "highest":
            samples[:] = np.array([-128, -127, 0, 127])[np.arange(COLS) % 4][:, None]
        got = self.bench(header, 2**32 - 1, 0).run(messages_of(header, samples))
        assert got == encode_frame(header, samples, 2**32 - 1, 0)

    def test_a_long_run_of_zeros(self):
        """Runs up to the longest token and beyond: 384 samples a row, all but the first and the last zero."""
        row = np.zeros(384, int)
        row[[0, -1]] = 9, -7
        messages = [ScanMsg(FRAME, 0)]
        for number in range(3):
            messages += [ScanMsg(ROW, number)] + [ScanMsg(SAMPLE, int(code) & 0xFF) for code in row]
        header = header_of()
        got = self.bench(header).run(messages + [ScanMsg(END, 0)])
        wide = StreamHeader.from_frame(3, 384, 1, FrameParameters(Window(0, 0, 0, 63)))
        layout, samples = wide.layout(), np.zeros((3, 384, 1), int)
        for i in range(3):
            samples[i, layout.places_of(i), 0] = row
        assert got[HEADER_BYTES:-TRAILER_BYTES] == encode_frame(wide, samples, 0, 0)[HEADER_BYTES:-TRAILER_BYTES]

    def test_frame_sync_is_low_between_frames(self):
        header = header_of(threshold=3, frame_number=77)
        samples = samples_of(header, 2)
        messages = messages_of(header, samples)
        bench = self.bench(header, 5, 6)
        assert bench.run(messages * 3, taken=[True, False, True]) == encode_frame(header, samples, 5, 6) * 3
        sync = "".join("1" if state[3] else "0" for state in bench.log)
        assert len(sync.replace("0", " ").split()) == 3
        assert all(state[3] for state in bench.log if state[1])

    def test_messages_outside_a_frame_are_dropped(self):
        header = header_of()
        samples = samples_of(header, 4)
        messages = messages_of(header, samples)
        stray = [ScanMsg(SAMPLE, 3), ScanMsg(ROW, 1), ScanMsg(SAMPLE, 3), ScanMsg(END, 0)]
        bench = self.bench(header)
        got = bench.run(
            stray
            + messages[:1]
            + [ScanMsg(SAMPLE, 9), ScanMsg(FRAME, 0), ScanMsg(SAMPLE, 9)]
            + messages[1:20]
            + messages[:1]
            + messages[20:]
        )
        assert got == encode_frame(header, samples, 0, 0)

    def test_a_frame_without_rows(self):
        got = self.bench(header_of(), 1, 2).run([ScanMsg(FRAME, 0), ScanMsg(END, 0)])
        (frame,) = decode_stream(got)
        assert (
            len(got) == HEADER_BYTES + TRAILER_BYTES
            and (frame.made, frame.left_out) == (1, 2)
            and len(frame.bad_rows) == ROWS
        )

    def test_rows_without_samples(self):
        """A mark each where rows are marked: the CRC of nothing, and the row."""
        rows = 4, 0x3FF, 0, 0x155, 0x2AA, 0
        messages = [ScanMsg(FRAME, 0), *(ScanMsg(ROW, row) for row in rows), ScanMsg(END, 0)]
        got = self.bench(header_of(resync=0)).run(messages)
        assert got[HEADER_BYTES:-TRAILER_BYTES] == b"".join((0xFFFF ^ row).to_bytes(2, "big") for row in rows)
        assert self.bench(header_of()).run(messages)[HEADER_BYTES:-TRAILER_BYTES] == (0xFFFF ^ 4).to_bytes(2, "big")

    @pytest.mark.parametrize("place, order", [(0, 1), (1, 1), (6, 1), (7, 1), (7, 2), (7, 4)])
    def test_the_longest_tokens(self, place, order):
        """After runs of 2^11 zeros the value of most bits, at every place in a byte."""
        header = header_of(threshold=4)
        codes, state, run = longest_token(place, order)
        rows = [(0, [*codes, *[0] * run, 127, -128])]  # a token that ends in ones: all bits of the register
        assert code_sample(127, header.threshold, *state)[1] == TOKEN_MAX + 1 - order
        assert self.bench(header).run(scan_of(rows)) == stream_of(header, rows, 0, 0)

    def test_segments(self):
        """Rows up to a mark: none, some and all of them, ends on a byte and in one, in runs and between them."""
        pick = random.Random(5)
        for resync, mode in product(range(4), ("edge", "raw")):
            sizes = [pick.choice((0, 1, 5, 30, 63, 64, 65, 100)) for _ in range(9)]
            sizes += [
                64 * resync + by for by in range(-1, 3)
            ]  # raw: the last bytes that count go as the next row comes
            rows = [
                (row, [pick.choice((0, 0, 0, 9, -40)) & (0xFF if mode == "raw" else -1) for _ in range(size)])
                for row, size in enumerate(sizes)
            ]
            header = header_of(mode, threshold=1, resync=resync)
            marks = [first for first, _, _ in segments(header, rows)]
            assert (len(marks) == len(rows)) == (resync == 0) and len(marks) > 1
            got = self.bench(header).run(scan_of(rows), taken=pick.choice((ALWAYS, [True, False, True])))
            assert got == stream_of(header, rows, 0, 0)

    def test_a_run_goes_on_over_rows(self):
        header, zeros = header_of(resync=3), [(row, [0] * 36) for row in range(20)]
        rows = [*zeros, (20, [0, 0, 77]), *zeros[:3]]
        got = self.bench(header).run(scan_of(rows))
        assert got == stream_of(header, rows, 0, 0) and len(got) < HEADER_BYTES + TRAILER_BYTES + 8

    def test_the_largest_order_of_the_runs_stays(self):
        header, rows = header_of(threshold=4), [(0, [*[0] * 9000, 5])]
        assert self.bench(header).run(scan_of(rows)) == stream_of(header, rows, 0, 0)

    def test_the_largest_order_of_the_values_stays(self):
        """Values that raise their order half a bit at a time to its end and go on."""
        codes = [13, -13, 25, 25, -49, 49, 97, -97, 127, -128, 127, 64]
        header, rows = header_of(threshold=1), [(0, codes), (1, codes[::-1])]
        assert self.bench(header).run(scan_of(rows)) == stream_of(header, rows, 0, 0)

    def test_zeros_among_single_samples(self):
        """Under the noise: samples one by one, runs that begin and end, thresholds on both sides of the limit."""
        pick = random.Random(7)
        codes = [pick.choice((0, -1, 1, -2, 5)) for _ in range(60)] + [0] * 40
        codes += [pick.choice((0, 0, 3, -4)) for _ in range(60)]
        for threshold in range(6):
            header, rows = header_of(threshold=threshold), [(3, codes), (4, codes[::-1])]
            assert self.bench(header).run(scan_of(rows)) == stream_of(header, rows, 0, 0)

    def test_signs(self):
        """Runs of every length and neighbours of both signs, whatever the threshold; the order rises to its end."""
        pick, codes = random.Random(9), []
        for size in range(11):
            codes += [0] * pick.randrange(1 << size) + [pick.choice((-1, 1)) for _ in range(pick.randint(1, 4))]
        for threshold in (0, 3, 10, 127):
            header, rows = header_of("ternary", threshold=threshold), [(3, codes), (4, codes[::-1]), (5, [0] * 99)]
            assert self.bench(header).run(scan_of(rows)) == stream_of(header, rows, 0, 0)

    def test_frames_back_to_back(self):
        """Each frame is complete after frames of any mode, messages out of place, or a reset in a frame."""
        pick, bench = random.Random(2), self.bench(header_of())
        for _ in range(self.many):
            what, header = pick.choice(("nothing", "no frame", "rows", "reset")), any_header(pick)
            if what == "no frame":
                assert bench.run([ScanMsg(pick.randint(1, 3), pick.randint(0, 255)) for _ in range(9)], rest=1) == b""
            elif what == "rows":
                rows = [(pick.getrandbits(10), []) for _ in range(pick.randint(0, 3))]
                bench.configure(header, *counts_of(pick))
                assert bench.run(scan_of(rows), rest=1) == stream_of(header, rows, *bench.counts)
            elif what == "reset":
                bench.configure(header)
                messages = messages_of(header, samples_of(header, pick.getrandbits(9)))
                bench.run(messages, burst(pick), burst(pick), most=pick.randint(1, 200))
                bench.reset()
            header, frames = any_header(pick), bench.frames
            samples = samples_of(header, pick.getrandbits(9), pick.random(), pick.choice((3, 30, 300)))
            bench.configure(header, *counts_of(pick))
            got = bench.run(messages_of(header, samples), burst(pick), burst(pick), rest=pick.randint(0, 2))
            assert got == encode_frame(header, samples, *bench.counts) and bench.frames == frames + 1

    def test_counts_of_all_bits(self):
        for made, left_out in (
            (0x01234567, 0x89ABCDEF),
            (2**32 - 1, 0x89ABCDEF),
            (0x89ABCDEF, 2**32 - 1),
            (2**32 - 1, 0),
            (0, 2**32 - 1),
            (0x5A5A5A5A, 0xA5A5A5A5),
            (0, 0),
        ):
            (frame,) = decode_stream(self.bench(header_of(), made, left_out).run([ScanMsg(FRAME, 0), ScanMsg(END, 0)]))
            assert (frame.made, frame.left_out) == (made, left_out)

    def test_reset_in_a_frame(self):
        header = header_of(threshold=3)
        samples = samples_of(header, 6)
        messages = messages_of(header, samples)
        for cycles, stalled in ((31, 50), (40, 50), (104, 0)):  # a link that stalls: bytes wait everywhere
            self.bench(header).run(messages, taken=[True] * cycles + [False] * 50, most=cycles + stalled)
            assert self.bench(header).run(messages) == encode_frame(header, samples, 0, 0)


class TestRunLengthCL(TestRunLengthFL):
    cls = RunLengthCL

    @SETTINGS
    @given(frames(), BURSTS, BURSTS)
    def test_equals_the_cycle_level_in_every_cycle(self, frame, offered, taken):
        header, samples, *counts = frame
        benches = [self.bench(header, *counts), Bench(RunLengthCL, False, header, *counts)]
        for bench in benches:
            bench.run(messages_of(header, samples), offered, taken)
        logs = [[state if state[1] else (state[0], False, None, state[3]) for state in bench.log] for bench in benches]
        assert logs[0] == logs[1]

    def test_a_sample_a_cycle_and_a_byte_a_cycle(self):
        """Besides header, samples and trailer, a row takes its message, its last byte or two and its mark."""
        for mode, share in (("edge", 0), ("edge", 0.2), ("edge", 1), ("ternary", 0.2), ("raw", 1)):
            header = header_of(mode)
            messages = messages_of(header, samples_of(header, 1, share, 10))
            bench = self.bench(header)
            bench.run(messages)
            samples = len(messages) - 2 - ROWS
            assert 0 <= sum(state[3] for state in bench.log) - (HEADER_BYTES + samples + 14) <= 5 * ROWS + 2


class TestRunLength(TestRunLengthCL):
    cls = RunLength

    def test_outputs_after_a_reset(self):
        golden = outputs_after_reset(simulator(RunLengthFL, False), before=0)
        assert outputs_after_reset(simulator(self.cls, self.verilog)) == golden

    def test_all_bits_of_the_header(self):
        """Any values at the ports of the header; the other levels accept valid frames only."""
        pick, bench = random.Random(6), self.bench(header_of())
        fixed = int.from_bytes(header_of().to_bytes()[:FIELD_BYTES], "big")
        places = dict(
            resync=182, decimation=180, phase=178, mode=176, threshold=168, row0=112, row1=104, col0=96, col1=88
        )
        places |= dict(mask=64, frame_number=48, exposure=32, n_cm=24, t_int=8, calibration=0)  # from the end
        for turn in range(20):
            expected = fixed
            for name, low in places.items():
                port = getattr(bench.sim, name)
                ones = (1 << port.nbits) - 1
                value = (0, ones)[turn] if turn < 2 else pick.randint(0, ones)
                port @= value
                if name == "mode":  # its third bit is apart, and set in ternary mode alone
                    value, ones = value & 3 | (value == 4) << 3, 0b1011
                expected = expected & ~(ones << low) | value << low
            got = bench.run([ScanMsg(FRAME, 0), ScanMsg(END, 0)], rest=1)
            assert got[:FIELD_BYTES] == expected.to_bytes(FIELD_BYTES, "big")


class TestRunLengthVerilog(TestRunLength):
    verilog = True


class TestRunLengthIcarus(TestRunLength):
    verilog = "icarus"


class TestRunLengthEveryInput:
    """Tests that take too long at other levels."""

    verilog = True

    def check(self, header, rows, offered=ALWAYS, taken=ALWAYS, counts=(0, 0)):
        bench = Bench(RunLength, True, header, *counts)
        assert bench.run(scan_of(rows), offered, taken, rest=1) == stream_of(header, rows, *counts)
        return len(bench.log)

    def test_every_code_at_every_threshold(self):
        pick = random.Random(3)
        for threshold in range(128):
            codes = pick.sample(range(-128, 128), 256)
            self.check(header_of(threshold=threshold), [(pick.getrandbits(10), codes)])

    def test_every_state_of_the_coder(self):
        """Rows of any length whose runs and values grow and shrink, a frame of more than 256 rows."""
        pick, rows = random.Random(4), []
        for _ in range(300):
            scale, codes = pick.choice((1, 2, 8, 30, 127)), []
            for _ in range(pick.choice((0, 0, 0, 0, 1, 2, 20))):
                codes += [0] * pick.choice((0, 0, 1, pick.randint(0, 9), 1 << pick.randint(0, 7)))
                codes += [max(-128, min(127, round(pick.gauss(0, scale)))) for _ in range(pick.randint(0, 9))]
            rows.append((pick.getrandbits(10), codes))
        for threshold, mode in ((0, "edge"), (3, "edge"), (9, "edge"), (60, "edge"), (0, "raw")):
            plain = [(row, [code & 0xFF for code in codes]) for row, codes in rows]
            self.check(header_of(mode, threshold=threshold), rows if mode == "edge" else plain)

    def test_the_longest_runs_under_the_noise(self):
        """Their order rises in quarter steps to its end."""
        self.check(header_of(threshold=3), [(1, [0] * 12_000 + [-128, 9, 0, 0])])

    def test_a_stall_in_any_cycle(self):
        """Of the link or the scan, of one cycle or some."""
        header, rows = header_of(threshold=3), [(0x155, [-128, 3, 0, -128]), (0x2AA, [])]
        cycles = self.check(header, rows)
        for length, at in product((1, 3), range(cycles)):
            stalled = [True] * at + [False] * length + [True] * cycles
            self.check(header, rows, taken=stalled, counts=(at, length))
            self.check(header, rows, offered=stalled)


class TestRunLengthSizes:
    verilog = None  # in PyMTL; not recorded: verif/coverage would compile every size

    @pytest.mark.parametrize(
        "chip",
        [
            (1, 1, 1, 1, 1),
            (1024, 1536, 32, 4, 6),
            (1023, 1535, 16, 4, 6),
            (767, 1279, 8, 3, 5),
            (513, 1025, 2, 3, 6),
            (256, 255, 4, 1, 1),
            (2, 86, 1, 2, 4),
            (341, 682, 32, 4, 3),
            (682, 1365, 2, 3, 6),
        ],
        ids=str,
    )
    def test_header_of_every_size(self, chip):
        header = dataclasses.replace(
            header_of(), **dict(zip(("rows", "cols", "lanes", "tile_rows", "tile_cols"), chip))
        )
        bench = Bench(RunLength, False, header, 3, 4, chip)
        rows = [(chip[0] - 1, [1, 0, 0])]
        assert bench.run(scan_of(rows)) == stream_of(header, rows, 3, 4)

    @pytest.mark.parametrize("lanes", LANE_COUNTS)
    def test_geometry_of_every_tile(self, lanes):
        """The bytes of lanes, tile, rows and columns, which no input changes."""
        for number, tile in enumerate(product(range(1, 5), range(1, 7))):
            chip = 1024 - 41 * number, 37 * number + 1, lanes, *tile
            header = build(HeaderBytes(*chip))
            for index, octet in enumerate(struct.pack(">BBHH", lanes, tile[0] << 4 | tile[1], *chip[:2]), 7):
                header.index @= index
                header.sim_eval_combinational()
                assert header.octet == octet, (chip, index)
