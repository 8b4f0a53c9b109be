"""Size of the stream compared with the entropy of its codes and with zstd (docs/results/stream.md)."""

import numpy as np
import pytest
import zstandard

from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.request import request
from talbot.models.digital.scan import Scan
from talbot.models.digital.stream import StreamHeader, encode_frame
from talbot.models.parameters import FrameParameters, TileParameters, Window
from talbot.models.parameters.stream_format import HEADER_BYTES, TRAILER_BYTES

SCENES = "motorcycle", "astronaut", "camera", "chelsea", "coffee", "coins", "rocket", "text"
THRESHOLDS = 0, 2, 4, 7, 10, 14, 20  # the first two are below the noise
TILE = TileParameters()


def frame_of(shape, threshold):
    rows, cols = shape
    window = Window(0, -(-rows // TILE.rows) - 1, 0, -(-cols // TILE.cols) - 1)
    return FrameParameters(window, threshold=threshold)


def stream_bytes(codes, threshold):
    header = StreamHeader.from_frame(*codes.shape, 8, frame_of(codes.shape, threshold), TILE)
    return len(encode_frame(header, codes[..., None], 0, 0, TILE))


def entropy_bytes(codes):
    """Bytes of an ideal coder of single samples."""
    _, counts = np.unique(codes, return_counts=True)
    return float(-(counts * np.log2(counts / codes.size)).sum() / 8)


def zstd_bytes(codes):
    """Bytes of zstd with the header and trailer that any stream needs, in raster order or in the stream's."""
    rows, cols = codes.shape
    scan = Scan(rows, cols, 8, frame_of(codes.shape, 0), TILE)
    order = np.concatenate([row * cols + scan.row_samples(row)[0] for row in range(rows)])
    orders = codes.ravel(), codes.ravel()[order]
    sizes = (len(zstandard.ZstdCompressor(level=19).compress(some.astype(np.int8).tobytes())) for some in orders)
    return HEADER_BYTES + TRAILER_BYTES + min(sizes)


def check(codes, threshold, zstd_factor=1.0):
    """At most 1.1 of the entropy and 150 bytes, and at most ``zstd_factor`` of zstd's."""
    size = stream_bytes(codes, threshold)
    assert size <= 1.1 * entropy_bytes(codes) + 150
    assert size <= zstd_factor * zstd_bytes(codes)


@pytest.mark.parametrize("share", [0.0, 1e-4, 1e-3, 0.01])
def test_sparse_frames_are_near_their_entropy_and_smaller_than_by_zstd(share):
    """Values at random positions: nothing to gain from their neighbours."""
    rng = np.random.default_rng(3)
    magnitude = np.minimum(rng.geometric(0.15, (384, 384)) + 9, 127)
    codes = np.where(rng.random((384, 384)) < share, magnitude * rng.choice([-1, 1], (384, 384)), 0).astype(np.int16)
    check(codes, 10)


def test_noise_grows_by_less_than_a_sixteenth():
    noise = np.random.default_rng(4).integers(-128, 128, (64, 384)).astype(np.int16)
    assert stream_bytes(noise, 0) <= noise.size * 17 / 16


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES)
def test_scenes_are_near_their_entropy_and_smaller_than_by_zstd_above_the_noise(scene):
    codes = golden_result(request(scene=scene, threshold=0)).decoded.samples[..., 0]
    for threshold in THRESHOLDS:
        sent = np.where(np.abs(codes) < threshold, 0, codes).astype(np.int16)
        check(sent, threshold, 1.0 if threshold >= 4 else 1.16)
