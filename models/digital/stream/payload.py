"""Rows as bytes: samples to bits and back, row after row (docs/stream.md, Payload).

`code_sample` is the coder: the packing around it, the hardware's cycle model and the decoder only move its bits.
All that Numba compiles is in this one file, since its cache on disk does not notice a change of a function in
another file that is inlined here.
"""

from typing import cast

import numpy as np
import numpy.typing as npt
from numba import njit

from talbot.models.parameters.stream_format import COUNTED_BYTES, COUNTS, MAGIC, TRAILER_BYTES, TRAILER_ROW

from .crc import CRC16_AFTER, CRC16_START, CRC32_BACK, CRC32_TABLE

START = (3, 4, 0, 128)  # k, r2, run, credit at the start of a row
K_MAX, R2_MAX, CREDIT_MAX = 7, 12, 255
TOKEN_MAX = 24  # bits of the longest token

# Change of r2 by the number of zeros before a value's leading one; that number by the value's top byte.
R2_STEP = np.array([-1, 0] + [1] * 7)
PREFIX = np.array([8 - byte.bit_length() for byte in range(256)])

_COUNTS, _COUNTED, _TRAILER = COUNTS.size, COUNTED_BYTES, TRAILER_BYTES
_MAGIC = np.frombuffer(MAGIC, np.uint8)

int64 = cast(type[int], np.int64)  # in compiled code int64 is the only integer
Bytes = npt.NDArray[np.uint8]
Ints = npt.NDArray[np.int32]
Codes = npt.NDArray[np.int16]
Places = npt.NDArray[np.int64]


def base_of(threshold: int) -> int:
    """Smallest magnitude of a coded value: a sample below it is a zero.

    Parameters
    ----------
    threshold : int
        0..127.

    Returns
    -------
    int
        1..127.
    """
    return max(threshold, 1)


def row_bytes_max(count: int, edge: bool) -> int:
    """Largest payload of a row: 8.25 bits a sample and 4 bytes in edge mode.

    Parameters
    ----------
    count : int
        Samples of the row.
    edge : bool
        Run-length coded signed codes; else plain bytes.

    Returns
    -------
    int
        Bytes.
    """
    return -(-(33 * count + 128) // 32) if edge else count


@njit(cache=True)
def _word(data: Bytes, at: int) -> int:
    return int64(data[at]) << 8 | int64(data[at + 1])


@njit(cache=True)
def crc16_span(data: Bytes, start: int, stop: int) -> int:
    """CRC-16 of data[start:stop].

    Parameters
    ----------
    data : uint8
        Bytes of the stream.
    start, stop : int
        Span.

    Returns
    -------
    int
        0..65535.
    """
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
        crc = (crc << 8 & 0xFFFF) ^ CRC16_AFTER[0, crc >> 8 ^ int64(data[i])]
    return crc


@njit(cache=True)
def code_sample(code: int, base: int, k: int, r2: int, run: int, credit: int) -> tuple[int, int, int, int, int, int]:
    """Encode one sample of edge mode.

    A run that is still open at the end of a row is closed by one more 0 bit.

    Parameters
    ----------
    code : int
        -128..127.
    base : int
        See `base_of`.
    k, r2, run, credit : int
        State of the coder, see `START`.

    Returns
    -------
    bits, length : int
        Token, 0..24 bits.
    k, r2, run, credit : int
        State after it.
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
def encode_row(codes: Codes, edge: bool, base: int, out: Bytes, at: int) -> int:
    """Append the payload of a row.

    Parameters
    ----------
    codes : int16 (n,)
        Samples in the order of the stream.
    edge : bool
        Run-length coded signed codes; else plain bytes.
    base : int
        See `base_of`.
    out : uint8
        Receives the bytes.
    at : int
        Position of the first byte.

    Returns
    -------
    int
        Position after the payload.
    """
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
def encode_rows(codes: Codes, rows: Ints, counts: Ints, edge: bool, base: int, out: Bytes) -> int:
    """Encode rows with their marks.

    Parameters
    ----------
    codes : int16 (n,)
        Samples in the order of the stream, row after row.
    rows, counts : int32 (R,)
        Index and samples of each row.
    edge : bool
        Run-length coded signed codes; else plain bytes.
    base : int
        See `base_of`.
    out : uint8
        Receives the bytes.

    Returns
    -------
    int
        Bytes written.
    """
    at, first = 0, 0
    for i in range(rows.size):
        end = encode_row(codes[first : first + counts[i]], edge, base, out, at)
        mark = crc16_span(out, at, end) ^ rows[i]
        out[end], out[end + 1] = mark >> 8, mark & 0xFF
        at = end + 2
        first += counts[i]
    return at


@njit(cache=True)
def decode_row(
    data: Bytes, at: int, stop: int, count: int, edge: bool, base: int, where: Ints, value: Codes
) -> tuple[int, int]:
    """Decode the payload of a row from data[at:stop].

    Parameters
    ----------
    data : uint8
        Bytes of the stream.
    at, stop : int
        Span.
    count : int
        Samples of the row.
    edge : bool
        Run-length coded signed codes; else plain bytes, which are the samples themselves.
    base : int
        See `base_of`.
    where : int32 (count or more,)
        Receives the index in the row of each non-zero sample of edge mode, ascending.
    value : int16 (count or more,)
        Receives these samples.

    Returns
    -------
    end : int
        Position after the payload; -1 when no encoder writes these bits or they run past ``stop``.
    found : int
        Non-zero samples of edge mode.
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
            code = int64(hold >> np.uint64(56))
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
        elif int64(hold) >= 0:
            length = 1
            i += 1 << k
            k = min(k + 1, K_MAX)
            credit = min(credit + 29, CREDIT_MAX)
        else:
            left = TOKEN_MAX - 2 - k
            token = int64(hold >> np.uint64(64 - TOKEN_MAX))
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
def check_row(
    data: Bytes, at: int, stop: int, count: int, edge: bool, base: int, where: Ints, value: Codes
) -> tuple[int, int, int]:
    """Decode a row and its mark from data[at:stop].

    Parameters
    ----------
    data, at, stop, count, edge, base, where, value
        As in `decode_row`.

    Returns
    -------
    end : int
        Position after the mark; -1 when the payload or the mark does not fit.
    row : int
        Row index of the mark; a random number when the row is damaged.
    found : int
        Non-zero samples of edge mode.
    """
    end, found = decode_row(data, at, stop, count, edge, base, where, value)
    if end < 0 or end + 2 > stop:
        return -1, 0, 0
    return end + 2, crc16_span(data, at, end) ^ _word(data, end), found


@njit(cache=True)
def decode_rows(
    data: Bytes,
    at: int,
    ordinal: int,
    rows: Ints,
    kind: Ints,
    places: Ints,
    start: Ints,
    edge: bool,
    base: int,
    where: Ints,
    value: Codes,
    out: Codes,
    ends: Places,
) -> tuple[int, int]:
    """Decode rows until one does not fit.

    Parameters
    ----------
    data : uint8
        Bytes of the stream.
    at, ordinal : int
        Position and number of the first row.
    rows, kind, places, start
        As in Layout.
    edge, base, where, value
        As in `decode_row`.
    out : int16 (rows, cols * subs)
        Receives the samples.
    ends : int64 (R,)
        Receives the end of each row.

    Returns
    -------
    ordinal : int
        Number of the row that does not fit, or the number of rows.
    at : int
        Its position.
    """
    while ordinal < rows.size:
        first = int64(start[kind[ordinal]])
        count = int64(start[kind[ordinal] + 1]) - first
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
def counts_fit(data: Bytes, at: int, stop: int) -> bool:
    """Whether the trailer's counts and their mark are at a position.

    Parameters
    ----------
    data : uint8
        Bytes of the stream.
    at, stop : int
        Position, and end of the bytes.

    Returns
    -------
    bool
        True if they fit.
    """
    if at < 0 or at + _COUNTED > stop:
        return False
    return crc16_span(data, at, at + _COUNTS) ^ _word(data, at + _COUNTS) == TRAILER_ROW


@njit(cache=True)
def frame_ends(data: Bytes, at: int, stop: int) -> bool:
    """Whether the bytes end at a position, or a header seems to start there.

    Parameters
    ----------
    data : uint8
        Bytes of the stream.
    at, stop : int
        Position, and end of the bytes.

    Returns
    -------
    bool
        True if so; one byte of the header's magic may be wrong.
    """
    if at >= stop:
        return True
    same = 0
    for i in range(min(_MAGIC.size, stop - at)):
        same += data[at + i] == _MAGIC[i]
    return same >= _MAGIC.size - 1


@njit(cache=True)
def row_fits(
    data: Bytes,
    at: int,
    stop: int,
    ordinal: int,
    rows: Ints,
    counts: Ints,
    edge: bool,
    base: int,
    where: Ints,
    value: Codes,
) -> bool:
    """Whether a row, or the trailer after the last, is at a position.

    Parameters
    ----------
    data : uint8
        Bytes of the stream.
    at, stop : int
        Position, and end of the bytes.
    ordinal : int
        Number of the row; the number of rows is the trailer.
    rows, counts : int32 (R,)
        Index and samples of each row.
    edge, base, where, value
        As in `decode_row`.

    Returns
    -------
    bool
        True if payload and mark fit.
    """
    if ordinal == rows.size:
        return counts_fit(data, at, stop)
    end, row, _ = check_row(data, at, stop, int64(counts[ordinal]), edge, base, where, value)
    return end >= 0 and row == rows[ordinal]


@njit(cache=True)
def find_row(
    data: Bytes,
    start: int,
    stop: int,
    limit: int,
    first: int,
    last: int,
    rows: Ints,
    counts: Ints,
    number: Ints,
    edge: bool,
    base: int,
    where: Ints,
    value: Codes,
) -> tuple[int, int, int]:
    """Search data[start:stop] for one of some rows.

    Parameters
    ----------
    data : uint8
        Bytes of the stream.
    start, stop : int
        Span.
    limit : int
        Samples that may be decoded on trial.
    first, last : int
        Numbers of the rows, both included; the number of rows is the trailer.
    rows, counts : int32 (R,)
        Index and samples of each row.
    number : int32 (ROWS_MAX,)
        Number of a row index, or -1.
    edge, base, where, value
        As in `decode_row`.

    Returns
    -------
    at : int
        Position, or -1.
    ordinal : int
        Number of the row there.
    limit : int
        Samples that may still be decoded on trial.
    """
    for at in range(start, stop):
        if last == rows.size and counts_fit(data, at, stop) and frame_ends(data, at + _TRAILER, stop):
            return at, rows.size, limit
        previous = -1
        for ordinal in range(first, min(last, rows.size - 1, first + 3) + 1):
            # rows of the same number of samples look alike until their mark; four numbers follow each other
            count = int64(counts[ordinal])
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
def one_byte_changes(syndrome: int, length: int, where: Places, change: Places) -> int:
    """Changes of one byte that explain a CRC-32: the right one, if there is one, and one more for every 16 MB.

    Parameters
    ----------
    syndrome : int
        (computed CRC) xor (received CRC).
    length : int
        Bytes that the CRC covers.
    where, change : int64 (n,)
        Receive position and change of up to n candidates.

    Returns
    -------
    int
        Number of candidates.
    """
    found = 0
    for position in range(length - 1, -1, -1):
        byte = CRC32_BACK[syndrome >> 24]
        syndrome = (syndrome ^ CRC32_TABLE[byte]) << 8 | byte
        if 0 < syndrome < 256 and found < where.size:
            where[found], change[found] = position, syndrome
            found += 1
    return found
