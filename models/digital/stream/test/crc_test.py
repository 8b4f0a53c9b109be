import zlib

import numpy as np
import pytest

from talbot.models.digital.stream.crc import crc16, one_byte_errors
from talbot.models.digital.stream.payload import crc16_span
from talbot.models.digital.stream.trailer import COUNTED_BYTES
from talbot.models.parameters.stream_format import FIELD_BYTES


def test_check_values_of_the_catalogue():
    assert crc16(b"123456789") == 0x29B1  # CRC-16/IBM-3740
    assert zlib.crc32(b"123456789") == 0xCBF43926


@pytest.mark.parametrize("length", [0, 1, 2, 3, 8, 255])
def test_compiled_crc16_is_the_same(length):
    data = np.random.default_rng(length).integers(0, 256, length + 4).astype(np.uint8)
    assert crc16_span(data, 3, 3 + length) == crc16(data[3 : 3 + length].tobytes())


@pytest.mark.parametrize("length", [FIELD_BYTES, COUNTED_BYTES])
def test_every_change_of_one_byte_has_its_own_syndrome(length):
    errors = one_byte_errors(length)
    assert len(errors) == 255 * (length + 4) and 0 not in errors
    message = bytes(range(length))
    for syndrome, (position, change) in list(errors.items())[::97]:
        sent = bytearray(message + zlib.crc32(message).to_bytes(4, "big"))
        sent[position] ^= change
        assert zlib.crc32(sent[:length]) ^ int.from_bytes(sent[length:], "big") == syndrome
