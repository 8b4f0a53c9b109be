"""The header of a frame in the byte stream (docs/stream.md, Header)."""

import zlib
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from models.digital.scan import Scan
from models.parameters import (
    COLS_MAX,
    LANES,
    MODES,
    ROWS_MAX,
    SAMPLES_PER_PIXEL,
    FrameParameters,
    ParameterError,
    TileParameters,
    Window,
    check_choice,
    check_int,
)
from models.parameters.stream_format import CRC, FIELD_BYTES, HEADER_BYTES, HEADER_FIELDS, MAGIC, VERSION

from .crc import one_byte_errors


class StreamError(ParameterError):
    """The bytes given are no stream. The message is one line that says where and why."""


@dataclass(frozen=True)
class StreamHeader:
    """What a frame's header says.

    rows, cols, lanes: the chip's. tile_rows, tile_cols: 1..4 and 1..6. frame: of its fields, the stream
    carries mode, window, mask, threshold, decimation, phase and frame_number; the others are not compared.
    Raises ParameterError when a field is out of range.
    """

    rows: int
    cols: int
    lanes: int
    tile_rows: int
    tile_cols: int
    window: Window
    mode: str
    phase: bool
    decimation: int
    mask: int
    threshold: int
    frame_number: int

    def __post_init__(self):
        check_int("rows", self.rows, 1, ROWS_MAX)
        check_int("cols", self.cols, 1, COLS_MAX)
        check_choice("lanes", self.lanes, LANES)
        check_int("tile rows", self.tile_rows, 1, 4)
        check_int("tile cols", self.tile_cols, 1, 6)
        self.frame  # checks the other fields

    @classmethod
    def from_frame(cls, rows, cols, lanes, frame, tile=TileParameters()):
        """The header that a chip of ``rows`` x ``cols`` pixels and ``lanes`` sends. frame: FrameParameters."""
        return cls(
            rows,
            cols,
            lanes,
            tile.rows,
            tile.cols,
            frame.window,
            frame.mode,
            frame.phase,
            frame.decimation,
            frame.mask,
            frame.threshold,
            frame.frame_number,
        )

    @property
    def frame(self):
        """The configuration as FrameParameters; what the stream does not carry has its default."""
        return FrameParameters(
            self.window,
            self.mode,
            self.mask,
            self.threshold,
            self.decimation,
            self.phase,
            frame_number=self.frame_number,
        )

    @property
    def edge(self):
        """True when the rows are run-length coded signed codes; else they are plain bytes 0..255."""
        return self.mode == "edge"

    @property
    def subs(self):
        """Samples of one pixel in the stream: 1, 2 (raw; phase and amplitude) or 4 (tof)."""
        return 2 if self.phase else SAMPLES_PER_PIXEL[self.mode]

    def to_bytes(self):
        """The header with its CRC-32: HEADER_BYTES bytes."""
        w = self.window
        flags = self.decimation << 4 | self.phase << 2 | MODES.index(self.mode)
        fields = HEADER_FIELDS.pack(
            MAGIC,
            VERSION,
            flags,
            self.threshold,
            self.lanes,
            self.tile_rows << 4 | self.tile_cols,
            self.rows,
            self.cols,
            w.row0,
            w.row1,
            w.col0,
            w.col1,
            self.mask.to_bytes(3, "big"),
            self.frame_number,
        )
        return fields + CRC.pack(zlib.crc32(fields))

    def layout(self, tile=TileParameters()):
        """Where the samples of each row lie: Layout.

        Raises ParameterError when the tile has another size, or the window lies outside the array or reads nothing.
        """
        if (tile.rows, tile.cols) != (self.tile_rows, self.tile_cols):
            raise ParameterError(
                f"tile = {tile.rows} x {tile.cols}: must be {self.tile_rows} x {self.tile_cols}, as in the header"
            )
        frame = FrameParameters(self.window, self.mode, self.mask, 0, self.decimation, self.phase)
        return _layout(self.rows, self.cols, self.lanes, frame, self.subs, tile)


@dataclass(frozen=True, eq=False)
class Layout:
    """The rows of a frame, and their samples in the order of the stream.

    rows: int32 (R,), the rows read. kind: int32 (R,), which list of places a row has. counts: int32 (R,), samples.
    places: int32, for each kind the samples' index col * subs + sub in their row, one list after the other.
    start: int32 (kinds + 1,), where each list starts.
    """

    rows: np.ndarray
    kind: np.ndarray
    counts: np.ndarray
    places: np.ndarray
    start: np.ndarray

    def places_of(self, ordinal):
        """Index col * subs + sub of each sample of row number ``ordinal``, in the order of the stream."""
        kind = self.kind[ordinal]
        return self.places[self.start[kind] : self.start[kind + 1]]


@lru_cache(maxsize=32)
def _layout(rows, cols, lanes, frame, subs, tile):
    scan = Scan(rows, cols, lanes, frame, tile)
    index = scan.row_list.astype(np.int32)
    lists = []
    for k in range(tile.rows):
        cols, sub = scan.row_samples(k)
        lists.append((cols * subs + sub).astype(np.int32))
    start = np.cumsum([0] + [places.size for places in lists]).astype(np.int32)
    kind = index % tile.rows
    return Layout(index, kind, np.diff(start)[kind], np.concatenate(lists), start)


def _correct(data):
    """Correct one changed byte of a header: (header as it was, position of the changed byte or None), or None."""
    syndrome = zlib.crc32(data[:FIELD_BYTES]) ^ CRC.unpack_from(data, FIELD_BYTES)[0]
    if not syndrome:
        return bytes(data), None
    error = one_byte_errors(FIELD_BYTES).get(syndrome)
    if error is None:
        return None
    right = bytearray(data)
    right[error[0]] ^= error[1]
    return bytes(right), error[0]


def read_header(data):
    """Read HEADER_BYTES bytes, one of which may be wrong: (StreamHeader, header as it was sent, position or None).

    Raises StreamError when this is no header, is damaged worse, or says what cannot be.
    """
    if len(data) < HEADER_BYTES:
        raise StreamError(f"{len(data)} bytes: a header has {HEADER_BYTES}")
    if sum(a != b for a, b in zip(MAGIC, data, strict=False)) > 1:
        raise StreamError(f"starts with {bytes(data[: len(MAGIC)])!r}: a frame starts with {MAGIC!r}")
    found = _correct(data)
    if found is None:
        raise StreamError("header CRC-32 does not fit, and no change of one byte mends it")
    sent, position = found
    (magic, version, flags, threshold, lanes, tile, rows, cols, row0, row1, col0, col1, mask, frame_number) = (
        HEADER_FIELDS.unpack_from(sent)
    )
    if magic != MAGIC:
        raise StreamError(f"starts with {magic!r}: a frame starts with {MAGIC!r}")
    if version != VERSION:
        raise StreamError(f"version {version}: this decoder reads version {VERSION}")
    if flags & 0xC8:
        raise StreamError(f"flags = {flags:#04x}: reserved bits are set")
    try:
        header = StreamHeader(
            rows,
            cols,
            lanes,
            tile >> 4,
            tile & 15,
            Window(row0, row1, col0, col1),
            MODES[flags & 3],
            bool(flags & 4),
            flags >> 4 & 3,
            int.from_bytes(mask, "big"),
            threshold,
            frame_number,
        )
    except ParameterError as error:
        raise StreamError(f"header: {error}") from None
    return header, sent, position
