import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.digital.stream import StreamError, StreamHeader, decode, decode_stream, encode_frame, iterate_frames
from talbot.models.digital.stream.header import read_header
from talbot.models.digital.stream.test.frames import header_of, headers, samples_of
from talbot.models.parameters import FrameParameters, ParameterError, PixelType, TileParameters, Window
from talbot.models.parameters.stream_format import HEADER_BYTES, TRAILER_BYTES


@settings(max_examples=150, deadline=None)
@given(headers(), st.integers(0, 2**32 - 1), st.floats(0, 1), st.integers(0, 2**32 - 1))
def test_any_frame_comes_back(header, seed, share, made):
    samples = samples_of(header, seed, share)
    data = encode_frame(header, samples, made, 7)
    (frame,) = decode_stream(data)
    assert frame.header == header
    assert frame.samples.dtype == np.int16 and np.array_equal(frame.samples, samples)
    assert frame.complete and not frame.errors
    assert (frame.made, frame.left_out, frame.start, frame.stop) == (made, 7, 0, len(data))
    assert np.array_equal(frame.read, read_mask(header))


def read_mask(header):
    """Which pixels a header says are read, worked out from the pixel types."""
    w, step = header.window, 1 << header.decimation
    r, c = np.arange(header.rows) // 4, np.arange(header.cols) // 6
    rows = (r >= w.row0) & (r <= w.row1) & ((r - w.row0) % step == 0)
    cols = (c >= w.col0) & (c <= w.col1) & ((c - w.col0) % step == 0)
    return rows[:, None] & cols & (header.mask >> TileParameters().type_map(header.rows, header.cols) & 1 == 1)


@settings(max_examples=100, deadline=None)
@given(headers())
def test_header_comes_back(header):
    sent = header.to_bytes()
    assert len(sent) == HEADER_BYTES and read_header(sent) == (header, sent, None)


def test_frames_follow_each_other():
    headers = [header_of(8, 12, frame_number=n, mode=mode) for n, mode in enumerate(("edge", "raw", "image"))]
    data = b"".join(encode_frame(h, samples_of(h, 1), 1, 2) for h in headers)
    frames = decode_stream(data)
    assert [f.header for f in frames] == headers
    assert [f.start for f in frames[1:]] == [f.stop for f in frames[:-1]] and frames[-1].stop == len(data)
    assert [f.header for f in iterate_frames(memoryview(data))] == headers


def test_codes_under_the_threshold_are_zeros():
    header = header_of(4, 6, threshold=5)
    samples = np.arange(24).reshape(4, 6, 1) - 12
    (frame,) = decode_stream(encode_frame(header, samples, 0, 0))
    assert np.array_equal(frame.samples, np.where(abs(samples) < 5, 0, samples))


@pytest.mark.parametrize("resync, size", [(0, 384 * 3), (1, 10 + 2), (3, 10 + 2)])
def test_a_frame_of_zeros(resync, size):
    """A byte and a mark each row, or ten bytes and one mark."""
    data = encode_frame(header_of(384, 384, resync=resync), np.zeros((384, 384, 1), int), 0, 0)
    assert len(data) == HEADER_BYTES + size + TRAILER_BYTES


@pytest.mark.parametrize(
    "samples, message",
    [
        (np.zeros((8, 12), int), "shape"),
        (np.zeros((8, 12, 1)), "integers"),
        (np.full((8, 12, 1), 128), "128: must be in -128..127"),
        (np.full((8, 12, 1), -129), "-129..-129"),
    ],
)
def test_samples_out_of_range_are_named(samples, message):
    with pytest.raises(ParameterError, match=message):
        encode_frame(header_of(8, 12), samples, 0, 0)


@pytest.mark.parametrize("made, left_out", [(-1, 0), (2**32, 0), (0, 2**32)])
def test_counts_out_of_range_are_named(made, left_out):
    with pytest.raises(ParameterError, match="conversions"):
        encode_frame(header_of(4, 6), np.zeros((4, 6, 1), int), made, left_out)


def test_other_tiles():
    tile = TileParameters(2, 3, tuple(PixelType(12, 0, 0) for _ in range(6)), (5, 1, 3, 0, 2, 4))
    header = StreamHeader.from_frame(5, 8, 2, FrameParameters(Window(0, 2, 0, 2), mask=0b101011), tile)
    samples = np.where(0b101011 >> tile.type_map(5, 8) & 1, 30, 0)[..., None]
    data = encode_frame(header, samples, 0, 0, tile)
    assert np.array_equal(decode_stream(data, tile)[0].samples, samples)
    with pytest.raises(StreamError, match="tile = 4 x 6: must be 2 x 3"):
        decode_stream(data)


def test_memory_is_bounded(monkeypatch):
    header = header_of(1024, 1536, window=Window(0, 0, 0, 0))
    data = encode_frame(header, np.zeros((1024, 1536, 1), int), 0, 0) * 5
    monkeypatch.setattr(decode, "MEMORY_MAX", 4 * 1024 * 1536 * 2)
    with pytest.raises(StreamError, match="more than"):
        decode_stream(data)
    assert sum(1 for _ in iterate_frames(data)) == 5
