"""The golden encoder: from one frame's samples to bytes. The RTL's stream equals it byte for byte."""

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from talbot.models.digital.stream.header import StreamHeader
from talbot.models.digital.stream.payload import encode_rows, encode_segment, row_bytes_max
from talbot.models.digital.stream.trailer import row_mark, trailer
from talbot.models.parameters import ParameterError, TileParameters


def encode_frame(
    header: StreamHeader, samples: npt.ArrayLike, made: int, left_out: int, tile: TileParameters = TileParameters()
) -> bytes:
    """Encode one frame.

    header: the frame's header. samples: (rows, cols, header.subs), -128..127 in edge mode, where a code below the
    threshold is sent as zero; -1..1 in ternary mode; else 0..255. Only pixels that the frame reads are used. made,
    left_out: conversions, 0..2**32-1. tile: the sensor's tile. Returns header, rows and trailer. Raises ParameterError
    for a wrong shape, type or range.
    """
    samples = np.asarray(samples)
    shape = header.rows, header.cols, header.subs
    if samples.shape != shape or samples.dtype.kind not in "iu":
        raise ParameterError(f"samples = {samples.dtype} array {samples.shape}: must be integers, shape {shape}")
    layout = header.layout(tile)
    codes = samples.reshape(-1)[layout.order]
    low, high = (-1, 1) if header.mode == "ternary" else (-128, 127) if header.edge else (0, 255)
    if codes.min() < low or codes.max() > high:
        raise ParameterError(f"samples = {codes.min()}..{codes.max()}: must be in {low}..{high} in {header.mode} mode")
    counts = layout.counts
    size = sum(row_bytes_max(n, header.edge) + 2 for n in counts.tolist())
    out = np.empty(size, np.uint8)
    coder = *header.coder, header.segment
    end = encode_rows(codes.astype(np.int16), layout.rows, counts, *coder, out)
    sent, body = header.to_bytes(), out[:end].tobytes()
    return sent + body + trailer(sent, body, made, left_out)


def encode_payload(codes: npt.ArrayLike, edge: bool, base: int) -> bytes:
    """Payload of one segment, without its mark.

    codes: (n,), samples of its rows in the order of the stream. edge: run-length coded signed codes; else plain bytes.
    base: see `payload.base_of`. Returns bytes: at most row_bytes_max(n, edge).
    """
    return _encode(codes, edge, base)[0]


def whole_bytes(codes: npt.ArrayLike, edge: bool, base: int) -> int:
    """Bytes of a segment that are complete before it is closed: their number decides whether it is.

    codes: (n,), samples of its rows so far. edge: run-length coded signed codes; else plain bytes. base: see
    `payload.base_of`. Returns 0 or more.
    """
    return _encode(codes, edge, base)[1]


def _encode(codes: npt.ArrayLike, edge: bool, base: int) -> tuple[bytes, int]:
    codes = np.asarray(codes, np.int16)
    out = np.empty(row_bytes_max(codes.size, edge) + 1, np.uint8)
    end, whole = encode_segment(codes, edge, base, out)
    return out[:end].tobytes(), whole


def encode_marked(row: int, codes: npt.ArrayLike, edge: bool, base: int) -> bytes:
    """Payload and mark of one segment.

    row: index of its first row. codes: (n,), samples of its rows in the order of the stream. edge: run-length coded
    signed codes; else plain bytes. base: see `payload.base_of`. Returns bytes: as in the stream.
    """
    payload = encode_payload(codes, edge, base)
    return payload + row_mark(payload, row)


def segments(header: StreamHeader, rows: Iterable[tuple[int, Sequence[int]]]) -> list[tuple[int, list[int], int]]:
    """Rows gathered to segments.

    header: of their frame. rows: (int, sequence of int), index and samples of each row, in the order of the stream.
    Returns (int, list of int, int), index of the first row, the samples, and the number of rows of each segment.
    """
    out: list[tuple[int, list[int], int]] = []
    full = True
    for row, codes in rows:
        if full:
            out.append((row, [], 0))
        first, gathered, many = out[-1]
        out[-1] = first, [*gathered, *codes], many + 1
        full = whole_bytes(out[-1][1], *header.coder) >= header.segment
    return out
