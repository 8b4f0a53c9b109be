"""The stream beside general coders: the same codes of eight scenes at several thresholds, by our own count of bytes."""

import heapq
import zlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import imagecodecs
import numpy as np
import numpy.typing as npt
import zstandard

from talbot.flow.frame.codecs import JPEGXL_EFFORT
from talbot.models.digital.stream import StreamHeader, encode_frame
from talbot.models.parameters import FrameParameters, TileParameters, Window
from talbot.models.parameters.stream_format import HEADER_BYTES, TRAILER_BYTES

from .codes import Codes, entropy_bytes, thresholded
from .orders import CHIP, MARK_BYTES, segments_of
from .table import Table

SCENES = ("motorcycle", "astronaut", "camera", "chelsea", "coffee", "coins", "rocket", "text")
LEVELS = (0, 2, 4, 7, 10, 14, 20)  # thresholds; the first two lie under the noise
LANES = 8  # converters of the default sensor: sample i of a row is of converter i mod 8
FRAME = HEADER_BYTES + TRAILER_BYTES  # that any stream needs: counted with the other coders' bytes, too
GOAL, FIXED = 1.1, 150  # bytes of a frame: at most GOAL times the entropy, and FIXED


def _zlib(codes: Codes) -> int:
    return len(zlib.compress(codes.astype(np.int8).tobytes(), 9))


def _zstd(codes: Codes) -> int:
    return len(zstandard.ZstdCompressor(level=19).compress(codes.astype(np.int8).tobytes()))


def _picture(codes: Codes) -> npt.NDArray[np.uint8]:
    return (codes + 128).astype(np.uint8)


def _jpeg_ls(codes: Codes) -> int:
    return len(imagecodecs.jpegls_encode(_picture(codes)))


def _jpeg_xl(codes: Codes) -> int:
    return len(imagecodecs.jpegxl_encode(_picture(codes), lossless=True, effort=JPEGXL_EFFORT))


def _rice(codes: Codes) -> int:
    """A Golomb-Rice code of each sample, its parameter the best of the frame's: as small a coder as there is."""
    magnitudes = np.abs(codes[codes != 0].astype(int))
    rank = magnitudes - magnitudes.min(initial=128) + 1
    folded = 2 * rank - (codes[codes != 0] > 0)
    return -(-min(int((folded >> k).sum()) + codes.size * (1 + k) for k in range(8)) // 8)


def _classes(values: npt.NDArray[np.int64]) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Class 0..24 of each value (-6..6 have one each, larger ones octaves), and the bits that complete it."""
    size = np.abs(values)
    octave = np.log2(np.maximum(size - 7, 0) + 4).astype(int)
    return 12 + np.sign(values) * np.where(size > 6, 5 + octave, size), np.where(size > 6, octave, 0)


def _huffman_lengths(counts: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Bits of each symbol in a prefix code that is best for the counts, 1 at least; 0 for a symbol without a count."""
    lengths = np.zeros(counts.size, int)
    heap = [(int(count), [int(symbol)]) for symbol, count in enumerate(counts) if count]
    if len(heap) == 1:
        lengths[heap[0][1]] = 1
    heapq.heapify(heap)
    while len(heap) > 1:
        (few, some), (more, others) = heapq.heappop(heap), heapq.heappop(heap)
        lengths[some + others] += 1
        heapq.heappush(heap, (few + more, some + others))
    return lengths


def _tables(codes: Codes) -> int:
    """A prefix code of each sample, from 24 tables that are best for the frame and sent nowhere.

    The table follows from the mean magnitude of the last samples of the row (8 levels) and from the signs of the last
    two samples of the same converter. Every row is a segment with its mark.
    """
    values = codes.astype(int)
    lowest = np.abs(values[values != 0]).min(initial=128)
    values -= np.sign(values) * (lowest - 1)
    mean, level = np.full(len(values), 16), np.zeros(values.shape, int)  # in 1/16
    for column, size in enumerate(np.minimum(np.abs(values.T), 15)):
        level[:, column] = np.minimum(np.log2(mean + 1), 7)
        mean += (16 * size - mean) >> 3
    signs = np.pad(np.sign(values), ((0, 0), (2 * LANES, 0)))
    bias = signs[:, LANES:-LANES] + signs[:, : -2 * LANES]
    kind, rest = _classes(np.where(bias < 0, -values, values))
    table = 3 * level + np.abs(bias)
    lengths = np.stack([_huffman_lengths(np.bincount(kind[table == one], minlength=25)) for one in range(24)])
    bits = (lengths[table, kind] + rest).sum(1)
    return int((-(-bits // 8) + MARK_BYTES).sum())


CODERS: dict[str, Callable[[Codes], int]] = {
    "zlib -9": _zlib,
    "zstd -19": _zstd,
    "JPEG-LS": _jpeg_ls,
    "JPEG XL": _jpeg_xl,
    "Golomb-Rice": _rice,
    "tables": _tables,
}


def stream_bytes(codes: Codes, threshold: int, tile: TileParameters = TileParameters()) -> int:
    """Bytes of the chip's stream with the default segments. codes: (rows, cols)."""
    rows, cols = codes.shape
    window = Window(0, -(-rows // tile.rows) - 1, 0, -(-cols // tile.cols) - 1)
    header = StreamHeader.from_frame(rows, cols, 8, FrameParameters(window, threshold=threshold), tile)
    return len(encode_frame(header, codes[..., None], 0, 0, tile))


def compare(name: str, codes: Codes, thresholds: Sequence[int] = LEVELS) -> list[dict[str, Any]]:
    """A dict for each threshold: bytes of the entropy, the stream and every coder.

    codes: of the scene ``name`` without a threshold, (rows, cols). The coders get the codes row after row or in the
    stream's order, whichever takes fewer bytes (JPEG-LS, JPEG XL: as a picture, or a row of it type by type).
    """
    order = np.stack(segments_of(CHIP, *codes.shape))
    rows = []
    for threshold in thresholds:
        sent = thresholded(codes, threshold)
        ways = sent, sent.ravel()[order]
        known = {"scene": name, "threshold": threshold, "samples": sent.size, "not_zero": float((sent != 0).mean())}
        sizes = {"entropy": round(entropy_bytes(sent)), "stream": stream_bytes(sent, threshold)}
        sizes |= {coder: FRAME + min(map(size, ways)) for coder, size in CODERS.items()}
        rows.append(known | sizes)
    return rows


def tables(rows: Sequence[Mapping[str, Any]], threshold: int) -> list[Table]:
    """The scenes at one ``threshold``, and what is worst of all scenes at each. rows: of `compare`."""
    names = "entropy", "stream", *CODERS

    def worst(some: Sequence[Mapping[str, Any]], bound: Callable[[Mapping[str, Any]], float]) -> str:
        over, scene = max((r["stream"] / bound(r), r["scene"]) for r in some)
        return f"{over:.2f} ({scene})"

    scenes = [
        [r["scene"], f"{100 * r['not_zero']:.2f} %", *(f"{r[n]:,}" for n in names)]
        for r in rows
        if r["threshold"] == threshold
    ]
    levels = []
    for level in dict.fromkeys(r["threshold"] for r in rows):
        some = [r for r in rows if r["threshold"] == level]
        worsts = (
            worst(some, lambda r: GOAL * r["entropy"] + FIXED),
            worst(some, lambda r: r["zstd -19"]),
            worst(some, lambda r: r["samples"]),
        )
        levels.append([level, *(f"{sum(r[n] for r in some):,}" for n in names), *worsts])
    bounds = f"worst of {GOAL:g} entropy + {FIXED}", "worst of zstd -19", "worst of a byte a sample"
    return [
        Table(f"Scenes at a threshold of {threshold}, bytes of a frame:", ["scene", "not zero", *names], scenes),
        Table("All scenes, sums of bytes:", ["threshold", *names, *bounds], levels),
    ]
