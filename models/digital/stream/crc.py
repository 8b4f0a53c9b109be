"""The two checks of the stream: CRC-32 of IEEE 802.3 over a frame, CRC-16 over a row, and the syndromes of one byte.

CRC-32 is zlib's (polynomial 0x04c11db7 reflected, starts and ends inverted). CRC-16 is CRC-16/IBM-3740
(polynomial 0x1021, most significant bit first, starts at 0xffff, ends as it is).
"""

import binascii
import zlib
from functools import cache

import numpy as np

CRC16_START = 0xFFFF


def crc16(data: bytes) -> int:
    """CRC-16 of some bytes.

    data: any length. Returns 0..65535.
    """
    return binascii.crc_hqx(data, CRC16_START)


CRC32_TABLE = np.array([zlib.crc32(bytes([byte]), 0xFFFFFFFF) ^ 0xFFFFFFFF for byte in range(256)])
CRC32_BACK = np.empty(256, int)  # the byte whose CRC32_TABLE entry has a given top byte
CRC32_BACK[CRC32_TABLE >> 24] = np.arange(256)

# CRC16_AFTER[n][byte]: what a byte adds to the CRC when n more bytes follow it
CRC16_AFTER = np.array([[binascii.crc_hqx(bytes([byte]) + bytes(n), 0) for byte in range(256)] for n in range(4)])


@cache
def one_byte_errors(length: int) -> dict[int, tuple[int, int]]:
    """Syndromes of every change of one byte in a message and its CRC-32.

    length: bytes of the message. Returns (computed CRC) xor (received CRC) to (position, change); positions from
    ``length`` on are the CRC's own bytes, most significant first.
    """
    quiet = zlib.crc32(bytes(length))
    errors = {}
    for position in range(length):
        for change in range(1, 256):
            message = bytearray(length)
            message[position] = change
            errors[zlib.crc32(message) ^ quiet] = position, change
    for position in range(4):
        for change in range(1, 256):
            errors[change << 8 * (3 - position)] = length + position, change
    return errors
