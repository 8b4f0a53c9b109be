"""The decoder: from any bytes to frames."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.digital.stream.body import Body
from talbot.models.digital.stream.frame import DecodedFrame
from talbot.models.digital.stream.header import Layout, StreamError, StreamHeader, read_header
from talbot.models.digital.stream.payload import frame_ends
from talbot.models.digital.stream.resync import Search
from talbot.models.digital.stream.trailer import Trailer
from talbot.models.parameters import ParameterError, TileParameters
from talbot.models.parameters.stream_format import COUNTED_BYTES, HEADER_BYTES, MAGIC, TRAILER_BYTES

MEMORY_MAX = 1 << 30  # bytes of samples that decode_stream returns at most
SEARCH_MAX = 1 << 28, 64  # tokens decoded on trial to find segments again, at most: a constant, and for each byte


def decode_stream(data: bytes, tile: TileParameters = TileParameters()) -> list[DecodedFrame]:
    """Decode every frame of a stream.

    Damage is reported in each frame's ``bad_rows`` and ``errors``.

    data: the stream. tile: the sensor's tile. Returns list of DecodedFrame: at least one. Raises StreamError when no
    frame starts anywhere, or the frames together need more than MEMORY_MAX bytes (then use `iterate_frames`).
    """
    frames, size = [], 0
    for frame in iterate_frames(data, tile):
        size += frame.samples.nbytes
        if size > MEMORY_MAX:
            raise StreamError(f"byte {frame.start}: the frames so far need {size} bytes, more than {MEMORY_MAX}")
        frames.append(frame)
    return frames


def iterate_frames(data: bytes, tile: TileParameters = TileParameters()) -> Iterator[DecodedFrame]:
    """Decode the frames of a stream one by one.

    data: the stream. tile: the sensor's tile. Yields DecodedFrame: as in `decode_stream`. Raises StreamError when no
    frame starts anywhere.
    """
    data = bytes(data)
    # A copy that may be written, as those in which a byte is corrected: for another type Numba would compile all again
    view = np.frombuffer(bytearray(data), np.uint8)
    at, last, limit = 0, None, SEARCH_MAX[0] + SEARCH_MAX[1] * len(data)
    while at < len(data):
        start = _find_header(data, at, tile)
        if isinstance(start, str):
            if last is None:
                raise StreamError(f"byte {at}: {start}")
            last.errors.append(f"byte {at}: {len(data) - at} bytes are no frame: {start}")
            break
        if last is not None:
            yield last
        header = start.header
        samples = np.zeros((header.rows, header.cols, header.subs), np.int16)
        last = DecodedFrame(header, samples, start.layout, start.position, errors=start.notes)
        limit = _decode_frame(data, view, last, start.sent, tile, limit)
        at = last.stop
    if last is None:
        raise StreamError("0 bytes: the stream is empty")
    yield last


class _Start(NamedTuple):
    """The start of a frame: where, the header and the header as sent, and the error there."""

    position: int
    header: StreamHeader
    layout: Layout
    sent: bytes
    notes: list[str]


def _find_header(data: bytes, at: int, tile: TileParameters) -> _Start | str:
    """Return the first header at or after ``at``, or the reason why the bytes at ``at`` are none."""
    reason, position = "", at
    while position >= 0:
        try:
            header, sent, wrong = read_header(data[position : position + HEADER_BYTES])
            layout = header.layout(tile)
        except ParameterError as error:
            reason = reason or str(error)
        else:
            # A corrected header counts only where one must be, and not if it is a cut one and the start of the next.
            if wrong is None or position == at and _good_header(data, at + 1, at + HEADER_BYTES) < 0:
                notes = [f"byte {position + wrong}: byte of the header corrected"] if wrong is not None else []
                if position > at:
                    notes.append(f"byte {at}: {position - at} bytes skipped: {reason}")
                return _Start(position, header, layout, sent, notes)
        position = data.find(MAGIC, position + 1)
    return reason


def _good_header(data: bytes, start: int, stop: int) -> int:
    """Position of the first undamaged header in data[start:stop], or -1."""
    position = data.find(MAGIC, start, stop + len(MAGIC) - 1)
    while position >= 0:
        try:
            if read_header(data[position : position + HEADER_BYTES]).corrected is None:
                break
        except StreamError:
            pass
        position = data.find(MAGIC, position + 1, stop + len(MAGIC) - 1)
    return position


def _decode_frame(
    data: bytes, view: npt.NDArray[np.uint8], frame: DecodedFrame, sent: bytes, tile: TileParameters, limit: int
) -> int:
    """Fill in a frame from its ``start`` on; returns the rest of the tokens that may be decoded on trial.

    view: the bytes ``data``.
    """
    body, stop = Body(view, frame, sent), len(data)
    ordinal, at, tail = body.decode(0, body.first)
    if tail is None:
        following = _find_header(data, at, tile)
        if not isinstance(following, str):
            stop = following.position
        corrected = body.correct(stop)
        if corrected:
            ordinal, at, tail = body.total, stop - TRAILER_BYTES, corrected
        else:
            ordinal, at, tail, limit = _decode_around(body, frame, ordinal, at, stop, limit)
    frame.segments = np.unique(body.ends[body.ends > 0]).size
    trailer_end = min(at + TRAILER_BYTES, len(data))
    if tail:
        frame.made, frame.left_out, notes = tail
        cut = _good_header(data, at + COUNTED_BYTES, trailer_end) if notes else -1
        if cut >= 0:  # these are no bytes of the trailer
            trailer_end, notes = cut, [f"the trailer ends after {cut - at} of {TRAILER_BYTES} bytes"]
        frame.truncated = trailer_end - at < TRAILER_BYTES
        frame.errors += [f"byte {at}: {note}" for note in notes]
    else:
        frame.errors.append(f"byte {at}: the trailer is damaged or missing")
    ends = tail or ordinal == body.total and frame_ends(body.view, at + TRAILER_BYTES, len(data))
    frame.stop = trailer_end if ends else stop
    return limit


def _decode_around(
    body: Body, frame: DecodedFrame, ordinal: int, at: int, stop: int, limit: int
) -> tuple[int, int, Trailer | None, int]:
    """Go on after each damaged segment: returns (ordinal, position, trailer or None, limit) where no more is found."""
    search, bad, tail = Search(body.view, stop, limit, frame.layout, *body.coder), [], None
    while tail is None:
        segment = search.next_segment(ordinal, at)
        if not segment:
            bad += range(ordinal, body.total)
            break
        lone = search.lone_segment(ordinal, at, segment[1], segment[0])
        if lone:
            bad += range(ordinal, lone[1])
            ordinal, _, _ = body.decode(lone[1], lone[0], False)
        bad += range(ordinal, segment[1])
        ordinal, at, tail = body.decode(segment[1], segment[0], not bad)
    frame.bad_rows = frame.layout.rows[bad].tolist()
    if bad:
        frame.errors.append(f"byte {frame.start}: {len(bad)} of {body.total} rows are bad")
    return ordinal, at, tail, search.limit
