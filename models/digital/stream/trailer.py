"""Row marks and the trailer of a frame (docs/stream.md, Row mark, Trailer)."""

import zlib
from typing import NamedTuple

from talbot.models.digital.stream.crc import crc16
from talbot.models.parameters import check_int
from talbot.models.parameters.stream_format import (
    COUNTED_BYTES,
    COUNTS,
    CRC,
    FIELD_BYTES,
    MARK,
    TRAILER_BYTES,
    TRAILER_ROW,
)


class Trailer(NamedTuple):
    """Contents of a trailer.

    made, left_out: conversions, 0..2**32-1.
    notes: what is wrong, one line each.
    """

    made: int
    left_out: int
    notes: list[str]


def row_mark(payload: bytes, row: int) -> bytes:
    """Mark of a segment.

    payload: payload of the segment. row: index of its first row, 0..65535. Returns CRC-16 of the payload xor the row
    index: two bytes.
    """
    return MARK.pack(crc16(payload) ^ row)


def frame_crc(sent: bytes, body: bytes | memoryview) -> int:
    """CRC-32 of a frame, without the header's own CRC.

    sent: the header. body: bytes after the header. Returns 0..2**32-1.
    """
    return zlib.crc32(body, zlib.crc32(sent[:FIELD_BYTES]))


def trailer(sent: bytes, rows: bytes, made: int, left_out: int) -> bytes:
    """Encode a trailer.

    sent: the header. rows: all bytes between the header and the trailer. made, left_out: conversions, 0..2**32-1.
    Returns TRAILER_BYTES bytes. Raises ParameterError for a count out of range.
    """
    check_int("conversions made", made, 0, 2**32 - 1)
    check_int("conversions left out", left_out, 0, 2**32 - 1)
    counts = COUNTS.pack(made, left_out)
    counted = counts + row_mark(counts, TRAILER_ROW)
    return counted + CRC.pack(zlib.crc32(counted, frame_crc(sent, rows)))


def read_trailer(tail: bytes, crc: int | None) -> Trailer | None:
    """Decode a trailer.

    tail: its bytes, possibly cut short. crc: CRC-32 of the frame before it, None if that is damaged. Returns None when
    the counts do not fit their mark.
    """
    if len(tail) < COUNTED_BYTES or row_mark(tail[: COUNTS.size], TRAILER_ROW) != tail[COUNTS.size : COUNTED_BYTES]:
        return None
    notes = []
    if len(tail) < TRAILER_BYTES:
        notes = [f"the trailer ends after {len(tail)} of {TRAILER_BYTES} bytes"]
    elif crc is not None and zlib.crc32(tail[:COUNTED_BYTES], crc) != CRC.unpack_from(tail, COUNTED_BYTES)[0]:
        notes = ["the frame's CRC-32 does not fit, though every row's mark does"]
    made, left_out = COUNTS.unpack_from(tail)
    return Trailer(made, left_out, notes)
