"""Speed of the codec, by ``make bench``: MB/s of stream bytes and of decoded samples (int16) are in extra_info."""

import numpy as np
import pytest

from talbot.models.digital.stream import decode_stream, encode_frame
from talbot.models.digital.stream.test.frames import header_of, samples_of

CASES = {
    "noise": ("edge", 0, 1),
    "dense": ("edge", 0, 0.5),
    "edges": ("edge", 10, 0.12),
    "zeros": ("edge", 127, 0),
    "raw": ("raw", 0, 1),
}


@pytest.mark.bench
@pytest.mark.parametrize("case", CASES)
def test_decode(benchmark, case):
    mode, threshold, share = CASES[case]
    header = header_of(384, 384, mode=mode, threshold=threshold)
    if case == "noise":
        samples = np.random.default_rng(1).integers(-128, 128, (384, 384, 1))
    else:
        samples = samples_of(header, 1, share)
    data = encode_frame(header, samples, 0, 0)
    (frame,) = benchmark(decode_stream, data)
    assert np.array_equal(frame.samples, samples)
    if benchmark.stats:
        seconds = benchmark.stats["median"]
        benchmark.extra_info |= {
            "ratio": samples.size / len(data),
            "stream_mb_s": len(data) / seconds / 1e6,
            "samples_mb_s": frame.samples.nbytes / seconds / 1e6,
        }


@pytest.mark.bench
def test_encode(benchmark):
    header = header_of(384, 384, threshold=10)
    samples = samples_of(header, 1, 0.12)
    assert decode_stream(benchmark(encode_frame, header, samples, 0, 0))[0].complete
