"""Boxes by place: those that touch a box are found in a few buckets."""

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit

from ..geometry.boxes import Box

BUCKET_NM = 8_000
COLUMNS = 6  # of a row: level, left, bottom, right, top, owner
NONE = -1
Rows = npt.NDArray[np.int64]
Links = npt.NDArray[np.int32]


class Index:
    """Boxes (nm) on levels, each with the number of its owner, in lists by bucket; what is inserted can be removed.

    heads: first link of every bucket. links: (next link, row of boxes). boxes: rows of COLUMNS; of a free one the first
    is the next free row. free: first free link, how many there are, the same of rows.
    """

    def __init__(self, area: Box, levels: int) -> None:
        self.corner = np.array(area[:2])
        self.shape = np.array((levels, *((area[k + 2] - area[k]) // BUCKET_NM + 1 for k in (0, 1))))
        self.heads: Links = np.full(int(self.shape.prod()), NONE, np.int32)
        self.links: Links = np.empty((0, 2), np.int32)
        self.boxes: Rows = np.empty((0, COLUMNS), np.int64)
        self.free = np.array((NONE, 0, NONE, 0))

    def insert(self, rows: Rows) -> Links:
        """Insert ``rows``; their numbers, for `remove`."""
        self._grow(_buckets(rows, self.corner, self.shape), len(rows))
        return _insert(rows, self.heads, self.links, self.boxes, self.free, self.corner, self.shape)

    def remove(self, numbers: Links) -> None:
        """Remove the boxes with these numbers."""
        _remove(numbers, self.heads, self.links, self.boxes, self.free, self.corner, self.shape)

    def touching(self, level: int, box: Box) -> Rows:
        """Rows (left, bottom, right, top, owner) of the boxes that touch ``box``."""
        return self.boxes[self.numbers(level, box), 1:]

    def numbers(self, level: int, box: Box) -> Links:
        """Numbers of these boxes."""
        return _numbers(level, *box, self.heads, self.links, self.boxes, self.corner, self.shape)

    def count(self, level: int, box: Box, besides: int) -> int:
        """How many boxes of others than the owner ``besides`` touch ``box``."""
        return _count(level, *box, besides, self.heads, self.links, self.boxes, self.corner, self.shape)

    def _grow(self, links: int, rows: int) -> None:
        """Make room for so many more."""
        if self.free[1] < links:
            first, more = len(self.links), max(len(self.links), links, 1 << 12)
            chain = np.arange(first + 1, first + more + 1, dtype=np.int32)
            chain[-1] = self.free[0]
            self.links = np.vstack([self.links, np.stack([chain, chain], 1)])
            self.free[:2] = first, self.free[1] + more
        if self.free[3] < rows:
            first, more = len(self.boxes), max(len(self.boxes), rows, 1 << 12)
            fresh = np.zeros((more, COLUMNS), np.int64)
            fresh[:, 0] = np.arange(first + 1, first + more + 1)
            fresh[-1, 0] = self.free[2]
            self.boxes = np.vstack([self.boxes, fresh])
            self.free[2:] = first, self.free[3] + more


@njit(cache=True)
def _span(low: int, high: int, corner: int, size: int) -> tuple[int, int]:
    """First and last bucket from ``low`` to ``high``."""
    first, last = (low - corner) // BUCKET_NM, (high - corner) // BUCKET_NM
    return max(0, min(first, size - 1)), max(0, min(last, size - 1))


@njit(cache=True)
def _buckets(rows: Rows, corner: Rows, shape: Rows) -> int:
    """In how many buckets ``rows`` are, together."""
    found = 0
    for k in range(len(rows)):
        a, c = _span(rows[k, 1], rows[k, 3], corner[0], shape[1])
        b, d = _span(rows[k, 2], rows[k, 4], corner[1], shape[2])
        found += (c - a + 1) * (d - b + 1)
    return found


@njit(cache=True)
def _insert(rows: Rows, heads: Links, links: Links, boxes: Rows, free: Rows, corner: Rows, shape: Rows) -> Links:
    numbers = np.empty(len(rows), np.int32)
    for k in range(len(rows)):
        number = free[2]
        free[2], free[3] = boxes[number, 0], free[3] - 1
        boxes[number] = rows[k]
        numbers[k] = number
        a, c = _span(rows[k, 1], rows[k, 3], corner[0], shape[1])
        b, d = _span(rows[k, 2], rows[k, 4], corner[1], shape[2])
        for i in range(a, c + 1):
            for j in range(b, d + 1):
                bucket = (rows[k, 0] * shape[1] + i) * shape[2] + j
                link = free[0]
                free[0], free[1] = links[link, 0], free[1] - 1
                links[link, 0], links[link, 1] = heads[bucket], number
                heads[bucket] = link
    return numbers


@njit(cache=True)
def _remove(numbers: Links, heads: Links, links: Links, boxes: Rows, free: Rows, corner: Rows, shape: Rows) -> None:
    for number in numbers:
        level = boxes[number, 0]
        a, c = _span(boxes[number, 1], boxes[number, 3], corner[0], shape[1])
        b, d = _span(boxes[number, 2], boxes[number, 4], corner[1], shape[2])
        for i in range(a, c + 1):
            for j in range(b, d + 1):
                bucket = (level * shape[1] + i) * shape[2] + j
                before, link = NONE, heads[bucket]
                while links[link, 1] != number:
                    before, link = link, links[link, 0]
                if before == NONE:
                    heads[bucket] = links[link, 0]
                else:
                    links[before, 0] = links[link, 0]
                links[link, 0] = free[0]
                free[0], free[1] = link, free[1] + 1
        boxes[number, 0] = free[2]
        free[2], free[3] = number, free[3] + 1


@njit(cache=True)
def _numbers(
    level: int, left: int, bottom: int, right: int, top: int,
    heads: Links, links: Links, boxes: Rows, corner: Rows, shape: Rows,
) -> Links:  # fmt: skip
    found = [np.int32(0)]
    found.pop()
    a, c = _span(left, right, corner[0], shape[1])
    b, d = _span(bottom, top, corner[1], shape[2])
    for i in range(a, c + 1):
        for j in range(b, d + 1):
            link = heads[(level * shape[1] + i) * shape[2] + j]
            while link != NONE:
                box = boxes[links[link, 1]]
                if box[1] <= right and box[3] >= left and box[2] <= top and box[4] >= bottom:
                    first = max(a, _span(box[1], box[1], corner[0], shape[1])[0])
                    low = max(b, _span(box[2], box[2], corner[1], shape[2])[0])
                    if i == first and j == low:  # once, of all buckets that it shares with the box
                        found.append(np.int32(links[link, 1]))
                link = links[link, 0]
    return np.array(found, np.int32)


@njit(cache=True)
def _count(
    level: int, left: int, bottom: int, right: int, top: int, besides: int,
    heads: Links, links: Links, boxes: Rows, corner: Rows, shape: Rows,
) -> int:  # fmt: skip
    found = 0
    for number in _numbers(level, left, bottom, right, top, heads, links, boxes, corner, shape):
        found += boxes[number, 5] != besides
    return found
