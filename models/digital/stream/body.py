"""The rows and the trailer of one frame, and mending its one wrong byte."""

import numpy as np

from models.parameters.stream_format import CRC, HEADER_BYTES, TRAILER_BYTES

from .payload import base_of, decode_rows, one_byte_changes
from .trailer import frame_crc, read_trailer


class Body:
    """Decodes what lies behind a header into the frame's samples."""

    def __init__(self, view, frame, sent, start=None):
        """view: uint8, where the frame starts at ``start`` (the frame's own, if not given). sent: the header."""
        header, layout = frame.header, frame.layout
        longest = int(layout.counts.max())
        self.view, self.frame, self.sent = view, frame, sent
        self.coder = header.edge, base_of(header.threshold), np.empty(longest, np.int32), np.empty(longest, np.int16)
        self.rows = frame.samples.reshape(header.rows, -1)
        self.first = (frame.start if start is None else start) + HEADER_BYTES
        self.total = layout.rows.size
        self.ends = np.zeros(self.total, np.int64)

    def decode(self, ordinal, at, whole=True):
        """Decode from row number ``ordinal`` at ``at`` on, up to what does not fit.

        whole: nothing before is damaged. Returns (number of the row that does not fit or of rows, its position,
        (made, left_out, notes) of the trailer or None).
        """
        layout, view = self.frame.layout, self.view
        ordinal, at = decode_rows(
            view, at, ordinal, layout.rows, layout.kind, layout.places, layout.start, *self.coder, self.rows, self.ends
        )
        if ordinal < self.total:
            return ordinal, at, None
        crc = frame_crc(self.sent, view[self.first : at]) if whole else None
        return ordinal, at, read_trailer(view[at : at + TRAILER_BYTES].tobytes(), crc)

    def mend(self, stop):
        """Decode the frame, up to ``stop``, in spite of one wrong byte: the trailer as `decode` gives it, or None.

        The CRC-32 tells which byte and how to change it; all marks must then agree. Without success, the rows
        before the first bad one are decoded again.
        """
        start, last = self.first - HEADER_BYTES, stop - CRC.size
        if last < self.first:
            return None
        sent_crc = CRC.unpack(self.view[last:stop].tobytes())[0]
        where, change = np.empty(16, np.int64), np.empty(16, np.int64)
        found = one_byte_changes(
            frame_crc(self.sent, self.view[self.first : last]) ^ sent_crc, last - self.first, where, change
        )
        for position, bits in zip(where[:found].tolist(), change[:found].tolist(), strict=True):
            view = self.view[start:stop].copy()
            view[HEADER_BYTES + position] ^= bits
            mended = Body(view, self.frame, self.sent, 0)
            self.rows[:] = 0  # a row that only seemed to fit may lie there
            _, at, tail = mended.decode(0, mended.first)
            if tail and start + at + TRAILER_BYTES == stop:
                self._tell(self.first + position, int(np.searchsorted(mended.ends, HEADER_BYTES + position, "right")))
                return tail
        if found:
            self.rows[:] = 0
            self.decode(0, self.first)
        return None

    def _tell(self, position, ordinal):
        place = f"row {self.frame.layout.rows[ordinal]}" if ordinal < self.total else "the trailer"
        self.frame.errors.append(f"byte {position}: byte of {place} mended")
