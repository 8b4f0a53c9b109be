"""Search for the next good row after a damaged one.

A row carries no length, so a damaged one hides the start of the next. But at every position a row can be decoded on
trial, and its mark, xor the payload's CRC-16, is the row's index if it is a row and a random number if not. A trial
is accepted when its index is plausible and the row (or trailer) after it fits as well.
"""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ROWS_MAX
from talbot.models.parameters.stream_format import COUNTED_BYTES

from .header import Layout
from .payload import check_row, find_row, row_bytes_max, row_fits


class Search:
    """The searches of one frame.

    Parameters
    ----------
    data : uint8
        Bytes of the stream.
    stop : int
        Start of the next frame, or the end.
    limit : int
        Samples that may be decoded on trial; the attribute counts down.
    layout : Layout
        Rows of the frame.
    edge : bool
        Run-length coded signed codes; else plain bytes.
    base : int
        Smallest magnitude of a coded value.
    where, value : int32, int16
        Scratch arrays of a row's length.
    """

    def __init__(
        self,
        data: npt.NDArray[np.uint8],
        stop: int,
        limit: int,
        layout: Layout,
        edge: bool,
        base: int,
        where: npt.NDArray[np.int32],
        value: npt.NDArray[np.int16],
    ) -> None:
        self.data, self.stop, self.limit, self.layout = data, stop, limit, layout
        self.coder = edge, base, where, value
        self.number = np.full(ROWS_MAX, -1, np.int32)
        self.number[layout.rows] = np.arange(layout.rows.size)
        self.longest = row_bytes_max(int(layout.counts.max()), edge) + 2

    def next_row(self, lost: int, at: int) -> tuple[int, int] | None:
        """Find the next row when one does not fit.

        A row right after the seeming end of the lost one needs no second row to be accepted when the lost row cannot
        have another length, or nothing better is near.

        Parameters
        ----------
        lost : int
            Number of the row that does not fit.
        at : int
            Its position.

        Returns
        -------
        (int, int) or None
            Position and number of the next good row (number of rows: the trailer).
        """
        total = self.layout.rows.size
        after = self._after(lost, at) if lost < total else -1
        if after >= 0 and not self.coder[0]:
            return after, lost + 1
        following, near = min(lost + 1, total), min(self.stop, at + self.longest + COUNTED_BYTES)
        found = self._find(after, after + 1, following, following) if after >= 0 else None
        found = found or self._find(at, near, following, following)
        if found or after >= 0:
            return found or (after, following)
        return self._find(at, self.stop, following, total)

    def _after(self, lost: int, at: int) -> int:
        """Position right after the lost row where the next one (or the trailer) fits, or -1."""
        rows, counts = self.layout.rows, self.layout.counts
        end, _, _ = check_row(self.data, at, self.stop, int(counts[lost]), *self.coder)
        return end if end >= 0 and row_fits(self.data, end, self.stop, lost + 1, rows, counts, *self.coder) else -1

    def _find(self, start: int, stop: int, first: int, last: int) -> tuple[int, int] | None:
        position, ordinal, self.limit = find_row(
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
