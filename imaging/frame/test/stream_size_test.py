"""Size of the stream compared with the entropy of its codes and with zstd (docs/results/stream.md)."""

import numpy as np
import pytest

from talbot.imaging.frame.test.stream_sizes import (
    SCENES,
    at_threshold,
    codes_of,
    entropy_bytes,
    planes_of,
    stream_bytes,
    zstd_bytes,
)

THRESHOLDS = 0, 2, 4, 7, 10, 14, 20  # the first four are within noise and fixed pattern


def check(codes, threshold, zstd_factor=1.0):
    """At most 1.13 of the entropy and 150 bytes, and at most ``zstd_factor`` of zstd's."""
    size = stream_bytes(codes, threshold)
    assert size <= 1.13 * entropy_bytes(codes) + 150
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
    codes = codes_of(scene)
    for threshold in THRESHOLDS:
        check(at_threshold(codes, threshold), threshold, 1.0 if threshold >= 10 else 1.16)


def test_the_planes_hold_every_code_of_a_type_together():
    codes = np.arange(8 * 12).reshape(8, 12)
    planes = planes_of(codes)
    np.testing.assert_array_equal(planes[:, 14:16], codes[1::4, 1::6])
    assert sorted(planes.ravel()) == list(range(96))
