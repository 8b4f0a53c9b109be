from pathlib import Path

import pytest

from talbot.models.digital.stream import decode_stream
from talbot.models.digital.stream.test.examples import DOCUMENTED, FURTHER, small_frame
from talbot.models.parameters.stream_format import FIELD_BYTES, HEADER_BYTES, TRAILER_BYTES

DOCUMENT = (Path(__file__).parents[5] / "docs" / "stream.md").read_text()


def test_the_worked_example_is_what_the_encoder_gives():
    assert "```\n" + "\n".join(DOCUMENTED()) + "\n```" in DOCUMENT


@pytest.mark.parametrize("example", (DOCUMENTED, *FURTHER))
def test_the_tokens_of_an_example_are_its_payload(example):
    *lines, payload, _ = example()
    bits = "".join(line[47:].replace(" ", "") for line in lines if line.startswith("  k="))
    sent = bytes.fromhex(payload.removeprefix("payload: "))
    assert len(sent) == -(-len(bits) // 8)
    assert f"{int.from_bytes(sent, 'big'):0{8 * len(sent)}b}" == bits.ljust(8 * len(sent), "0")


def test_a_small_frame_decodes():
    words = " ".join(line[14:].replace("mark", "") for line in small_frame())
    (frame,) = decode_stream(bytes.fromhex(words))
    assert frame.complete and not frame.errors and frame.samples[1, 5].tolist() == [220, 230]


def test_sizes_of_the_document():
    assert f"header ({HEADER_BYTES} bytes)" in DOCUMENT and f"trailer ({TRAILER_BYTES} bytes)" in DOCUMENT
    assert f"{255 * (FIELD_BYTES + 4):,} changes" in DOCUMENT
