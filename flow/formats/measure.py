"""Bytes of every format in every scan order, and what noise does to a format."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.digital.stream.payload import base_of
from talbot.models.parameters.stream_format import HEADER_BYTES, TRAILER_BYTES
from talbot.models.reconstruct.psnr import psnr_db

from .codes import Codes, entropy_bytes, thresholded
from .company import stream_bytes
from .orders import MARK_BYTES, ORDERS, Indices, segments_of
from .tokens import FORMATS, Encoder

THRESHOLDS = (0, 2, 4, 6, 8, 9, 10, 11, 12, 14, 16, 20, 24)


def frame_bytes(codes: Codes, threshold: int, encoder: Encoder, segments: Sequence[Indices]) -> int:
    """Bytes of a frame, header, marks and trailer included. codes: int16 (rows, cols); segments: flat indices."""
    flat, size = codes.ravel(), HEADER_BYTES + TRAILER_BYTES
    out = np.empty(4 * max(map(len, segments)) + 8, np.uint8)
    for segment in segments:
        size += encoder(flat[segment], base_of(threshold), out) + MARK_BYTES
    return size


def measure(
    codes: Codes,
    ideal: npt.NDArray[np.float64],
    thresholds: Sequence[int] = THRESHOLDS,
    progress: Callable[[Sequence[int]], Iterable[int]] = iter,
) -> list[dict[str, Any]]:
    """One dict for each threshold, scan order and format.

    codes, ideal: (rows, cols), of a converter without threshold and ahead of it. progress: wraps the thresholds.
    stream: bytes of the chip's stream. psnr_db: of what is sent against ``ideal``, peak 255 codes. ratio: a byte a
    sample over bytes.
    """
    cut = {name: segments_of(name, *codes.shape) for name in ORDERS}
    rows = []
    for threshold in progress(thresholds):
        sent = thresholded(codes, threshold)
        quality = {"psnr_db": psnr_db(sent, ideal, 255), "not_zero": float((sent != 0).mean())}
        known = {
            "threshold": threshold,
            "stream": stream_bytes(sent, threshold),
            **quality,
            "entropy_ratio": codes.size / entropy_bytes(sent),
        }
        for order, segments in cut.items():
            for name, (encoder, _) in FORMATS.items():
                size = frame_bytes(sent, threshold, encoder, segments)
                rows.append(known | {"order": order, "format": name, "bytes": size, "ratio": codes.size / size})
    return rows


def growth(encoder: Encoder, shape: tuple[int, int] = (64, 384), seed: int = 1) -> float:
    """Bytes of rows of random codes, marks included, over a byte a sample: what the format does to noise."""
    noise = np.random.default_rng(seed).integers(-128, 128, shape).astype(np.int16)
    rows = list(np.arange(noise.size).reshape(shape))
    return (frame_bytes(noise, 0, encoder, rows) - HEADER_BYTES - TRAILER_BYTES) / noise.size
