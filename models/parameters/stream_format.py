"""Fields and sizes of the byte stream (docs/stream.md): the golden encoder, the decoder and the RTL share them."""

import struct

MAGIC = b"TLBT"
VERSION = 3

HEADER_FIELDS = struct.Struct(">4sBBBBBHHBBBB3sHHBHB")
CRC = struct.Struct(">I")
FIELD_BYTES = HEADER_FIELDS.size
HEADER_BYTES = FIELD_BYTES + CRC.size

SEGMENT_BYTES = 64  # bytes of payload that a step of `resync` lets a segment have before its last row ends

MARK = struct.Struct(">H")
COUNTS = struct.Struct(">II")
COUNT_BYTES = COUNTS.size
COUNTED_BYTES = COUNT_BYTES + MARK.size
TRAILER_BYTES = COUNTED_BYTES + CRC.size
TRAILER_ROW = 0xFFFF  # replaces the row index in the trailer's mark
