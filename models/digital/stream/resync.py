"""Search for the next good segment after a damaged one.

A segment carries no length, so a damaged one hides the start of the next. But at every position a segment can be
decoded on trial, and its mark, xor the payload's CRC-16, is its first row if it is one and a random number if not. A
trial is accepted when that row is plausible and the segment (or trailer) after it fits as well. A good segment between
two bad ones is accepted without a neighbour when few places and rows are possible and one fits alone.
"""

import numpy as np
import numpy.typing as npt

from talbot.models.digital.stream.header import Layout
from talbot.models.digital.stream.payload import check_segment, find_segment, row_bytes_max, segment_fits
from talbot.models.parameters import ROWS_MAX
from talbot.models.parameters.stream_format import COUNTED_BYTES, MARK

LONE_MAX = 2048  # positions times rows that are tried for a lone segment; a mark fits by chance in 1 of 65,536


class Search:
    """The searches of one frame.

    data: bytes of the stream.
    stop: start of the next frame, or the end.
    limit: tokens that may be decoded on trial; the attribute counts down.
    layout: rows of the frame.
    edge: run-length coded signed codes; else plain bytes.
    base: smallest magnitude of a coded value.
    segment: bytes of payload after which a row is a segment's last.
    where, value: scratch arrays of a frame's length.
    """

    def __init__(
        self,
        data: npt.NDArray[np.uint8],
        stop: int,
        limit: int,
        layout: Layout,
        edge: bool,
        base: int,
        segment: int,
        where: npt.NDArray[np.int32],
        value: npt.NDArray[np.int16],
    ) -> None:
        self.data, self.stop, self.limit, self.layout = data, stop, limit, layout
        self.coder = edge, base, segment, where, value
        self.number = np.full(ROWS_MAX, -1, np.int32)
        self.number[layout.rows] = np.arange(layout.rows.size)
        self.longest = segment + row_bytes_max(int(layout.counts.max()), edge) + 2

    def next_segment(self, lost: int, at: int) -> tuple[int, int] | None:
        """Find the next segment when one does not fit.

        lost: number of the first row of the segment that does not fit. at: its position. Returns position of the next
        good segment and number of its first row (number of rows: the trailer).
        """
        total = self.layout.rows.size
        after = self._after(lost, at) if lost < total else None
        if after and not self.coder[0]:
            return after  # a row of plain bytes has its length
        segment = self._find(after[0], after[0] + 1, after[1], after[1]) if after else None
        if segment:
            return segment
        following, near = min(lost + 1, total), min(self.stop, at + self.longest + COUNTED_BYTES)
        return self._find(at, near, following, total) or after or self._find(at, self.stop, following, total)

    def lone_segment(self, lost: int, at: int, following: int, until: int) -> tuple[int, int] | None:
        """Find a good segment between two bad ones.

        lost: number of the first row of the segment that does not fit. at: its position. following: number of the first
        row of the next segment of `next_segment`. until: its position. Returns position and number of the first row,
        where exactly one position and row fit and at most `LONE_MAX` are possible.
        """
        least = max(self.coder[2], 1) + MARK.size
        last = 1 + MARK.size if following == self.layout.rows.size else least  # bytes of a bad segment after it
        positions, ordinals = range(at + least, until - least - last + 1), range(lost + 1, following - 1)
        if len(positions) * len(ordinals) > LONE_MAX:
            return None
        fitting = []
        for position in positions:
            for ordinal in ordinals:
                end, row, many, _, work = check_segment(
                    self.data, position, until - last, ordinal, self.layout.counts, *self.coder
                )
                self.limit -= work
                if end >= 0 and row == self.layout.rows[ordinal] and ordinal + many < following:
                    fitting.append((position, ordinal))
        return fitting[0] if len(fitting) == 1 else None

    def _after(self, lost: int, at: int) -> tuple[int, int] | None:
        """Position and row after the seeming end of the lost segment, if the next one (or the trailer) fits there."""
        rows, counts = self.layout.rows, self.layout.counts
        end, _, many, _, _ = check_segment(self.data, at, self.stop, lost, counts, *self.coder)
        fits = end >= 0 and segment_fits(self.data, end, self.stop, lost + many, rows, counts, *self.coder)
        return (end, lost + many) if fits else None

    def _find(self, start: int, stop: int, first: int, last: int) -> tuple[int, int] | None:
        position, ordinal, self.limit = find_segment(
            self.data,
            start,
            stop,
            self.limit,
            first,
            last,
            self.layout.rows,
            self.layout.counts,
            self.number,
            *self.coder,
        )
        return (position, ordinal) if position >= 0 else None
