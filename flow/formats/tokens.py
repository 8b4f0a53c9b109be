"""Encoders of one segment's codes in each token format that is compared; all have the arguments of the first.

A run of zeros that is open at the end of the segment is coded, and no value follows.
"""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit
from talbot.models.digital.stream.payload import encode_segment

from .codes import Codes

Bytes = npt.NDArray[np.uint8]
Encoder = Callable[[Codes, int, Bytes], int]  # (codes of a segment, threshold's base, buffer) -> bytes written


@njit(cache=True)
def byte_pairs(codes: Codes, base: int, out: Bytes) -> int:
    """(zeros, value) in a byte each; 255 zeros alone are (255, 0). Returns the bytes written to out (uint8)."""
    at = run = 0
    for code in codes:
        if abs(code) < base:
            run += 1
        if abs(code) >= base or run == 255:
            out[at], out[at + 1] = run, (code & 0xFF if abs(code) >= base else 0)
            at += 2
            run = 0
    if run:
        out[at], out[at + 1] = run, 0
        at += 2
    return at


@njit(cache=True)
def _append(out: Bytes, at: int, bits: int, length: int) -> int:
    for i in range(length - 1, -1, -1):
        if at % 8 == 0:
            out[at // 8] = 0
        out[at // 8] |= (bits >> i & 1) << (7 - at % 8)
        at += 1
    return at


@njit(cache=True)
def nibbles(codes: Codes, base: int, out: Bytes) -> int:
    """Zeros (15: no value follows), then sign and distance 0..6 from the base, or sign, 7 and the code."""
    at = run = 0
    for code in codes:
        distance = abs(code) - base
        if distance < 0:
            run += 1
            if run == 15:
                at = _append(out, at, 15, 4)
                run = 0
            continue
        at = _append(out, at, run << 4 | (code < 0) << 3 | min(distance, 7), 8)
        if distance >= 7:
            at = _append(out, at, code & 0xFF, 8)
        run = 0
    if run:
        at = _append(out, at, run, 4)
    return -(-at // 8)


@njit(cache=True)
def _rice(codes: Codes, base: int, out: Bytes, k: int, r2: int, adaptive: bool) -> int:
    at = run = 0
    for code in codes:
        distance, r = abs(code) - base, r2 >> 1
        if distance < 0:
            run += 1
            if run == 1 << k:
                at = _append(out, at, 0, 1)
                run = 0
                k += adaptive and k < 7
            continue
        at = _append(out, at, (1 << k | run) << 1 | (code < 0), k + 2)
        quotient = distance >> r
        if quotient < 8:
            at = _append(out, at, ((1 << quotient) - 1) << 1, quotient + 1)
            at = _append(out, at, distance & ((1 << r) - 1), r)
        else:
            at = _append(out, at, 0xFF << 7 | distance, 15)
        run = 0
        if adaptive:
            k = max(k - 2, 0)
            if quotient == 0:
                r2 = max(r2 - 1, 0)
            elif quotient > 1:
                r2 = min(r2 + 1, 12)
    if run:
        at = _append(out, at, 0, 1)
    return -(-at // 8)


@njit(cache=True)
def fixed_rice(codes: Codes, base: int, out: Bytes) -> int:
    """0 for 16 zeros; or 1, four bits of zeros, sign, distance in a Rice code of r = 3 (8 ones: seven plain bits)."""
    return _rice(codes, base, out, 4, 6, False)


@njit(cache=True)
def adaptive_rice(codes: Codes, base: int, out: Bytes) -> int:
    """The same with 2**k zeros and r, both following the samples as in the stream's payload."""
    return _rice(codes, base, out, 3, 4, True)


def payload(codes: Codes, base: int, out: Bytes) -> int:
    """The stream's payload: adaptive runs or single samples, gamma codes, literals that bound its growth."""
    return encode_segment(codes, True, base, out)[0]


# name -> (encoder, its packer in rtl/run_length)
FORMATS: dict[str, tuple[Encoder, str]] = {
    "byte pairs": (byte_pairs, "BytePairPacker"),
    "nibbles": (nibbles, "NibblePacker"),
    "Golomb-Rice, fixed": (fixed_rice, "FixedRicePacker"),
    "Golomb-Rice, adaptive": (adaptive_rice, "AdaptiveRicePacker"),
    "adaptive run, Elias gamma": (payload, "PayloadPacker"),
}
CHOSEN = "adaptive run, Elias gamma"
