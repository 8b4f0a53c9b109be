"""Whole frames computed on paper from docs/stream.md; both checks by the standard library."""

import binascii
import zlib

import pytest

from talbot.models.digital.stream import StreamHeader, encode_frame
from talbot.models.parameters import AmpTiming, FrameParameters, Window
from talbot.rtl.harness.testbench import build
from talbot.rtl.messages import ScanMsg
from talbot.rtl.run_length import RunLength, RunLengthFL

FRAME, ROW, SAMPLE, END = 0, 1, 2, 3  # docs/chip.md, Messages
CHIP = 12, 36, 4, 4, 6  # rows, cols, lanes, tile
PORTS = dict(row0=1, row1=2, col0=3, col1=4, mask=0x123456, threshold=10, frame_number=0x0102, exposure=0x0304)
PORTS |= dict(n_cm=5, t_int=0x0607, calibration=8, decimation=1)


def header(flags):
    """The 28 bytes before the CRC-32; flags: resync, decimation, ternary, phase, mode."""
    return (
        b"TLBT"
        + bytes([3, flags, 10, 4, 0x46])  # version, flags, threshold, lanes, tile
        + bytes([0, 12, 0, 36, 1, 2, 3, 4])  # rows, cols, window
        + bytes([0x12, 0x34, 0x56, 1, 2, 3, 4, 5, 6, 7, 8])  # mask, frame number, exposure, n_cm, t_int, calibration
    )


def frame(head, segments, made, left_out):
    """The bytes of a frame; segments: (first row, payload)."""
    body = b"".join(payload + mark(payload, row) for row, payload in segments)
    counts = made.to_bytes(4, "big") + left_out.to_bytes(4, "big")
    counted = counts + mark(counts, 0xFFFF)
    check = zlib.crc32(head + body + counted)
    return head + zlib.crc32(head).to_bytes(4, "big") + body + counted + check.to_bytes(4, "big")


def mark(payload, row):
    return (binascii.crc_hqx(payload, 0xFFFF) ^ row).to_bytes(2, "big")


def scan(rows):
    out = [(FRAME, 0)]
    for row, codes in rows:
        out += [(ROW, row), *((SAMPLE, code & 0xFF) for code in codes)]
    return [*out, (END, 0)]


# A segment of rows 5 and 6 with threshold 10. It begins with k = 16, r2 = 2, credit = 128:
#   credit / 4 = 32 >= q + 16 = 20; q = 4; 3 zeros, then 12: `1`, 3 in 3 bits, the value of x = 2 (12 - 10) + 1 = 5
#     r = 2; 5 >= 4, so p = floor(log2 5) - 2 + 1 = 1: a zero bit, then 101           1 011 0101
#   k = 8, r2 = 2 (p = 1), credit = 128 + 33 - 32 = 129
#   q = 2; no zero, then -10: `1`, 0 in 1 bit, the value of x = 0: `1`, 00            1 0 100
#   k = 4 (at least), r2 = 1 (p = 0), credit = 129 + 33 - 20 = 142
#   q = 1; 1 zero of row 6                                                           0
#   k = 8; q = 2; the last zero: only zeros up to the segment's end                  0
# 1011 0101 1010 000, and a zero bit of padding.
EDGE = dict(mode=0, phase=0, resync=2), 0x90, [(5, [0, 0, 0, 12, -10]), (6, [0, 0])], [(5, bytes([0xB5, 0xA0]))]
# The same places of ternary mode: each value is its sign in a bit, and the order falls by 2, to 1 at least:
#   1 011 1, then 1 0 0, 0 and 0; six zero bits of padding.
TERNARY = dict(mode=4, phase=0, resync=2), 0x98, [(5, [0, 0, 0, 1, -1]), (6, [0, 0])], [(5, bytes([0xBC, 0x00]))]
# Threshold 10; the credit of literals never ends here. Raw: plain bytes, a mark after 64 of them: rows of 32.
RAW_ROWS = [(row, list(range(row, row + 32))) for row in (1, 2, 3)]
RAW = (
    dict(mode=2, phase=0, resync=1),
    0x52,
    RAW_ROWS,
    [(1, bytes(range(1, 33)) + bytes(range(2, 34))), (3, bytes(range(3, 35)))],
)
IMAGE = dict(mode=1, phase=0, resync=0), 0x11, [(9, [7]), (10, [255, 0])], [(9, b"\x07"), (10, b"\xff\x00")]
TOF = dict(mode=3, phase=1, resync=3), 0xD7, [(9, [7]), (10, [255, 0])], [(9, b"\x07\xff\x00")]


@pytest.mark.parametrize("verilog", [False, True], ids=["FL", "Verilog"])
@pytest.mark.parametrize("kind", [EDGE, TERNARY, RAW, IMAGE, TOF], ids=["edge", "ternary", "raw", "image", "tof"])
def test_the_bytes_of_a_frame(verilog, kind):
    ports, flags, rows, segments = kind
    sim = build(RunLength(*CHIP), True, "RunLength") if verilog else build(RunLengthFL(*CHIP))
    for name, value in (PORTS | ports | {"made": 0x01020304, "left_out": 0x0A0B0C0D}).items():
        port = getattr(sim, name)
        port @= value
    messages, out = scan(rows), bytearray()
    sim.send.rdy @= 1
    for _ in range(1000):
        sim.recv.val @= bool(messages)
        if messages:
            sim.recv.msg @= ScanMsg(*messages[0])
        sim.sim_eval_combinational()
        if sim.send.val:
            out.append(int(sim.send.msg))
        if messages and sim.recv.rdy:
            messages.pop(0)
        sim.sim_tick()
    assert out == frame(header(flags), segments, 0x01020304, 0x0A0B0C0D)


def test_the_header_of_the_golden_encoder():
    """The fields by their names, of a frame of two tiles' first type."""
    parameters = FrameParameters(
        Window(0, 0, 0, 1),
        "raw",
        mask=1,
        threshold=9,
        frame_number=0x0A0B,
        resync=3,
        calibration=77,
        timing=AmpTiming(t_int=0x1234, n_cm=3, exposure=0x0156),
    )
    sent = encode_frame(StreamHeader.from_frame(4, 12, 1, parameters), [[[i, i + 1] for i in range(12)]] * 4, 4, 0)
    head = b"TLBT" + bytes.fromhex("03 c2 09 01 46 0004 000c 00 00 00 01 000001 0a0b 0156 03 1234 4d")
    # Type 0 is at the tile's first pixel: columns 0 and 6 of row 0, two diodes each.
    assert sent == frame(head, [(0, bytes([0, 1, 6, 7]))], 4, 0)
