"""Row marks and the trailer of a frame (docs/stream.md, Row mark, Trailer)."""

import struct
import zlib

from models.parameters import check_int

from .crc import crc16
from .header import CRC, FIELD_BYTES, correct

TRAILER_ROW = 0xFFFF    # stands for the row index in the trailer's mark
MARK = struct.Struct(">H")
COUNTS = struct.Struct(">II")
COUNTED_BYTES = COUNTS.size + MARK.size
TRAILER_BYTES = COUNTED_BYTES + CRC.size


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
    """Read a trailer, one byte of which may be wrong.

    tail: its bytes, perhaps fewer. crc: CRC-32 of the frame before it, or None when that is known to be damaged.
    Returns (made, left_out, what was wrong), or None when the counts cannot be trusted.
    """
    if len(tail) < COUNTED_BYTES:
        return None
    whole = len(tail) == TRAILER_BYTES
    mended = correct(tail, COUNTED_BYTES, crc) if whole and crc is not None else None
    if not _counts_fit(tail):
        if mended is None or not _counts_fit(mended[0]):
            return None
        return *COUNTS.unpack_from(mended[0]), [f"byte {mended[1]} of the trailer mended"]
    notes = []
    if not whole:
        notes = [f"the trailer ends after {len(tail)} of {TRAILER_BYTES} bytes"]
    elif mended is None and crc is not None or mended and mended[1] is not None:
        notes = ["the frame's CRC-32 does not fit, though every row's mark does"]
    return *COUNTS.unpack_from(tail), notes


def _counts_fit(tail):
    return row_mark(tail[:COUNTS.size], TRAILER_ROW) == bytes(tail[COUNTS.size:COUNTED_BYTES])
