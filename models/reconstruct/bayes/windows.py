"""Positions of blocks of pixels and of the windows around them; a window at the border is moved inside."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt


class Group(NamedTuple):
    """Blocks along an axis whose windows begin at the same place in a tile, and are placed alike around the block.

    phase: first pixel of the windows, in the tile.
    offset: first pixel of the blocks, in their windows.
    blocks: index of each block.
    windows: first pixel of each window.
    """

    phase: int
    offset: int
    blocks: slice
    windows: slice


# Samples of every group, (samples, windows)
Windows = Sequence[tuple[Group, Group, npt.NDArray[np.floating]]]


@dataclass(frozen=True)
class Axis:
    """Blocks and windows along one axis.

    length: pixels of the array.
    period: pixels of a tile.
    block, window: pixels of a block, and of the window around it.
    """

    length: int
    period: int
    block: int
    window: int

    @classmethod
    def of(cls, length: int, period: int, margin: int, block: int | None = None) -> "Axis":
        """Blocks of a tile, or of a part of one.

        length, period: pixels of the array and of a tile. margin: pixels of a window on each side of its block. block:
        pixels of a block; None is a tile. Returns Axis: no window is longer than the array.
        """
        block = min(block or period, length)
        return cls(length, period, block, min(block + 2 * margin, length))

    @property
    def blocks(self) -> npt.NDArray[np.int64]:
        """First pixel of each block; the last ends with the array."""
        return np.minimum(np.arange(0, self.length, self.block), self.length - self.block)

    @property
    def firsts(self) -> npt.NDArray[np.int64]:
        """First pixel of the window of each block."""
        return np.clip(self.blocks - (self.window - self.block) // 2, 0, self.length - self.window)

    def spread(self) -> npt.NDArray[np.float64]:
        """Make the matrix from values at the middles of the blocks to values at the pixels, linear between.

        Returns (length, blocks), rows of sum 1.
        """
        middles = self.blocks + (self.block - 1) / 2
        return np.stack([np.interp(np.arange(self.length), middles, unit) for unit in np.eye(len(middles))], 1)

    def groups(self) -> Iterator[Group]:
        """Find the groups.

        Yields Group: every block is in one.
        """
        first = self.firsts
        # The last block may begin out of step; a group is evenly spaced
        keys = np.stack([first % self.period, self.blocks - first, self.blocks % self.block], 1)
        for key in np.unique(keys, axis=0):
            members = np.flatnonzero((keys == key).all(1))
            yield Group(int(key[0]), int(key[1]), even(members), even(first[members]))


def even(places: npt.NDArray[np.int64]) -> slice:
    """Make the slice of some places.

    places: (n,), at least one, evenly spaced, rising. Returns slice: of these places.
    """
    step = int(places[1] - places[0]) if len(places) > 1 else 1
    return slice(int(places[0]), int(places[-1]) + 1, step)
