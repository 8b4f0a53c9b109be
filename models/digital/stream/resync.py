"""Finding the next good row behind a damaged one.

A row carries no length, so a damaged one hides where the next begins. But at every position some row can be
decoded on trial, and its mark, xor the payload's CRC-16, is the row's index if it is a row and a random number
if not. A trial is believed when its index is plausible and the row (or trailer) after it fits as well.
"""

import numpy as np

from models.parameters import ROWS_MAX
from models.parameters.stream_format import COUNTED_BYTES

from .payload import check_row, find_row, row_bytes_max, row_fits


class Search:
    """The searches of one frame. ``limit``: samples that they may still decode on trial."""

    def __init__(self, data, stop, limit, layout, edge, base, where, value):
        """data: uint8. stop: where the next frame starts, or the end. where, value: scratch for a row's samples."""
        self.data, self.stop, self.limit, self.layout = data, stop, limit, layout
        self.coder = edge, base, where, value
        self.number = np.full(ROWS_MAX, -1, np.int32)
        self.number[layout.rows] = np.arange(layout.rows.size)
        self.longest = row_bytes_max(int(layout.counts.max()), edge) + 2

    def next_row(self, lost, at):
        """Where to go on when row number ``lost`` does not fit at ``at``: (position, ordinal) or None.

        A row behind the lost one, where that seems to end, needs no second row to be believed when the lost row
        cannot have another length, or nothing better is near.
        """
        total = self.layout.rows.size
        behind = self._behind(lost, at) if lost < total else -1
        if behind >= 0 and not self.coder[0]:
            return behind, lost + 1
        following, near = min(lost + 1, total), min(self.stop, at + self.longest + COUNTED_BYTES)
        return (
            behind >= 0
            and self._find(behind, behind + 1, following, following)
            or self._find(at, near, following, following)
            or behind >= 0
            and (behind, following)
            or self._find(at, self.stop, following, total)
        )

    def _behind(self, lost, at):
        """Where row number ``lost`` + 1 (or the trailer) fits right behind the lost one, or -1."""
        rows, counts = self.layout.rows, self.layout.counts
        end, _, _ = check_row(self.data, at, self.stop, int(counts[lost]), *self.coder)
        return end if end >= 0 and row_fits(self.data, end, self.stop, lost + 1, rows, counts, *self.coder) else -1

    def _find(self, start, stop, first, last):
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
