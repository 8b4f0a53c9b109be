"""Rows as bytes: samples to bits and back, row after row (docs/stream.md, Payload).

`code_sample` is the coder: the packing around it, the hardware's cycle model and the decoder only move its bits.
All that Numba compiles is in this one file, since its cache on disk does not notice that a function in
another file, inlined here, has changed.
"""

import numpy as np
from numba import njit

from models.parameters.stream_format import COUNTED_BYTES, COUNTS, MAGIC, TRAILER_BYTES, TRAILER_ROW

from .crc import CRC16_AFTER, CRC16_START, CRC32_BACK, CRC32_TABLE

START = (3, 4, 0, 128)  # k, r2, run, credit at the start of a row
K_MAX, R2_MAX, CREDIT_MAX = 7, 12, 255
TOKEN_MAX = 24  # bits of the longest token

# By the zeros before a value's leading one: what they do to r2. By the value's top byte: how many they are.
R2_STEP = np.array([-1, 0] + [1] * 7)
PREFIX = np.array([8 - byte.bit_length() for byte in range(256)])

_COUNTS, _COUNTED, _TRAILER = COUNTS.size, COUNTED_BYTES, TRAILER_BYTES
_MAGIC = np.frombuffer(MAGIC, np.uint8)


def base_of(threshold):
    """Smallest magnitude of a coded value: a sample below it is a zero."""
    return max(threshold, 1)


def row_bytes_max(count, edge):
    """Bytes that the payload of ``count`` samples takes at most: 8.25 bits a sample and 4 bytes in edge mode."""
    return -(-(33 * count + 128) // 32) if edge else count


@njit(cache=True)
def _word(data, at):
    return np.int64(data[at]) << 8 | np.int64(data[at + 1])


@njit(cache=True)
def crc16_span(data, start, stop):
    """CRC-16 of data[start:stop], data a uint8 array."""
    crc = CRC16_START
    whole = start + (stop - start) // 4 * 4
    for i in range(start, whole, 4):
        crc ^= _word(data, i)
        crc = (
            CRC16_AFTER[3, crc >> 8]
            ^ CRC16_AFTER[2, crc & 0xFF]
            ^ CRC16_AFTER[1, data[i + 2]]
            ^ CRC16_AFTER[0, data[i + 3]]
        )
    for i in range(whole, stop):
        crc = (crc << 8 & 0xFFFF) ^ CRC16_AFTER[0, crc >> 8 ^ np.int64(data[i])]
    return crc


@njit(cache=True)
def code_sample(code, base, k, r2, run, credit):
    """One sample of edge mode: returns (bits, length 0..24, k, r2, run, credit).

    code: -128..127. base: see `base_of`. k, r2, run, credit: the coder's state, see `START`.
    A run that is still open at the end of a row is closed by one more 0 bit.
    """
    magnitude = abs(code)
    if run == 0 and (credit >> 2) + (r2 >> 1) < k + 17:
        literal = code & 0xFF if magnitude >= base else 0
        return literal, 8, k, r2, 0, min(credit + 1, CREDIT_MAX)
    if magnitude < base:
        run += 1
        if run < 1 << k:
            return 0, 0, k, r2, run, credit
        return 0, 1, min(k + 1, K_MAX), r2, 0, min(credit + 29, CREDIT_MAX)
    r = r2 >> 1
    value = magnitude - base + (1 << r)
    prefix = 0
    while value >> (r + 1 + prefix):
        prefix += 1
    length = 2 * prefix + r + 1
    sign = 1 if code < 0 else 0
    bits = ((1 << k | run) << 1 | sign) << length | value
    length += k + 2
    r2 = min(max(r2 + R2_STEP[prefix], 0), R2_MAX)
    return bits, length, max(k - 2, 0), r2, 0, min(credit + 33 - 4 * length, CREDIT_MAX)


@njit(cache=True)
def encode_row(codes, edge, base, out, at):
    """Append the payload of a row and return the position after it. codes: int16 (n,); out: uint8."""
    if not edge:
        for code in codes:
            out[at] = code & 0xFF
            at += 1
        return at
    k, r2, run, credit = START
    hold, held = 0, 0
    for code in codes:
        bits, length, k, r2, run, credit = code_sample(code, base, k, r2, run, credit)
        hold = hold << length | bits
        held += length
        while held >= 8:
            held -= 8
            out[at] = hold >> held & 0xFF
            at += 1
        hold &= (1 << held) - 1
    held += run > 0
    hold <<= run > 0
    if held:
        out[at] = hold << (8 - held) & 0xFF
        at += 1
    return at


@njit(cache=True)
def encode_rows(codes, rows, counts, edge, base, out):
    """Rows with their marks into out; returns the bytes written. codes: int16, row after row; rows, counts: int32."""
    at, first = 0, 0
    for i in range(rows.size):
        end = encode_row(codes[first : first + counts[i]], edge, base, out, at)
        mark = crc16_span(out, at, end) ^ rows[i]
        out[end], out[end + 1] = mark >> 8, mark & 0xFF
        at = end + 2
        first += counts[i]
    return at


@njit(cache=True)
def decode_row(data, at, stop, count, edge, base, where, value):
    """Decode ``count`` samples from data[at:stop]; returns (position after the payload, non-zero samples found).

    The position is -1 when no encoder writes these bits or they run past ``stop``. In edge mode the samples found
    are left in where (int32, index in the row, ascending) and value (int16), each of at least ``count`` elements;
    in the others they are the bytes themselves.
    """
    if not edge:
        return at + count if at + count <= stop else -1, 0
    k, r2, run, credit = START
    hold, held = np.uint64(0), 0  # the next bits, from the top
    here, found, i = at, 0, 0
    while i < count:
        if held < TOKEN_MAX and here + 4 <= stop:
            hold |= np.uint64(_word(data, here) << 16 | _word(data, here + 2)) << np.uint64(32 - held)
            here += 4
            held += 32
        while held < TOKEN_MAX and here < stop:
            hold |= np.uint64(data[here]) << np.uint64(56 - held)
            held += 8
            here += 1
        r = r2 >> 1
        if (credit >> 2) + r < k + 17:
            code = np.int64(hold >> np.uint64(56))
            code -= (code & 0x80) << 1
            length = 8
            credit = min(credit + 1, CREDIT_MAX)
            if code != 0:
                if abs(code) < base:
                    return -1, 0
                where[found] = i
                value[found] = code
                found += 1
            i += 1
        elif np.int64(hold) >= 0:
            length = 1
            i += 1 << k
            k = min(k + 1, K_MAX)
            credit = min(credit + 29, CREDIT_MAX)
        else:
            left = TOKEN_MAX - 2 - k
            token = np.int64(hold >> np.uint64(64 - TOKEN_MAX))
            i += token >> (left + 1) & ((1 << k) - 1)
            sign = -(token >> left & 1)
            token &= (1 << left) - 1
            prefix = PREFIX[token >> (left - 8)]
            size = 2 * prefix + r + 1
            magnitude = (token >> max(left - size, 0)) - (1 << r) + base
            if prefix > 7 - r or i >= count or magnitude > 127 - sign:
                return -1, 0
            where[found] = i
            value[found] = (magnitude ^ sign) - sign
            found += 1
            i += 1
            length = k + 2 + size
            k = max(k - 2, 0)
            r2 = min(max(r2 + R2_STEP[prefix], 0), R2_MAX)
            credit = min(credit + 33 - 4 * length, CREDIT_MAX)
        held -= length
        if held < 0:
            return -1, 0
        hold <<= np.uint64(length)
    here -= held >> 3
    pad = held & 7
    if pad and data[here - 1] & ((1 << pad) - 1):
        return -1, 0
    return here, found


@njit(cache=True)
def check_row(data, at, stop, count, edge, base, where, value):
    """Decode a row and its mark: returns (position after the mark, row index that the mark gives, samples found).

    The position is -1 when the payload or the mark does not fit in data[at:stop]. Only the caller
    knows whether the row index is the right one: it is a random number when the row is damaged.
    """
    end, found = decode_row(data, at, stop, count, edge, base, where, value)
    if end < 0 or end + 2 > stop:
        return -1, 0, 0
    return end + 2, crc16_span(data, at, end) ^ _word(data, end), found


@njit(cache=True)
def decode_rows(data, at, ordinal, rows, kind, places, start, edge, base, where, value, out, ends):
    """Decode rows into out (int16 (rows, cols * subs)) until one does not fit; ends: int64 (R,), where they end.

    Returns (its ordinal, or the number of rows; its position).
    """
    while ordinal < rows.size:
        first = start[kind[ordinal]]
        count = np.int64(start[kind[ordinal] + 1]) - first
        end, row, found = check_row(data, at, data.size, count, edge, base, where, value)
        if end < 0 or row != rows[ordinal]:
            break
        for i in range(found):
            out[row, places[first + where[i]]] = value[i]
        if not edge:
            for i in range(count):
                out[row, places[first + i]] = data[at + i]
        ends[ordinal] = at = end
        ordinal += 1
    return ordinal, at


@njit(cache=True)
def counts_fit(data, at, stop):
    """True when the trailer's counts and their mark lie at ``at``."""
    if at < 0 or at + _COUNTED > stop:
        return False
    return crc16_span(data, at, at + _COUNTS) ^ _word(data, at + _COUNTS) == TRAILER_ROW


@njit(cache=True)
def frame_ends(data, at, stop):
    """True when nothing or what looks like a header, one byte of its magic perhaps wrong, lies at ``at``."""
    if at >= stop:
        return True
    same = 0
    for i in range(min(_MAGIC.size, stop - at)):
        same += data[at + i] == _MAGIC[i]
    return same >= _MAGIC.size - 1


@njit(cache=True)
def row_fits(data, at, stop, ordinal, rows, counts, edge, base, where, value):
    """True when row number ``ordinal``, or the trailer after the last, lies at ``at``."""
    if ordinal == rows.size:
        return counts_fit(data, at, stop)
    end, row, _ = check_row(data, at, stop, np.int64(counts[ordinal]), edge, base, where, value)
    return end >= 0 and row == rows[ordinal]


@njit(cache=True)
def find_row(data, start, stop, limit, first, last, rows, counts, number, edge, base, where, value):
    """Search data[start:stop] for row number ``first`` to ``last`` of the frame (rows.size: the trailer).

    rows, counts: int32 (R,), index and samples of each row read. number: int32 (ROWS_MAX,), ordinal of a row
    index or -1. limit: samples that may be decoded on trial.
    Returns (position or -1, ordinal, samples left of the limit).
    """
    for at in range(start, stop):
        if last == rows.size and counts_fit(data, at, stop) and frame_ends(data, at + _TRAILER, stop):
            return at, rows.size, limit
        previous = -1
        for ordinal in range(first, min(last, rows.size - 1, first + 3) + 1):
            # rows of the same number of samples look alike until their mark; four numbers follow each other
            count = np.int64(counts[ordinal])
            if count == previous:
                continue
            previous = count
            limit -= count
            if limit < 0:
                return -1, 0, 0
            end, row, _ = check_row(data, at, stop, count, edge, base, where, value)
            if end < 0 or row >= number.size:
                continue
            found = number[row]
            if (
                first <= found <= last
                and counts[found] == count
                and row_fits(data, end, stop, found + 1, rows, counts, edge, base, where, value)
            ):
                return at, found, limit
    return -1, 0, limit


@njit(cache=True)
def one_byte_changes(syndrome, length, where, change):
    """Which changes of one of ``length`` bytes give a CRC-32 that differs by ``syndrome`` from the right one.

    Fills where and change (int64, as many as may be found), and returns how many were: the right one, if
    there is one, and one more for every 16 MB.
    """
    found = 0
    for position in range(length - 1, -1, -1):
        byte = CRC32_BACK[syndrome >> 24]
        syndrome = (syndrome ^ CRC32_TABLE[byte]) << 8 | byte
        if 0 < syndrome < 256 and found < where.size:
            where[found], change[found] = position, syndrome
            found += 1
    return found
