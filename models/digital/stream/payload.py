"""Segments of rows as bytes: samples to bits and back (docs/stream.md, Payload).

`code_sample` is the coder: the packing around it, the hardware's cycle model and the decoder only move its bits.
All that Numba compiles is in this one file, since its cache on disk does not notice a change of a function in
another file that is inlined here.
"""

from typing import cast

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit
from talbot.models.digital.stream.crc import CRC16_AFTER, CRC16_START, CRC32_BACK, CRC32_TABLE
from talbot.models.parameters.stream_format import COUNTED_BYTES, COUNTS, MAGIC, TRAILER_BYTES, TRAILER_ROW

DENSE = 4  # a smaller threshold is under the noise, where a zero is about as frequent as the values next to it
K_MAX, R2_MAX, CREDIT_MAX = 48, 7, 255
TOKEN_MAX = 27  # bits of the longest token

# Change of r2 by the number of zeros before a value; that number by the value's top byte.
R2_STEP = np.array([-1, 0] + [1] * 7)
PREFIX = np.array([8 - byte.bit_length() for byte in range(256)])

_COUNTS, _COUNTED, _TRAILER = COUNTS.size, COUNTED_BYTES, TRAILER_BYTES
_MAGIC = np.frombuffer(MAGIC, np.uint8)

int64 = cast(type[int], np.int64)  # in compiled code int64 is the only integer
Bytes = npt.NDArray[np.uint8]
Ints = npt.NDArray[np.int32]
Codes = npt.NDArray[np.int16]
Places = npt.NDArray[np.int64]


def base_of(mode: str, threshold: int) -> int:
    """Smallest magnitude of a coded value: a sample below it is a zero.

    mode: one of MODES. threshold: 0..127. Returns 1..127; 0 in ternary mode, which codes the sign alone.
    """
    return 0 if mode == "ternary" else max(threshold, 1)


def row_bytes_max(count: int, edge: bool) -> int:
    """Largest payload of a segment: 8.25 bits a sample and 4 bytes where coded.

    count: samples of the segment. edge: run-length coded signed codes; else plain bytes. Returns bytes.
    """
    return -(-(33 * count + 128) // 32) if edge else count


@njit(cache=True)
def _word(data: Bytes, at: int) -> int:
    return int64(data[at]) << 8 | int64(data[at + 1])


@njit(cache=True)
def crc16_span(data: Bytes, start: int, stop: int) -> int:
    """CRC-16 of data[start:stop].

    data: bytes of the stream. start, stop: span. Returns 0..65535.
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
def start(base: int) -> tuple[int, int, int, int]:
    """State of the coder at the start of a segment.

    base: see `base_of`. Returns k, r2, run, credit: see docs/stream.md, Payload.
    """
    return 8 if 0 < base < DENSE else 16, 2, 0, 128


@njit(cache=True)
def _stepped(k: int, zeros: bool, base: int) -> int:
    """State k after a token of zeros alone, or of a value."""
    if zeros:
        return k if k >= K_MAX else k + (1 if 0 < base < DENSE else 4)
    return max(k - 1, 0) if 0 < base < DENSE else max(k - 8, 4)


@njit(cache=True)
def code_sample(code: int, base: int, k: int, r2: int, run: int, credit: int) -> tuple[int, int, int, int, int, int]:
    """Encode one sample of edge or ternary mode.

    A run that is still open at the end of a segment is closed by one more 0 bit.

    code: -128..127. base: see `base_of`. k, r2, run, credit: state of the coder, see `start`. Returns bits, length
    (token, 0..27 bits), k, r2, run, credit (state after it).
    """
    q, magnitude = k >> 2, abs(code)
    zero = magnitude < max(base, 1)
    if base and run == 0 and credit >> 2 < q + 16:
        return 0 if zero else code & 0xFF, 8, k, r2, 0, min(credit + 1, CREDIT_MAX)
    if zero and q:
        run += 1
        if run < 1 << q >> 1:
            return 0, 0, k, r2, run, credit
        return 0, 1, _stepped(k, True, base), r2, 0, min(credit + 29, CREDIT_MAX)
    if base == 0:
        return (1 << q >> 1 | run) << 1 | (code > 0), q + 1, _stepped(k, False, base), r2, 0, credit
    value = 0 if zero else 2 * (magnitude - base) + (code > 0) + (q == 0)
    order, prefix = (r2 >> 1) + 1, 0
    while value >> (order + prefix):
        prefix += 1
    length = order + max(2 * prefix, 1)
    bits = (1 << q >> 1 | run) << length | (prefix == 0) << order | value
    length += q
    r2 = min(max(r2 + R2_STEP[prefix], 0), R2_MAX)
    return bits, length, _stepped(k, zero, base), r2, 0, min(credit + 33 - 4 * length, CREDIT_MAX)


@njit(cache=True)
def _append(
    codes: Codes, edge: bool, base: int, out: Bytes, at: int, state: tuple[int, int, int, int, int, int]
) -> tuple[int, tuple[int, int, int, int, int, int]]:
    """Append whole bytes of a row. state: of the coder, then the bits that wait and their number."""
    k, r2, run, credit, hold, held = state
    if not edge:
        for code in codes:
            out[at] = code & 0xFF
            at += 1
        return at, state
    for code in codes:
        bits, length, k, r2, run, credit = code_sample(code, base, k, r2, run, credit)
        hold = hold << length | bits
        held += length
        while held >= 8:
            held -= 8
            out[at] = hold >> held & 0xFF
            at += 1
        hold &= (1 << held) - 1
    return at, (k, r2, run, credit, hold, held)


@njit(cache=True)
def _close(out: Bytes, at: int, state: tuple[int, int, int, int, int, int]) -> int:
    """Append the rest of a segment."""
    _, _, run, _, hold, held = state
    held += run > 0
    hold <<= run > 0
    if held:
        out[at] = hold << (8 - held) & 0xFF
        at += 1
    return at


@njit(cache=True)
def _fresh(base: int) -> tuple[int, int, int, int, int, int]:
    return (*start(base), 0, 0)


@njit(cache=True)
def encode_segment(codes: Codes, edge: bool, base: int, out: Bytes) -> tuple[int, int]:
    """Payload of a segment.

    codes: (n,), samples in the order of the stream, of all its rows. edge: run-length coded signed codes; else plain
    bytes. base: see `base_of`. out: receives the bytes. Returns end (bytes of the payload), whole (those that are
    complete before the segment is closed).
    """
    whole, state = _append(codes, edge, base, out, 0, _fresh(base))
    return _close(out, whole, state), whole


@njit(cache=True)
def encode_rows(codes: Codes, rows: Ints, counts: Ints, edge: bool, base: int, segment: int, out: Bytes) -> int:
    """Encode rows with their marks.

    codes: (n,), samples in the order of the stream, row after row. rows, counts: (R,), index and samples of each row.
    edge: run-length coded signed codes; else plain bytes. base: see `base_of`. segment: bytes of payload after which a
    row is a segment's last. out: receives the bytes. Returns bytes written.
    """
    at, begin = int64(0), int64(0)  # of a plain 0 Numba would compile `_append` and `crc16_span` once more
    first, row, state = 0, 0, _fresh(base)
    for i in range(rows.size):
        at, state = _append(codes[first : first + counts[i]], edge, base, out, at, state)
        first += counts[i]
        if at - begin >= segment or i == rows.size - 1:
            at = _close(out, at, state)
            mark = crc16_span(out, begin, at) ^ rows[row]
            out[at], out[at + 1] = mark >> 8, mark & 0xFF
            at += 2
            begin, row, state = at, i + 1, _fresh(base)
    return at


@njit(cache=True)
def decode_segment(
    data: Bytes,
    at: int,
    stop: int,
    ordinal: int,
    counts: Ints,
    edge: bool,
    base: int,
    segment: int,
    where: Ints,
    value: Codes,
) -> tuple[int, int, int, int]:
    """Decode the payload of a segment from data[at:stop].

    data: bytes of the stream. at, stop: span. ordinal: number of the segment's first row. counts: (R,), samples of each
    row. edge: run-length coded signed codes; else plain bytes, which are the samples themselves. base: see `base_of`.
    segment: bytes of payload after which a row is the last. where: (samples of the frame or more,), receives the index
    in the segment of each non-zero coded sample, ascending. value: (as many,), receives these samples. Returns end
    (position after the payload; -1 when no encoder writes these bits or they run past ``stop``), rows (rows of the
    segment), found (non-zero coded samples), work (tokens, or rows of plain bytes, that were decoded).
    """
    row, row_end = ordinal, int64(counts[ordinal])
    if not edge:
        while row_end < segment and row < counts.size - 1:
            row += 1
            row_end += counts[row]
        end = at + row_end
        return end if end <= stop else -1, row + 1 - ordinal, 0, row + 1 - ordinal
    k, r2, _, credit = start(base)
    hold, held = np.uint64(0), 0  # the next bits, from the top
    here, decoded, i, work, frame_end = at, 0, 0, 0, int64(0)
    for count in counts[ordinal:]:
        frame_end += count
    while True:
        full = (8 * (here - at) - held) >> 3 >= segment
        while row < counts.size and row_end == i:
            row += 1
            if full or row == counts.size:
                here -= held >> 3
                pad = held & 7
                if pad and data[here - 1] & ((1 << pad) - 1):
                    return -1, 0, 0, work
                return here, row - ordinal, decoded, work
            row_end += counts[row]
        top = row_end if full else frame_end  # a run ends here at the latest
        work += 1
        if held < TOKEN_MAX and here + 4 <= stop:
            hold |= np.uint64(_word(data, here) << 16 | _word(data, here + 2)) << np.uint64(32 - held)
            here += 4
            held += 32
        while held < TOKEN_MAX and here < stop:
            hold |= np.uint64(data[here]) << np.uint64(56 - held)
            held += 8
            here += 1
        q = k >> 2
        if base and credit >> 2 < q + 16:
            code = int64(hold >> np.uint64(56))
            code -= (code & 0x80) << 1
            length = 8
            credit = min(credit + 1, CREDIT_MAX)
        elif q and int64(hold) >= 0:
            code, length = 0, 1
            i = min(i + (1 << q >> 1), top) - 1
            k = _stepped(k, True, base)
            credit = min(credit + 29, CREDIT_MAX)
        elif base == 0:
            token = int64(hold >> np.uint64(63 - q))
            i += token >> 1 & ((1 << q >> 1) - 1)
            if i >= top:
                return -1, 0, 0, work
            code, length = 2 * (token & 1) - 1, q + 1
            k = _stepped(k, False, base)
        else:
            left = TOKEN_MAX - q
            token = int64(hold >> np.uint64(64 - TOKEN_MAX))
            i += token >> left & ((1 << q >> 1) - 1)
            token &= (1 << left) - 1
            order, prefix = (r2 >> 1) + 1, PREFIX[token >> (left - 8)]
            size = order + max(2 * prefix, 1)
            index = (token >> max(left - size, 0)) - ((prefix == 0) << order) + (q > 0)
            code = ((index + 1) >> 1) + base - 1
            if prefix > 8 - order or i >= top or code > 127 + (index & 1):
                return -1, 0, 0, work
            code = 0 if index == 0 else -code if index & 1 else code
            length = q + size
            k = _stepped(k, index == 0, base)
            r2 = min(max(r2 + R2_STEP[prefix], 0), R2_MAX)
            credit = min(credit + 33 - 4 * length, CREDIT_MAX)
        if code != 0:
            if abs(code) < base:
                return -1, 0, 0, work
            where[decoded] = i
            value[decoded] = code
            decoded += 1
        i += 1
        held -= length
        if held < 0:
            return -1, 0, 0, work
        hold <<= np.uint64(length)
        while row_end < i:  # rows that end within the token
            row += 1
            row_end += counts[row]


@njit(cache=True)
def check_segment(
    data: Bytes,
    at: int,
    stop: int,
    ordinal: int,
    counts: Ints,
    edge: bool,
    base: int,
    segment: int,
    where: Ints,
    value: Codes,
) -> tuple[int, int, int, int, int]:
    """Decode a segment and its mark from data[at:stop].

    data, at, stop, ordinal, counts, edge, base, segment, where, value: as in `decode_segment`. Returns end (position
    after the mark; -1 when the payload or the mark does not fit), row (row index of the mark; a random number when the
    segment is damaged), rows, found, work (as in `decode_segment`).
    """
    end, rows, decoded, work = decode_segment(data, at, stop, ordinal, counts, edge, base, segment, where, value)
    if end < 0 or end + 2 > stop:
        return -1, 0, 0, 0, work
    return end + 2, crc16_span(data, at, end) ^ _word(data, end), rows, decoded, work


@njit(cache=True)
def decode_rows(
    data: Bytes,
    at: int,
    ordinal: int,
    rows: Ints,
    counts: Ints,
    kind: Ints,
    places: Ints,
    start: Ints,
    edge: bool,
    base: int,
    segment: int,
    where: Ints,
    value: Codes,
    out: Codes,
    ends: Places,
) -> tuple[int, int]:
    """Decode segments until one does not fit.

    data: bytes of the stream. at, ordinal: position of the first segment, and the number of its first row. rows,
    counts, kind, places, start: as in Layout. edge, base, segment, where, value: as in `decode_segment`. out: (rows,
    cols * subs), receives the samples. ends: (R,), receives the end of the segment of each row. Returns ordinal (number
    of the first row of the segment that does not fit, or the number of rows), at (its position).
    """
    while ordinal < rows.size:
        end, row, many, decoded, _ = check_segment(
            data, at, data.size, ordinal, counts, edge, base, segment, where, value
        )
        if end < 0 or row != rows[ordinal]:
            break
        first, n = 0, 0
        for this in range(ordinal, ordinal + many):
            place = int64(start[kind[this]])
            while n < decoded and where[n] < first + counts[this]:
                out[rows[this], places[place + where[n] - first]] = value[n]
                n += 1
            if not edge:
                for i in range(counts[this]):
                    out[rows[this], places[place + i]] = data[at + first + i]
            first += counts[this]
            ends[this] = end
        at = end
        ordinal += many
    return ordinal, at


@njit(cache=True)
def counts_fit(data: Bytes, at: int, stop: int) -> bool:
    """Return whether the trailer's counts and their mark are at a position.

    data: bytes of the stream. at, stop: position, and end of the bytes. Returns True if they fit.
    """
    if at < 0 or at + _COUNTED > stop:
        return False
    return crc16_span(data, at, at + _COUNTS) ^ _word(data, at + _COUNTS) == TRAILER_ROW


@njit(cache=True)
def frame_ends(data: Bytes, at: int, stop: int) -> bool:
    """Return whether the bytes end at a position, or a header seems to start there.

    data: bytes of the stream. at, stop: position, and end of the bytes. Returns True if so; one byte of the header's
    magic may be wrong.
    """
    if at >= stop:
        return True
    same = 0
    for i in range(min(_MAGIC.size, stop - at)):
        same += data[at + i] == _MAGIC[i]
    return same >= _MAGIC.size - 1


@njit(cache=True)
def segment_fits(
    data: Bytes,
    at: int,
    stop: int,
    ordinal: int,
    rows: Ints,
    counts: Ints,
    edge: bool,
    base: int,
    segment: int,
    where: Ints,
    value: Codes,
) -> bool:
    """Return whether a segment, or the trailer after the last, is at a position.

    data: bytes of the stream. at, stop: position, and end of the bytes. ordinal: number of its first row; the number of
    rows is the trailer. rows, counts: (R,), index and samples of each row. edge, base, segment, where, value: as in
    `decode_segment`. Returns True if payload and mark fit.
    """
    if ordinal == rows.size:
        return counts_fit(data, at, stop)
    end, row, _, _, _ = check_segment(data, at, stop, ordinal, counts, edge, base, segment, where, value)
    return end >= 0 and row == rows[ordinal]


@njit(cache=True)
def find_segment(
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
    segment: int,
    where: Ints,
    value: Codes,
) -> tuple[int, int, int]:
    """Search data[start:stop] for the start of one of some segments.

    data: bytes of the stream. start, stop: span. limit: tokens that may be decoded on trial. first, last: numbers of
    the rows that it may begin with, both included; the number of rows is the trailer. rows, counts: (R,), index and
    samples of each row. number: (ROWS_MAX,), number of a row index, or -1. edge, base, segment, where, value: as in
    `decode_segment`. Returns at (position, or -1), ordinal (number of the first row there), limit (tokens that may
    still be decoded on trial).
    """
    for at in range(start, stop):
        if last == rows.size and counts_fit(data, at, stop) and frame_ends(data, at + _TRAILER, stop):
            return _last_segment(data, start, at, limit, first, rows, counts, number, edge, base, segment, where, value)
        # of four rows that follow each other one has the samples of any other, and of the rows after it
        for ordinal in range(first, min(last, rows.size - 1, first + 3) + 1):
            end, row, _, _, work = check_segment(data, at, stop, ordinal, counts, edge, base, segment, where, value)
            limit -= work
            if limit < 0:
                return -1, 0, 0
            if end < 0 or row >= number.size:
                continue
            row_number = int(number[row])
            if not first <= row_number <= last:
                continue
            end, same, many, _, work = check_segment(
                data, at, stop, row_number, counts, edge, base, segment, where, value
            )
            limit -= work
            if (
                end >= 0
                and same == row
                and segment_fits(data, end, stop, row_number + many, rows, counts, edge, base, segment, where, value)
            ):
                return at, row_number, limit
    return -1, 0, limit


@njit(cache=True)
def _last_segment(
    data: Bytes,
    start: int,
    stop: int,
    limit: int,
    first: int,
    rows: Ints,
    counts: Ints,
    number: Ints,
    edge: bool,
    base: int,
    segment: int,
    where: Ints,
    value: Codes,
) -> tuple[int, int, int]:
    """The segment that the frame's end cuts off, right before the trailer at ``stop``; the trailer if there is none."""
    for at in range(start, stop - 1):
        limit -= stop - at
        if limit < 0:
            break
        row = crc16_span(data, at, stop - 2) ^ _word(data, stop - 2)
        row_number = int(number[row]) if row < number.size else -1
        if row_number >= first:
            end, _, many, _, _ = check_segment(data, at, stop, row_number, counts, edge, base, segment, where, value)
            if end == stop and row_number + many == rows.size:
                return at, row_number, limit
    return stop, rows.size, limit


@njit(cache=True)
def one_byte_changes(syndrome: int, length: int, where: Places, change: Places) -> int:
    """Changes of one byte that explain a CRC-32: the right one, if there is one, and one more for every 16 MB.

    syndrome: (computed CRC) xor (received CRC). length: bytes that the CRC covers. where, change: (n,), receive
    position and change of up to n candidates. Returns number of candidates.
    """
    changes = 0
    for position in range(length - 1, -1, -1):
        byte = CRC32_BACK[syndrome >> 24]
        syndrome = (syndrome ^ CRC32_TABLE[byte]) << 8 | byte
        if 0 < syndrome < 256 and changes < where.size:
            where[changes], change[changes] = position, syndrome
            changes += 1
    return changes
