"""Blocks of an array and the windows of samples around them."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from talbot.models.capture.projection import Projection
from talbot.models.reconstruct.bayes.windows import Axis, Group, even

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]
Pair = tuple[Group, Group]  # of blocks, down and across
Kind = tuple[int, int, int, int]


@dataclass(frozen=True, eq=False)
class Blocks:
    """A period of a camera's pixels, of the sensor's a tile, is a block.

    y, x: blocks down and across.
    camera: its samples are the array's.
    measured: (responses,), responses of the camera that are read.
    """

    y: Axis
    x: Axis
    camera: Projection
    measured: npt.NDArray[np.bool_]

    @property
    def shape(self) -> tuple[int, int]:
        """The shape of the array."""
        return self.y.length, self.x.length

    def pooled_errors(self, width: float) -> float:
        """Errors that count where those of pixels around are pooled.

        width: standard deviation of the pool, px. Returns one for each sample that tells a disparity, of as many pixels
        as a pool of equal weights has.
        """
        telling = float(self.camera.telling[self.camera.order].sum(0).mean())
        return 4 * math.pi * width**2 * telling

    @cached_property
    def groups(self) -> list[Pair]:
        """Blocks whose windows are alike."""
        return [(down, across) for down in self.y.groups() for across in self.x.groups()]

    def count(self, down: Group, across: Group) -> tuple[int, int]:
        """Blocks of a group, down and across.

        down, across: the group. Returns tuple of int: how many.
        """
        return len(self.y.blocks[down.blocks]), len(self.x.blocks[across.blocks])

    def diodes(self, down: Group, across: Group) -> tuple[Ints, Ints, Ints]:
        """Row, column and response of every sample of a window, channel after channel: sums before differences.

        down, across: the group. Returns (samples,), those three.
        """
        diode = self._responses(down, across)
        y, x = (np.tile(p.ravel(), len(diode)) for p in np.indices(diode.shape[1:]))
        used = self.measured[diode].ravel()
        return y[used], x[used], diode.ravel()[used]

    def _responses(self, down: Group, across: Group) -> Ints:
        """Response of all samples of a window, those that are not read, too, (channels, height, width)."""
        high, wide = self.camera.period
        lines = (down.phase + np.arange(self.y.window)) % high
        return self.camera.order[:, lines[:, None], (across.phase + np.arange(self.x.window)) % wide]

    def aims(self, down: Group, across: Group) -> tuple[Ints, Ints]:
        """Row and column, in the window, of the middle of what every sample of `diodes` sees.

        down, across: the group, of windows of whole squares of the camera. Returns (samples,), pixels, those of the
        samples where a pixel sees itself alone.
        """
        (y, x, _), side = self.diodes(down, across), self.camera.side
        return y // side * side + side // 2, x // side * side + side // 2

    def own(self, down: Group, across: Group) -> tuple[Ints, Ints, int]:
        """Return samples of the block's pixels that tell a disparity, these pixels' numbers in it, and their count.

        down, across: the group. Returns (n,), those three.
        """
        y, x, diode = self.diodes(down, across)
        y, x = y - down.offset, x - across.offset
        inside = self.camera.telling[diode] & (y >= 0) & (y < self.y.block) & (x >= 0) & (x < self.x.block)
        return np.flatnonzero(inside), (y * self.x.block + x)[inside], self.y.block * self.x.block

    def samples(self, pair: Floats, down: Group, across: Group) -> Floats:
        """Samples of all windows of a group.

        pair: (channels, rows, cols), samples of the camera. down, across: the group. Returns (samples, windows), the
        samples.
        """
        windows = sliding_window_view(pair, (self.y.window, self.x.window), (1, 2))
        windows = windows[:, down.windows, across.windows].transpose(0, 3, 4, 1, 2)
        out = np.ascontiguousarray(windows, np.float32).reshape(-1, windows.shape[3] * windows.shape[4])
        if self.measured.all():
            return out
        return out[self.measured[self._responses(down, across)].ravel()]

    def map(self, values: Iterable[Floats]) -> Floats:
        """Put the values of every group's blocks into place.

        values: (pixels, windows), of each group; the latter are the same in all of its blocks. Returns (rows, cols),
        the values.
        """
        out = np.zeros((1, 1, *self.shape), np.float32)
        for (down, across), part in zip(self.groups, values, strict=True):
            shape = len(part), math.prod(self.count(down, across))
            self.place(out, np.broadcast_to(part.reshape(len(part), -1), shape), down, across)
        return out[0, 0]

    def place(self, out: Floats, values: Floats, down: Group, across: Group) -> None:
        """Write the blocks of a group into a light field.

        out: (views, views, rows, cols), the light field. values: (pixels * views**2, windows), of the blocks. down,
        across: the group.
        """
        first, count = self.y.blocks[down.blocks], self.x.blocks[across.blocks]
        part = values.reshape(self.y.block, self.x.block, *out.shape[:2], len(first), len(count))
        lines, columns = even(first), even(count)
        for i, j in np.ndindex(self.y.block, self.x.block):
            rows = slice(lines.start + i, lines.stop + i, lines.step)
            out[:, :, rows, columns.start + j : columns.stop + j : columns.step] = part[i, j]

    def taken(self, values: Floats, down: Group, across: Group) -> Floats:
        """Take the blocks of a group out of pictures: what `place` puts back.

        values: (n, rows, cols), the pictures. down, across: the group. Returns (n, pixels, windows), of the blocks.
        """
        lines, columns = even(self.y.blocks[down.blocks]), even(self.x.blocks[across.blocks])
        windows = sliding_window_view(values, (self.y.block, self.x.block), (1, 2))[:, lines, columns]
        return windows.transpose(0, 3, 4, 1, 2).reshape(len(values), self.y.block * self.x.block, -1)

    @cached_property
    def from_middle(self) -> Floats:
        """Offset of every pixel from the middle of its block's window, float32 (2, rows, cols): down and across, px."""
        offsets = np.indices((self.y.block, self.x.block), np.float32).reshape(2, -1)
        parts = [[], []]
        for group in self.groups:
            for part, axis, side, pixels in zip(parts, (self.y, self.x), group, offsets, strict=True):
                part.append(pixels + np.float32(side.offset - (axis.window - 1) / 2))
        return np.stack([self.map(part) for part in parts])


def kind(down: Group, across: Group) -> Kind:
    """Return the key of similar windows.

    down, across: a group. Returns tuple of int: where its windows begin in a tile, then where the blocks are in them.
    """
    return down.phase, across.phase, down.offset, across.offset
