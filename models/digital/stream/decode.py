"""The decoder: bytes to frames, whatever the bytes are."""

import numpy as np

from models.parameters import ParameterError, TileParameters
from models.parameters.stream_format import COUNTED_BYTES, HEADER_BYTES, MAGIC, TRAILER_BYTES

from .body import Body
from .frame import DecodedFrame
from .header import StreamError, read_header
from .payload import frame_ends
from .resync import Search

MEMORY_MAX = 1 << 30  # bytes of samples that decode_stream returns at most
SEARCH_MAX = 1 << 28, 64  # samples decoded on trial to find rows again: at most so many, and more for each byte


def decode_stream(data, tile=TileParameters()):
    """Every frame in ``data`` (bytes-like): list of DecodedFrame, at least one.

    Damage is told in each frame's ``bad_rows`` and ``errors``. Raises StreamError when no frame starts anywhere,
    or the frames together need more than MEMORY_MAX bytes (then use `iterate_frames`).
    """
    frames, size = [], 0
    for frame in iterate_frames(data, tile):
        size += frame.samples.nbytes
        if size > MEMORY_MAX:
            raise StreamError(f"byte {frame.start}: the frames so far need {size} bytes, more than {MEMORY_MAX}")
        frames.append(frame)
    return frames


def iterate_frames(data, tile=TileParameters()):
    """Generate the frames of ``data`` one by one, as `decode_stream`."""
    data = bytes(data)
    at, last, limit = 0, None, SEARCH_MAX[0] + SEARCH_MAX[1] * len(data)
    while at < len(data):
        start, header, layout, sent, notes = _find_header(data, at, tile)
        if header is None:
            if last is None:
                raise StreamError(f"byte {at}: {notes[0]}")
            last.errors.append(f"byte {at}: {len(data) - at} bytes are no frame: {notes[0]}")
            break
        if last is not None:
            yield last
        samples = np.zeros((header.rows, header.cols, header.subs), np.int16)
        last = DecodedFrame(header, samples, layout, start, errors=notes)
        limit = _decode_frame(data, last, sent, tile, limit)
        at = last.stop
    if last is None:
        raise StreamError("0 bytes: the stream is empty")
    yield last


def _find_header(data, at, tile):
    """The first header at or behind ``at``: (position, StreamHeader or None, Layout, header as sent, notes)."""
    reason, position = None, at
    while position >= 0:
        try:
            header, sent, mended = read_header(data[position : position + HEADER_BYTES])
            layout = header.layout(tile)
        except ParameterError as error:
            reason = reason or str(error)
        else:
            # with a byte changed, only where a header must be, and not what a cut one and the next make together
            if mended is None or position == at and _good_header(data, at + 1, at + HEADER_BYTES) < 0:
                notes = [f"byte {position + mended}: byte of the header mended"] if mended is not None else []
                if position > at:
                    notes.append(f"byte {at}: {position - at} bytes skipped: {reason}")
                return position, header, layout, sent, notes
        position = data.find(MAGIC, position + 1)
    return at, None, None, b"", [reason]


def _good_header(data, start, stop):
    """Where the first undamaged header starts in data[start:stop], or -1."""
    position = data.find(MAGIC, start, stop + len(MAGIC) - 1)
    while position >= 0:
        try:
            if read_header(data[position : position + HEADER_BYTES])[2] is None:
                break
        except StreamError:
            pass
        position = data.find(MAGIC, position + 1, stop + len(MAGIC) - 1)
    return position


def _decode_frame(data, frame, sent, tile, limit):
    """Fill in a frame from its ``start`` on; returns what is left of the samples to decode on trial."""
    body = Body(np.frombuffer(data, np.uint8), frame, sent)
    ordinal, at, tail = body.decode(0, body.first)
    if tail is None:
        following, header, *_ = _find_header(data, at, tile)
        stop = following if header else len(data)
        mended = body.mend(stop)
        if mended:
            ordinal, at, tail = body.total, stop - TRAILER_BYTES, mended
        else:
            ordinal, at, tail, limit = _decode_around(body, frame, ordinal, at, stop, limit)
    trailer_end = min(at + TRAILER_BYTES, len(data))
    if tail:
        frame.made, frame.left_out, notes = tail
        following = _good_header(data, at + COUNTED_BYTES, trailer_end) if notes else -1
        if following >= 0:  # these are no bytes of the trailer
            trailer_end, notes = following, [f"the trailer ends after {following - at} of {TRAILER_BYTES} bytes"]
        frame.errors += [f"byte {at}: {note}" for note in notes]
    else:
        frame.errors.append(f"byte {at}: the trailer is damaged or missing")
    ends = tail or ordinal == body.total and frame_ends(body.view, at + TRAILER_BYTES, len(data))
    frame.stop = trailer_end if ends else stop
    return limit


def _decode_around(body, frame, ordinal, at, stop, limit):
    """Go on behind each damaged row: returns (ordinal, position, trailer or None, limit) where no more is found."""
    search, bad, tail = Search(body.view, stop, limit, frame.layout, *body.coder), [], None
    while tail is None:
        found = search.next_row(ordinal, at)
        bad += range(ordinal, found[1] if found else body.total)
        if not found:
            break
        ordinal, at, tail = body.decode(found[1], found[0], not bad)
    frame.bad_rows = frame.layout.rows[bad].tolist()
    if bad:
        frame.errors.append(f"byte {frame.start}: {len(bad)} of {body.total} rows are bad: {_spans(frame.bad_rows)}")
    return ordinal, at, tail, search.limit


def _spans(rows):
    """Ascending integers as text: '3, 5..9'."""
    starts = [i for i in range(len(rows)) if i == 0 or rows[i] != rows[i - 1] + 1]
    pairs = [(rows[i], rows[j - 1]) for i, j in zip(starts, starts[1:] + [len(rows)], strict=True)]
    return ", ".join(f"{a}..{b}" if b > a else f"{a}" for a, b in pairs[:8]) + (", ..." if len(pairs) > 8 else "")
