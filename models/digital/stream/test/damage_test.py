"""One wrong byte is corrected, a damaged segment costs that segment alone, and the decoder never crashes, hangs or
reports wrong samples.
"""

import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.digital.stream import StreamError, decode_stream, encode_frame, encode_marked, segments
from talbot.models.digital.stream.payload import check_segment
from talbot.models.digital.stream.test.frames import header_of, headers, samples_of
from talbot.models.parameters.stream_format import FIELD_BYTES, HEADER_BYTES, TRAILER_BYTES

FRAMES = {
    "edge": header_of(12, 30, threshold=4, resync=0),
    "segments": header_of(40, 30, threshold=4, resync=1),
    "ternary": header_of(40, 30, mode="ternary", resync=1),
    "rough": header_of(9, 20, threshold=0, resync=0),
    "raw": header_of(7, 13, mode="raw", resync=0),
    "long raw": header_of(20, 13, mode="raw", resync=1),
    "phase": header_of(5, 18, mode="tof", phase=True, resync=0),
    "masked": header_of(16, 36, mask=0x00F0F1, threshold=6, resync=0),
    "few rows": header_of(60, 36, mask=0x0000F1, threshold=2, resync=1),
}


def sent(name):
    header = FRAMES[name]
    samples = samples_of(header, 5, 1 if name == "rough" else 0.3)
    return header, samples, encode_frame(header, samples, 1000, 2000)


def changed(data, position, change):
    data = bytearray(data)
    data[position] ^= change
    return bytes(data)


def starts_of(header, samples):
    """Where each segment starts in the frame, and the trailer; and the segments' rows."""
    layout, at, rows = header.layout(), [HEADER_BYTES], []
    lines = samples.reshape(header.rows, -1)
    for row, codes, many in segments(
        header, ((row, lines[row, layout.places_of(i)]) for i, row in enumerate(layout.rows))
    ):
        at.append(at[-1] + len(encode_marked(int(row), codes, *header.coder)))
        first = layout.rows.tolist().index(row)
        rows.append(layout.rows[first : first + many].tolist())
    return at, rows


def check_rows_lost(frame, header, samples, bad):
    assert frame.header == header and frame.bad_rows == bad and frame.complete != bool(bad)
    good = np.ones(header.rows, bool)
    good[bad] = False
    assert np.array_equal(frame.samples[good], samples[good]) and not frame.samples[~good].any()
    assert not frame.read[~good].any()
    assert (frame.made, frame.left_out) == (1000, 2000)
    assert frame.errors


@pytest.mark.parametrize("name", FRAMES)
def test_one_wrong_byte_anywhere_is_corrected(name):
    header, samples, data = sent(name)
    rng = np.random.default_rng(1)
    for position in range(len(data)):
        change = (1, 0xFF, int(rng.integers(1, 256)))[position % 3]
        (frame,) = decode_stream(changed(data, position, change))
        check_rows_lost(frame, header, samples, [])
        at_end = position >= len(data) - 4  # the frame's CRC-32 itself
        assert ("CRC-32" if at_end else f"byte {position}: byte of ") in frame.errors[0]
        assert frame.stop == len(data)


@pytest.mark.parametrize("name", FRAMES)
def test_two_wrong_bytes_anywhere_in_a_segment_cost_that_segment(name):
    header, samples, data = sent(name)
    starts, rows = starts_of(header, samples)
    assert starts[-1] == len(data) - TRAILER_BYTES and len(rows) > 2
    rng = np.random.default_rng(1)
    for lost, start, stop in zip(rows, starts, starts[1:], strict=False):
        for position in range(start, stop - 1):
            first, second = rng.integers(1, 256, 2).tolist()
            (frame,) = decode_stream(changed(changed(data, position, first), position + 1, second))
            check_rows_lost(frame, header, samples, lost)
            assert frame.stop == len(data)


def test_one_wrong_byte_costs_a_row_where_the_frame_has_no_known_end():
    """With other bytes after the frame its CRC-32 cannot be found, and cannot correct: the row is reported.

    (After the last row only the trailer can be found, which is not enough to accept it.)
    """
    header, samples, data = sent("edge")
    starts, _ = starts_of(header, samples)
    for position in range(HEADER_BYTES, starts[-2]):
        (frame,) = decode_stream(changed(data, position, 0x99) + bytes(20))
        check_rows_lost(frame, header, samples, [int(np.searchsorted(starts, position, "right")) - 1])


def test_wrong_byte_between_frames_keeps_the_frames_around():
    header, samples, data = sent("edge")
    for position in range(0, len(data), 3):
        frames = decode_stream(data + changed(data, position, 0x55) + data)
        assert [f.complete for f in frames] == [True] * 3
        assert not frames[0].errors and frames[1].errors and not frames[2].errors


def test_a_mark_that_fits_by_chance_is_seen_through():
    """A wrong byte may change a row's length and still leave a mark that fits: 1 in 65536 does, found here."""
    header = header_of(40, 60, threshold=0, resync=0)
    samples = samples_of(header, 2, 0.5)
    data = encode_frame(header, samples, 1000, 2000)
    starts, _ = starts_of(header, samples)
    counts = np.full(40, 60, np.int32)
    where, value, cases = np.empty(60, np.int32), np.empty(60, np.int16), 0
    for row, (start, stop) in enumerate(zip(starts, starts[1:], strict=False)):
        view = np.frombuffer(bytearray(data), np.uint8)
        for position in range(start, stop):
            for change in range(1, 256):
                view[position] ^= change
                end, index, *_ = check_segment(view, start, view.size, row, counts, True, 1, 0, where, value)
                if end >= 0 and index == row:
                    assert end != stop
                    check_rows_lost(decode_stream(view.tobytes())[0], header, samples, [])
                    cases += 1
                view[position] ^= change
    assert cases


@pytest.mark.parametrize("name", FRAMES)
def test_cut_short_anywhere(name):
    """Whatever is whole is kept; only a file without a whole header is hopeless."""
    header, samples, data = sent(name)
    (starts, groups), rows = starts_of(header, samples), header.layout().rows
    for length in range(len(data)):
        if length < HEADER_BYTES:
            with pytest.raises(StreamError):
                decode_stream(data[:length])
            continue
        (frame,) = decode_stream(data[:length])
        whole = sum(len(s) for s, stop in zip(groups, starts[1:]) if stop <= length)
        assert frame.bad_rows == rows[whole:].tolist() and frame.errors and frame.stop == length
        assert np.array_equal(frame.samples[rows[:whole]], samples[rows[:whole]])
        assert (frame.made is None) == (length < len(data) - 4)
        assert not frame.complete


@pytest.mark.parametrize("kind", ["counts", "both"])
def test_trailer_damaged_worse(kind):
    header, samples, data = sent("edge")
    data = changed(changed(data, len(data) - 12, 7), len(data) - (11 if kind == "counts" else 2), 7)
    for after in (b"", data):
        frame = decode_stream(data + after)[0]
        assert frame.made is None and not frame.bad_rows and "trailer" in frame.errors[0]
        assert np.array_equal(frame.samples, samples) and frame.stop == len(data)


def test_bytes_lost_or_put_in():
    """The rows after a gap are found again."""
    header = header_of(48, 60, threshold=4, resync=0)
    samples = samples_of(header, 3)
    data, (starts, _) = encode_frame(header, samples, 1000, 2000), starts_of(header, samples)
    for first, last, more in ((10, 10, b""), (10, 13, b""), (20, 20, bytes(50)), (20, 20, b"\xff"), (5, 40, b"abc")):
        cut = data[: starts[first] + 2] + more + data[starts[last] + 5 :]
        (frame,) = decode_stream(cut)
        check_rows_lost(frame, header, samples, list(range(first, last + 1)))
    for first, last in ((0, 1), (7, 30), (0, 48)):
        (frame,) = decode_stream(data[: starts[first]] + data[starts[last] :])
        check_rows_lost(frame, header, samples, list(range(first, last)))


@pytest.mark.parametrize("mode, step", [("raw", 2), ("edge", 3)])
def test_many_damaged_rows(mode, step):
    """Rows of plain bytes are good or bad one by one; a run-length coded one is found by the row after it."""
    header = header_of(200, 60, mode=mode, threshold=0, resync=0)
    samples = samples_of(header, 3)
    data, (starts, _) = bytearray(encode_frame(header, samples, 1000, 2000)), starts_of(header, samples)
    for start in starts[1:-1:step]:
        data[start + 5] ^= 0x10
        data[start + 6] ^= 0x01
    (frame,) = decode_stream(bytes(data))
    check_rows_lost(frame, header, samples, list(range(1, 200, step)))


@pytest.mark.parametrize("name", ["edge", "segments", "rough", "few rows"])
def test_a_good_segment_between_two_bad_ones_is_decoded(name):
    """All bytes of the bad ones are random: of 60 pairs at least 59 cost these two alone, and no sample is wrong."""
    header, samples, data = sent(name)
    starts, rows = starts_of(header, samples)
    rng, lost = np.random.default_rng(2), []
    for _ in range(60):
        first = int(rng.integers(len(rows) - 2))
        damaged = bytearray(data)
        for segment in (first, first + 2):
            start, size = starts[segment], starts[segment + 1] - starts[segment]
            damaged[start : start + size] = rng.integers(0, 256, size, np.uint8).tobytes()
        (frame,) = decode_stream(bytes(damaged))
        good = np.setdiff1d(header.layout().rows, frame.bad_rows)
        assert np.array_equal(frame.samples[good], samples[good])
        lost.append(frame.bad_rows != rows[first] + rows[first + 2])
    assert sum(lost) <= 1


@pytest.mark.parametrize("name", ["edge", "segments"])
def test_random_bytes_of_three_segments_are_no_segment(name):
    header, samples, data = sent(name)
    starts, rows = starts_of(header, samples)
    rng = np.random.default_rng(3)
    for first in rng.integers(len(rows) - 2, size=60).tolist():
        damaged = bytearray(data)
        start, stop = starts[first], starts[first + 3]
        damaged[start:stop] = rng.integers(0, 256, stop - start, np.uint8).tobytes()
        (frame,) = decode_stream(bytes(damaged))
        assert frame.bad_rows == sum(rows[first : first + 3], [])


def test_header_damaged_worse_is_named():
    header, samples, data = sent("edge")
    for first in range(HEADER_BYTES - 1):
        with pytest.raises(StreamError, match="byte 0: "):
            decode_stream(changed(changed(data, first, 0x21), first + 1, 0x42))


def with_crc(fields):
    return bytes(fields) + zlib.crc32(bytes(fields)).to_bytes(4, "big")


@pytest.mark.parametrize(
    "position, value, message",
    [
        (0, 0x55, "starts with"),
        (4, 1, "version 1"),
        (5, 0x09, "ternary"),
        (5, 0x04, "phase"),
        (6, 128, "threshold"),
        (7, 3, "lanes"),
        (8, 0x56, "tile rows"),
        (8, 0x36, "tile"),
        (9, 0xFF, "rows"),
        (11, 0xFF, "cols"),
        (13, 200, "window row"),
        (14, 99, "window row1"),
        (16, 200, "window col1"),
    ],
)
def test_header_that_says_what_cannot_be(position, value, message):
    fields = bytearray(header_of(12, 30).to_bytes()[:FIELD_BYTES])
    fields[position] = value
    with pytest.raises(StreamError, match=message):
        decode_stream(with_crc(fields) + bytes(1000))


def test_empty_and_mask_of_nothing_are_named():
    with pytest.raises(StreamError, match="empty"):
        decode_stream(b"")
    fields = bytearray(header_of(12, 30).to_bytes()[:FIELD_BYTES])
    fields[17:20] = bytes(3)
    with pytest.raises(StreamError, match="mask"):
        decode_stream(with_crc(fields))


def test_bytes_around_frames_are_told():
    header, samples, data = sent("edge")
    frames = decode_stream(b"noise" + data + b"more noise" + data + b"end")
    assert [frame.complete for frame in frames] == [True, True]
    assert "5 bytes skipped" in frames[0].errors[0] and "10 bytes skipped" in frames[1].errors[0]
    assert "3 bytes are no frame" in frames[1].errors[1]


@pytest.mark.parametrize("name", FRAMES)
def test_a_frame_cut_short_anywhere_costs_the_next_one_nothing(name):
    """As where the chip is reset in a frame: a header that the next one runs into is not corrected with its bytes."""
    _, samples, data = sent(name)
    for length in range(len(data)):
        last = decode_stream(data[:length] + data)[-1]
        assert last.complete and last.start == length and np.array_equal(last.samples, samples), length


@settings(max_examples=200, deadline=None)
@given(headers(), st.integers(0, 2**32 - 1), st.data())
def test_fuzz(header, seed, draw):
    """Any number of bytes changed, cut out or put in: an answer of bounded size, or StreamError."""
    data = bytearray(encode_frame(header, samples_of(header, seed), 1, 1) * 2)
    for _ in range(draw.draw(st.integers(1, 6))):
        at = draw.draw(st.integers(0, len(data) - 1))
        data[at : at + draw.draw(st.integers(0, 8))] = draw.draw(st.binary(max_size=8))
    try:
        frames = decode_stream(bytes(data))
    except StreamError as error:
        assert "\n" not in str(error)
    else:
        assert len(frames) <= 4
        for frame in frames:
            assert frame.samples.shape == (frame.header.rows, frame.header.cols, frame.header.subs)
            assert set(frame.bad_rows) <= set(frame.layout.rows.tolist())
            assert frame.complete or frame.errors


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=300), headers())
def test_fuzz_after_a_good_header(body, header):
    frame = decode_stream(header.to_bytes() + body)[0]
    assert frame.errors and frame.samples.size == header.rows * header.cols * header.subs


@pytest.mark.parametrize("mode", ["edge", "tof"])
def test_work_on_a_hostile_file_is_bounded(mode):
    """The largest frame announced, then random bytes: every search ends at its limit."""
    header = header_of(1024, 1536, mode=mode, threshold=0)
    noise = np.random.default_rng(0).integers(0, 256, 60_000).astype(np.uint8).tobytes()
    (frame,) = decode_stream(header.to_bytes() + noise)
    assert len(frame.bad_rows) == 1024
