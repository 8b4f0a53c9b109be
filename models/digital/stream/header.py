"""The header of a frame in the byte stream (docs/stream.md, Header)."""

import zlib
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from talbot.models.digital.scan import Scan
from talbot.models.digital.stream.crc import one_byte_errors
from talbot.models.digital.stream.payload import base_of
from talbot.models.parameters import (
    COLS_MAX,
    LANES,
    MODES,
    ROWS_MAX,
    SAMPLES_PER_PIXEL,
    SIGNED,
    AmpTiming,
    FrameParameters,
    ParameterError,
    TileParameters,
    Window,
    check_choice,
    check_int,
    mode_of,
)
from talbot.models.parameters.stream_format import (
    CRC,
    FIELD_BYTES,
    HEADER_BYTES,
    HEADER_FIELDS,
    MAGIC,
    SEGMENT_BYTES,
    VERSION,
)


class StreamError(ParameterError):
    """The bytes are no stream. The message is one line: where and why."""


@dataclass(frozen=True)
class StreamHeader:
    """Header of a frame: the chip, and the part of the configuration that the decoder needs.

    rows, cols: size of the array in pixels, 1..1024 and 1..1536.
    lanes: converters, a power of two in 1..32.
    tile_rows, tile_cols: size of the tile in pixels, 1..4 and 1..6.
    window, mode, phase, decimation, mask, threshold, frame_number, resync, calibration: as in FrameParameters.
    exposure, n_cm, t_int: lead of the reset pointer in rows, common-mode resets of a row and cycles of each
        integration, as in AmpTiming.

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
    resync: int
    exposure: int
    n_cm: int
    t_int: int
    calibration: int

    def __post_init__(self) -> None:
        check_int("rows", self.rows, 1, ROWS_MAX)
        check_int("cols", self.cols, 1, COLS_MAX)
        check_choice("lanes", self.lanes, LANES)
        check_int("tile rows", self.tile_rows, 1, 4)
        check_int("tile cols", self.tile_cols, 1, 6)
        _ = self.frame  # checks the other fields

    @classmethod
    def from_frame(
        cls, rows: int, cols: int, lanes: int, frame: FrameParameters, tile: TileParameters = TileParameters()
    ) -> Self:
        """Header that a chip sends for a frame.

        rows, cols: size of the array in pixels. lanes: converters. frame: configuration of the frame. tile: the tile.
        Returns the header.
        """
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
            frame.resync,
            frame.timing.exposure,
            frame.timing.n_cm,
            frame.timing.t_int,
            frame.calibration,
        )

    @property
    def frame(self) -> FrameParameters:
        """Configuration; the fields that the stream does not carry have their defaults."""
        return FrameParameters(
            self.window,
            self.mode,
            self.mask,
            self.threshold,
            self.decimation,
            self.phase,
            frame_number=self.frame_number,
            resync=self.resync,
            calibration=self.calibration,
            timing=AmpTiming(n_cm=self.n_cm, t_int=self.t_int, exposure=self.exposure),
        )

    @property
    def edge(self) -> bool:
        """True when the rows are run-length coded signed codes; else they are plain bytes 0..255."""
        return self.mode in SIGNED

    @property
    def coder(self) -> tuple[bool, int]:
        """`edge`, and the smallest magnitude of a coded value: see `payload.base_of`."""
        return self.edge, base_of(self.mode, self.threshold)

    @property
    def segment(self) -> int:
        """Bytes of payload that a segment has at least, unless the frame ends."""
        return SEGMENT_BYTES * self.resync

    @property
    def subs(self) -> int:
        """Samples per pixel in the stream: 1, 2 (raw; phase and amplitude) or 4 (tof)."""
        return 2 if self.phase else SAMPLES_PER_PIXEL[self.mode]

    def to_bytes(self) -> bytes:
        """Encoded header with its CRC-32: HEADER_BYTES bytes."""
        w = self.window
        mode = MODES.index(self.mode)
        flags = self.resync << 6 | self.decimation << 4 | mode >> 2 << 3 | self.phase << 2 | mode & 3
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
            self.exposure,
            self.n_cm,
            self.t_int,
            self.calibration,
        )
        return fields + CRC.pack(zlib.crc32(fields))

    def layout(self, tile: TileParameters = TileParameters()) -> "Layout":
        """Positions of the samples of each row.

        tile: the sensor's tile. Returns Layout: of the frame. Raises ParameterError when the tile has another size, or
        the window is outside the array or selects no pixel.
        """
        if (tile.rows, tile.cols) != (self.tile_rows, self.tile_cols):
            raise ParameterError(
                f"tile = {tile.rows} x {tile.cols}: must be {self.tile_rows} x {self.tile_cols}, as in the header"
            )
        frame = FrameParameters(self.window, self.mode, self.mask, 0, self.decimation, self.phase)
        return _layout(self.rows, self.cols, self.lanes, frame, self.subs, tile)


@dataclass(frozen=True, eq=False)
class Layout:
    """Rows of a frame, and their samples in the order of the stream.

    rows: (R,), rows that are read.
    kind: (R,), list of places of each row.
    counts: (R,), samples of each row.
    places: (n,), for each kind the samples' index col * subs + sub in their row, one list after the other.
    start: (kinds + 1,), start of each list in ``places``.
    order: (samples of a frame,), index of each in an array (rows, cols, subs), row after row.
    """

    rows: npt.NDArray[np.int32]
    kind: npt.NDArray[np.int32]
    counts: npt.NDArray[np.int32]
    places: npt.NDArray[np.int32]
    start: npt.NDArray[np.int32]
    order: npt.NDArray[np.int64]

    def places_of(self, ordinal: int) -> npt.NDArray[np.int32]:
        """Samples of one row in the order of the stream.

        ordinal: number of the row in ``rows``. Returns (n,), index col * subs + sub of each sample in its row.
        """
        kind = self.kind[ordinal]
        return self.places[self.start[kind] : self.start[kind + 1]]


@lru_cache(maxsize=32)
def _layout(rows: int, cols: int, lanes: int, frame: FrameParameters, subs: int, tile: TileParameters) -> Layout:
    scan = Scan(rows, cols, lanes, frame, tile)
    index = scan.row_list.astype(np.int32)
    lists = []
    for k in range(tile.rows):
        columns, sub = scan.row_samples(k)
        lists.append((columns * subs + sub).astype(np.int32))
    start = np.cumsum([0] + [places.size for places in lists]).astype(np.int32)
    kind = index % tile.rows
    order = np.concatenate([row * cols * subs + lists[k] for row, k in zip(index.astype(np.int64), kind, strict=True)])
    return Layout(index, kind, np.diff(start)[kind], np.concatenate(lists), start, order)


def _correct(data: bytes) -> tuple[bytes, int | None] | None:
    """Correct one wrong byte of a header: (header as sent, position of the byte or None), or None."""
    syndrome = zlib.crc32(data[:FIELD_BYTES]) ^ CRC.unpack_from(data, FIELD_BYTES)[0]
    if not syndrome:
        return bytes(data), None
    error = one_byte_errors(FIELD_BYTES).get(syndrome)
    if error is None:
        return None
    right = bytearray(data)
    right[error[0]] ^= error[1]
    return bytes(right), error[0]


class ReceivedHeader(NamedTuple):
    """A header after the correction of one byte.

    header: its contents.
    sent: the header as it was sent.
    corrected: position of the wrong byte; None if there is none.
    """

    header: StreamHeader
    sent: bytes
    corrected: int | None


def read_header(data: bytes) -> ReceivedHeader:
    """Decode a header, one byte of which may be wrong.

    data: HEADER_BYTES bytes. Returns ReceivedHeader: its contents and the correction. Raises StreamError when this is
    no header, has more than one wrong byte, or holds values out of range.
    """
    if len(data) < HEADER_BYTES:
        raise StreamError(f"{len(data)} bytes: a header has {HEADER_BYTES}")
    if sum(a != b for a, b in zip(MAGIC, data, strict=False)) > 1:
        raise StreamError(f"starts with {bytes(data[: len(MAGIC)])!r}: a frame starts with {MAGIC!r}")
    corrected = _correct(data)
    if corrected is None:
        raise StreamError("header CRC-32 does not fit, and no change of one byte corrects it")
    sent, position = corrected
    magic, version, flags, threshold, lanes, tile, rows, cols, *fields = HEADER_FIELDS.unpack_from(sent)
    row0, row1, col0, col1, mask, frame_number, exposure, n_cm, t_int, calibration = fields
    if magic != MAGIC:
        raise StreamError(f"starts with {magic!r}: a frame starts with {MAGIC!r}")
    if version != VERSION:
        raise StreamError(f"version {version}: this decoder reads version {VERSION}")
    if flags & 0x08 and flags & 3:
        raise StreamError(f"flags = {flags:#04x}: the bit of ternary mode is set with another mode")
    try:
        header = StreamHeader(
            rows,
            cols,
            lanes,
            tile >> 4,
            tile & 15,
            Window(row0, row1, col0, col1),
            mode_of(flags >> 1 & 4 | flags & 3),
            bool(flags & 4),
            flags >> 4 & 3,
            int.from_bytes(mask, "big"),
            threshold,
            frame_number,
            flags >> 6,
            exposure,
            n_cm,
            t_int,
            calibration,
        )
    except ParameterError as error:
        raise StreamError(f"header: {error}") from None
    return ReceivedHeader(header, sent, position)
