"""Row marks and the trailer of a frame (docs/stream.md, Row mark, Trailer)."""

import zlib

from models.parameters import check_int
from models.parameters.stream_format import COUNTED_BYTES, COUNTS, CRC, FIELD_BYTES, MARK, TRAILER_BYTES, TRAILER_ROW

from .crc import crc16


def row_mark(payload, row):
    """The two bytes behind a row's payload: its CRC-16 xor the row index."""
    return MARK.pack(crc16(payload) ^ row)


def frame_crc(sent, body):
    """CRC-32 of a frame: of its header without the header's CRC (``sent``: the header), then of ``body``."""
    return zlib.crc32(body, zlib.crc32(sent[:FIELD_BYTES]))


def trailer(sent, rows, made, left_out):
    """The trailer's TRAILER_BYTES bytes. sent: the header's bytes. rows: all bytes between it and the trailer.

    made, left_out: conversions, 0..2**32-1.
    """
    check_int("conversions made", made, 0, 2**32 - 1)
    check_int("conversions left out", left_out, 0, 2**32 - 1)
    counts = COUNTS.pack(made, left_out)
    counted = counts + row_mark(counts, TRAILER_ROW)
    return counted + CRC.pack(zlib.crc32(counted, frame_crc(sent, rows)))


def read_trailer(tail, crc):
    """Read a trailer. tail: its bytes, perhaps fewer. crc: CRC-32 of the frame before it, None if that is damaged.

    Returns (made, left_out, what was wrong), or None when the counts do not fit their mark.
    """
    if len(tail) < COUNTED_BYTES or row_mark(tail[: COUNTS.size], TRAILER_ROW) != tail[COUNTS.size : COUNTED_BYTES]:
        return None
    notes = []
    if len(tail) < TRAILER_BYTES:
        notes = [f"the trailer ends after {len(tail)} of {TRAILER_BYTES} bytes"]
    elif crc is not None and zlib.crc32(tail[:COUNTED_BYTES], crc) != CRC.unpack_from(tail, COUNTED_BYTES)[0]:
        notes = ["the frame's CRC-32 does not fit, though every row's mark does"]
    return *COUNTS.unpack_from(tail), notes
