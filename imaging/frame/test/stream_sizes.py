"""Bytes of edge frames as the chip sends them and by other coders: the tables of docs/results/stream.md.

python -m talbot.imaging.frame.test.stream_sizes prints them (needs the extra `codecs`); `ternary`: of decision 2.
"""

import sys
import zlib
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import zstandard

from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.request import request
from talbot.models.digital.scan import Scan
from talbot.models.digital.stream import StreamHeader, encode_frame, encode_payload
from talbot.models.parameters import FrameParameters, TileParameters, Window
from talbot.models.parameters.stream_format import HEADER_BYTES, TRAILER_BYTES

Codes = npt.NDArray[np.integer]
Sizes = dict[str, float]  # bytes by coder
SCENES = "motorcycle", "astronaut", "camera", "chelsea", "coffee", "coins", "rocket", "text"
OTHERS = "moon", "page", "tilted"
TABLE = 0, 2, 4, 10, 20  # thresholds of the sums
AT = 10  # threshold of the single scenes
EFFORT = 9  # of JPEG XL
TILE = TileParameters()


def frame_of(shape: tuple[int, ...], threshold: int) -> FrameParameters:
    """An edge frame of a whole array."""
    rows, cols = shape
    window = Window(0, -(-rows // TILE.rows) - 1, 0, -(-cols // TILE.cols) - 1)
    return FrameParameters(window, threshold=threshold)


def codes_of(scene: str) -> Codes:
    """Codes of the default sensor's frame of a scene, every sample converted."""
    return golden_result(request(scene=scene, threshold=0)).decoded.samples[..., 0]


def at_threshold(codes: Codes, threshold: int) -> Codes:
    """What the window comparison leaves of the codes."""
    return np.where(np.abs(codes) < threshold, 0, codes).astype(np.int16)


def stream_bytes(codes: Codes, threshold: int) -> int:
    """Bytes of the chip's stream."""
    header = StreamHeader.from_frame(*codes.shape, 8, frame_of(codes.shape, threshold), TILE)
    return len(encode_frame(header, codes[..., None], 0, 0, TILE))


def entropy_bytes(codes: Codes) -> float:
    """Bytes of an ideal coder of single samples."""
    _, counts = np.unique(codes, return_counts=True)
    return float(-(counts * np.log2(counts / codes.size)).sum() / 8)


def _least(codes: Codes, coder: Callable[[bytes], bytes]) -> int:
    """Least bytes of raster order and of the stream's, with the header and trailer that any stream needs."""
    rows, cols = codes.shape
    scan = Scan(rows, cols, 8, frame_of(codes.shape, 0), TILE)
    order = np.concatenate([row * cols + scan.row_samples(row)[0] for row in range(rows)])
    orders = codes.ravel(), codes.ravel()[order]
    return HEADER_BYTES + TRAILER_BYTES + min(len(coder(some.astype(np.int8).tobytes())) for some in orders)


def zstd_bytes(codes: Codes) -> int:
    """Bytes of zstd."""
    return _least(codes, zstandard.ZstdCompressor(level=19).compress)


def zlib_bytes(codes: Codes) -> int:
    """Bytes of zlib."""
    return _least(codes, lambda data: zlib.compress(data, 9))


def planes_of(codes: Codes) -> Codes:
    """The pictures of the pixel types, side by side, (rows / 4, 24 cols / 6): JPEG XL makes the least of them so."""
    height, width = TILE.rows, TILE.cols
    return np.concatenate([codes[y::height, x::width] for y in range(height) for x in range(width)], 1)


def jpegxl_bytes(codes: Codes) -> int:
    """Bytes of a lossless JPEG XL of a picture of codes, with the header and trailer that any stream needs."""
    import imagecodecs  # an extra

    picture = (codes + 128).astype(np.uint8)
    return HEADER_BYTES + TRAILER_BYTES + len(imagecodecs.jpegxl_encode(picture, lossless=True, effort=EFFORT))


CODERS: dict[str, Callable[[Codes, int], float]] = {
    "entropy": lambda codes, threshold: entropy_bytes(codes),
    "stream": stream_bytes,
    "zlib": lambda codes, threshold: zlib_bytes(codes),
    "zstd": lambda codes, threshold: zstd_bytes(codes),
    "JPEG XL": lambda codes, threshold: jpegxl_bytes(codes),
    "JPEG XL of the types": lambda codes, threshold: jpegxl_bytes(planes_of(codes)),
}


def sizes_of(scene: str) -> dict[int, Sizes]:
    """Bytes by every coder at each threshold of TABLE."""
    codes, out = codes_of(scene), {}
    for threshold in TABLE:
        sent = at_threshold(codes, threshold)
        out[threshold] = {name: coder(sent, threshold) for name, coder in CODERS.items()}
    return out


def tables(sizes: dict[str, dict[int, Sizes]]) -> list[str]:
    """Lines of the scenes at the threshold AT, of the sums of SCENES, and of all, with the largest ratios."""
    lines = [f"| {scene} | {' | '.join(f'{v:,.0f}' for v in rows[AT].values())} |" for scene, rows in sizes.items()]
    for scenes in (SCENES, tuple(sizes)):
        for threshold in TABLE:
            rows = [sizes[scene][threshold] for scene in scenes]
            sums = [f"{sum(row[name] for row in rows):,.0f}" for name in CODERS if name != "zlib"]
            bound = max(row["stream"] / (1.1 * row["entropy"] + 150) for row in rows)
            ratios = [max(row["stream"] / row[name] for row in rows) for name in ("zstd", "JPEG XL of the types")]
            lines.append(f"| {threshold} | {' | '.join((*sums, *(f'{x:.3f}' for x in (bound, *ratios))))} |")
    return lines


def ternary_line(threshold: int) -> str:
    """Line of the sums of SCENES in ternary mode: signs of a bit, codes of 1, codes of the threshold, five a byte."""
    sizes = []
    for scene in SCENES:
        signs = np.sign(at_threshold(codes_of(scene), threshold))
        layout = StreamHeader.from_frame(*signs.shape, 8, frame_of(signs.shape, threshold), TILE).layout(TILE)
        row = signs.ravel()[layout.order]
        coded = [encode_payload(row * size, True, base) for size, base in ((1, 0), (1, 1), (threshold, threshold))]
        sizes.append([*map(len, coded), -(-row.size // 5)])
    return f"| {threshold} | {' | '.join(f'{total:,}' for total in np.sum(sizes, 0))} |"


if __name__ == "__main__":
    if "ternary" in sys.argv:
        print("\n".join(ternary_line(threshold) for threshold in (4, 10, 20)))
        sys.exit()
    print("\n".join(tables({scene: sizes_of(scene) for scene in (*SCENES, *OTHERS)})))
