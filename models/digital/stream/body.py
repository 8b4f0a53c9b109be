"""The rows and the trailer of one frame, and the correction of one wrong byte in them."""

import numpy as np
import numpy.typing as npt

from talbot.models.digital.stream.frame import DecodedFrame
from talbot.models.digital.stream.payload import decode_rows, one_byte_changes
from talbot.models.digital.stream.trailer import Trailer, frame_crc, read_trailer
from talbot.models.parameters.stream_format import CRC, HEADER_BYTES, TRAILER_BYTES


class Body:
    """Decoder of the bytes after a header into the frame's samples.

    view: bytes of the stream.
    frame: receives samples and errors.
    sent: the header as it was sent.
    start: start of the frame in ``view``; the frame's own by default.
    """

    def __init__(self, view: npt.NDArray[np.uint8], frame: DecodedFrame, sent: bytes, start: int | None = None) -> None:
        header, layout = frame.header, frame.layout
        samples = int(layout.counts.sum())
        self.view, self.frame, self.sent = view, frame, sent
        pixels = np.empty(samples, np.int32), np.empty(samples, np.int16)
        self.coder = *header.coder, header.segment, *pixels
        self.rows = frame.samples.reshape(header.rows, -1)
        self.first = (frame.start if start is None else start) + HEADER_BYTES
        self.total = layout.rows.size
        self.ends = np.zeros(self.total, np.int64)

    def decode(self, ordinal: int, at: int, whole: bool = True) -> tuple[int, int, Trailer | None]:
        """Decode segments, and the trailer after the last, until one does not fit.

        ordinal: number of the first row, with which a segment begins. at: its position. whole: nothing before it is
        damaged: check the frame's CRC-32 too. Returns ordinal (number of the first row of the segment that does not
        fit, or the number of rows), at (position of that segment or of the trailer), trailer (None if a row or the
        trailer does not fit).
        """
        layout, view = self.frame.layout, self.view
        places = layout.rows, layout.counts, layout.kind, layout.places, layout.start
        ordinal, at = decode_rows(view, at, ordinal, *places, *self.coder, self.rows, self.ends)
        if ordinal < self.total:
            return ordinal, at, None
        crc = frame_crc(self.sent, view[self.first : at].data) if whole else None
        return ordinal, at, read_trailer(view[at : at + TRAILER_BYTES].tobytes(), crc)

    def correct(self, stop: int) -> Trailer | None:
        """Decode the whole frame in spite of one wrong byte.

        The CRC-32 yields the candidates for the byte and its change; all marks must then agree. Without success, the
        rows before the first bad one are decoded again.

        stop: end of the frame. Returns None if no change of one byte makes everything fit.
        """
        start, last = self.first - HEADER_BYTES, stop - CRC.size
        if last < self.first:
            return None
        sent_crc = CRC.unpack(self.view[last:stop].tobytes())[0]
        where, change = np.empty(16, np.int64), np.empty(16, np.int64)
        changes = one_byte_changes(
            frame_crc(self.sent, self.view[self.first : last].data) ^ sent_crc, last - self.first, where, change
        )
        for position, bits in zip(where[:changes].tolist(), change[:changes].tolist(), strict=True):
            view = self.view[start:stop].copy()
            view[HEADER_BYTES + position] ^= bits
            corrected = Body(view, self.frame, self.sent, 0)
            self.rows[:] = 0  # a row that only seems to fit may be there
            _, at, trailer = corrected.decode(0, corrected.first)
            if trailer and start + at + TRAILER_BYTES == stop:
                row = int(np.searchsorted(corrected.ends, HEADER_BYTES + position, "right"))
                self._report(self.first + position, row)
                self.ends = corrected.ends
                return trailer
        if changes:
            self.rows[:] = 0
            self.decode(0, self.first)
        return None

    def _report(self, position: int, ordinal: int) -> None:
        place = f"row {self.frame.layout.rows[ordinal]} or one before it" if ordinal < self.total else "the trailer"
        self.frame.errors.append(f"byte {position}: byte of {place} corrected")
