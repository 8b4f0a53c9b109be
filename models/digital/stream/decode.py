"""The decoder: bytes to frames, whatever the bytes are."""

import numpy as np

from models.parameters import ROWS_MAX, ParameterError, TileParameters

from .frame import DecodedFrame
from .header import HEADER_BYTES, MAGIC, StreamError, read_header
from .payload import base_of, decode_rows, frame_ends
from .resync import Search
from .trailer import TRAILER_BYTES, frame_crc, read_trailer

MEMORY_MAX = 1 << 30        # bytes of samples that decode_stream returns at most
SEARCH_MAX = 1 << 28, 64    # samples decoded on trial to find rows again: at most so many, and more for each byte


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
        start, header, sent, notes = _find_header(data, at, tile)
        if header is None:
            if last is None:
                raise StreamError(f"byte {at}: {notes[0]}")
            last.errors.append(f"byte {at}: {len(data) - at} bytes are no frame: {notes[0]}")
            break
        if last is not None:
            yield last
        last, limit = _decode_frame(data, start, header, sent, notes, tile, limit)
        at = last.stop
    if last is None:
        raise StreamError("0 bytes: the stream is empty")
    yield last


def _find_header(data, at, tile):
    """The first header at or behind ``at``: (position, StreamHeader or None, header as sent, notes)."""
    reason, position = None, at
    while position >= 0:
        try:
            header, sent, mended = read_header(data[position:position + HEADER_BYTES])
            header.layout(tile)
        except (StreamError, ParameterError) as error:
            reason = reason or str(error)
        else:
            if mended is None or position == at:    # with a byte changed, only where a header must be
                notes = [f"byte {position + mended}: header byte mended"] if mended is not None else []
                if position > at:
                    notes.append(f"byte {at}: {position - at} bytes skipped: {reason}")
                return position, header, sent, notes
        position = data.find(MAGIC, position + 1)
    return at, None, b"", [reason]


def _decode_frame(data, start, header, sent, notes, tile, limit):
    layout, view = header.layout(tile), np.frombuffer(data, np.uint8)
    frame = DecodedFrame(header, np.zeros((header.rows, header.cols, header.subs), np.int16), layout, start,
                         errors=notes)
    longest, total = int(layout.counts.max()), layout.rows.size
    coder = header.edge, base_of(header.threshold), np.empty(longest, np.int32), np.empty(longest, np.int16)
    flat = frame.samples.reshape(header.rows, -1)
    bad, ordinal, at, search, tail = set(), 0, start + HEADER_BYTES, None, None
    while True:
        ordinal, at, before = decode_rows(view, at, ordinal, layout.rows, layout.kind, layout.places, layout.start,
                                           *coder, flat)
        if ordinal == total:
            crc = None if bad else frame_crc(sent, memoryview(data)[start + HEADER_BYTES:at])
            tail = read_trailer(data[at:at + TRAILER_BYTES], crc)
            if tail:
                break
        if search is None:
            following, known, *_ = _find_header(data, at, tile)
            search = Search(view, following if known else view.size, limit, layout, *coder)
        found = search.next_row(ordinal, before, at)
        if not found:
            bad.update(range(ordinal, total))
            break
        if found[1] == ordinal:     # the row before has the wrong length: its mark fitted by chance
            ordinal -= 1
            flat[layout.rows[ordinal]] = 0
        bad.update(range(ordinal, found[1]))
        at, ordinal = found
    frame.bad_rows = layout.rows[sorted(bad)].tolist()
    if bad:
        frame.errors.append(f"byte {start}: {len(bad)} of {total} rows are bad: {_spans(frame.bad_rows)}")
    if tail:
        frame.made, frame.left_out, wrong = tail
        frame.errors += [f"byte {at}: {line}" for line in wrong]
    else:
        frame.errors.append(f"byte {start}: the frame's trailer is damaged or missing")
    ends = tail or ordinal == total and frame_ends(view, at + TRAILER_BYTES, view.size)
    frame.stop = min(at + TRAILER_BYTES, view.size) if ends else search.stop
    return frame, search.limit if search else limit


def _spans(rows):
    """Ascending integers as text: '3, 5..9'."""
    starts = [i for i in range(len(rows)) if i == 0 or rows[i] != rows[i - 1] + 1]
    pairs = [(rows[i], rows[j - 1]) for i, j in zip(starts, starts[1:] + [len(rows)], strict=True)]
    return ", ".join(f"{a}..{b}" if b > a else f"{a}" for a, b in pairs[:8]) + (", ..." if len(pairs) > 8 else "")
