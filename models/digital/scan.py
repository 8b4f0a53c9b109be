"""The scan: the pixels that a frame reads, and their order (docs/chip.md, Scan order)."""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import SAMPLES_PER_PIXEL, FrameParameters, ParameterError, TileParameters


@dataclass(frozen=True)
class Step:
    """One conversion step: every enabled lane of L converts the pixel at (row, 6 * (L * group + lane) + k).

    row: pixel row.
    k: column in the tile.
    group: tile columns L * group .. L * group + L - 1.
    sub: sub-sample.
    enable: bit l set = lane l converts.
    """

    row: int
    k: int
    group: int
    sub: int
    enable: int


@dataclass(frozen=True)
class Scan:
    """Order of the rows, steps and samples of one frame.

    rows, cols: size of the array in pixels.
    lanes: converters, a power of two.
    frame: configuration of the frame.
    tile: the tile.

    Raises ParameterError if the window is outside the array or selects no pixel.
    """

    rows: int
    cols: int
    lanes: int
    frame: FrameParameters
    tile: TileParameters = TileParameters()

    def __post_init__(self) -> None:
        window, tile = self.frame.window, self.tile
        for axis, size, step in (("row", self.rows, tile.rows), ("col", self.cols, tile.cols)):
            last = -(-size // step) - 1
            if getattr(window, f"{axis}1") > last:
                raise ParameterError(f"window {axis}1 = {getattr(window, axis + '1')}: must be in 0..{last} (tiles)")
        if not self.row_list.size:
            raise ParameterError(f"mask = {self.frame.mask:#08x}: must select a pixel type in the window")

    @property
    def subs(self) -> int:
        """Samples per pixel: 1, 2 (raw) or 4 (tof)."""
        return SAMPLES_PER_PIXEL[self.frame.mode]

    @cached_property
    def row_list(self) -> npt.NDArray[np.int64]:
        """Rows that are read, ascending."""
        w, tile = self.frame.window, self.tile
        tiles = np.arange(w.row0, w.row1 + 1, 1 << self.frame.decimation)
        rows = (tile.rows * tiles[:, None] + np.arange(tile.rows)).ravel()
        has_samples = np.array([bool(self.columns_of(r)) for r in range(tile.rows)])
        return rows[(rows < self.rows) & has_samples[rows % tile.rows]]

    @cached_property
    def read(self) -> npt.NDArray[np.bool_]:
        """Pixels that are read: bool (rows, cols)."""
        out = np.zeros((self.rows, self.cols), bool)
        for row in range(self.tile.rows):
            rows = self.row_list[self.row_list % self.tile.rows == row]
            if rows.size:
                out[np.ix_(rows, np.unique(self.row_samples(row)[0]))] = True
        return out

    def columns_of(self, row: int) -> tuple[int, ...]:
        """Unmasked in-tile columns of a row that exist in the window's first tile.

        row: pixel row. Returns k, ascending.
        """
        base = (row % self.tile.rows) * self.tile.cols
        first = self.tile.cols * self.frame.window.col0
        return tuple(
            k
            for k in range(self.tile.cols)
            if self.frame.mask >> self.tile.order[base + k] & 1 and first + k < self.cols
        )

    def steps(self, row: int) -> list[Step]:
        """Steps of one row.

        ``enable`` is 0 where the array ends, or decimation keeps no tile of the last group: nothing is converted.

        row: pixel row. Returns list of Step: in order.
        """
        w, lanes = self.frame.window, self.lanes
        stride = 1 << self.frame.decimation
        groups = range(w.col0 // lanes, w.col1 // lanes + 1, max(1, stride // lanes))
        out = []
        for k in self.columns_of(row):
            for group in groups:
                tiles = [lanes * group + lane for lane in range(lanes)]
                enable = sum(
                    1 << lane
                    for lane, t in enumerate(tiles)
                    if w.col0 <= t <= w.col1 and (t - w.col0) % stride == 0 and self.tile.cols * t + k < self.cols
                )
                out += [Step(row, k, group, sub, enable) for sub in range(self.subs)]
        return out

    def row_samples(self, row: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        """Samples of one row in the order of the stream.

        row: pixel row. Returns cols ((n,), pixel column of each sample), subs ((n,), sub-sample; with ``frame.phase`` 0
        is the phase and 1 the amplitude).
        """
        return _row_samples(self, row % self.tile.rows)


@lru_cache(maxsize=32)
def pixels_read(
    rows: int, cols: int, lanes: int, frame: FrameParameters, tile: TileParameters
) -> npt.NDArray[np.bool_]:
    """Pixels that a frame reads, the same array in all frames of a sequence.

    rows, cols: size of the array in pixels. lanes: converters. frame: configuration of the frame. tile: the tile.
    Returns (rows, cols), as `Scan.read`; it cannot be written. Raises ParameterError as `Scan`.
    """
    if frame.frame_number:
        return pixels_read(rows, cols, lanes, replace(frame, frame_number=0), tile)
    read = Scan(rows, cols, lanes, frame, tile).read
    read.setflags(write=False)
    return read


@lru_cache(maxsize=64)
def _row_samples(scan: Scan, row: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    cols: list[int] = []
    subs: list[int] = []
    for step in scan.steps(row):
        lanes = [lane for lane in range(scan.lanes) if step.enable >> lane & 1]
        columns = [scan.tile.cols * (scan.lanes * step.group + lane) + step.k for lane in lanes]
        if not scan.frame.phase:
            cols += columns
            subs += [step.sub] * len(columns)
        elif step.sub == 0:
            cols += [c for c in columns for _ in range(2)]
            subs += [0, 1] * len(columns)
    return np.array(cols, np.int64), np.array(subs, np.int64)
