"""Any one wrong byte of a real frame loses at most one row: tried at every position of a frame of every mode."""

from dataclasses import dataclass

import numpy as np

from flow.frame import job
from flow.frame.request import request
from models.chip import golden_frame
from models.digital.stream import decode_stream
from models.parameters import MODES
from models.parameters.stream_format import HEADER_BYTES, TRAILER_BYTES

FRAMES = {**{mode: (mode, False) for mode in MODES}, "phase": ("tof", True)}
SIZES = {"edge": (96, 144)}  # rows, cols of the array that sees the default scene
SIZE = 24, 36  # ... in the other modes, whose rows are plain bytes
AROUND = "alone", "between frames", "bytes behind"  # what lies around the frame


@dataclass(frozen=True, eq=False)
class Real:
    """data: the frame's bytes. samples: what they say, (rows, cols, subs)."""

    data: bytes
    samples: np.ndarray


def real_frame(name, size=None):
    """A frame of the default scene through the golden chip: Real. name: of FRAMES. size: rows, cols."""
    mode, phase = FRAMES[name]
    rows, cols = size or SIZES.get(name, SIZE)
    asked = request(rows=rows, cols=cols, mode=mode, phase=phase)
    scene, todo = job.see(asked)
    exposed = job.expose(asked, scene, todo)
    golden = golden_frame(exposed.samples, asked.sensor, asked.frame, exposed.front_end)
    return Real(golden.stream, golden.sent)


def changes(count, seed):
    """``count`` ways to change a byte (xor, 1..255): each single bit first, then all bits, then any: list."""
    some = [1 << bit for bit in range(8)] + [0xFF]
    rest = [c for c in np.random.default_rng(seed).permutation(np.arange(1, 256)).tolist() if c not in some]
    return (some + rest)[:count]


def check_position(frame, position, change, around):
    """Decode the frame with one byte changed; returns rows lost, 0 or 1. Raises AssertionError, naming the byte."""
    data = bytearray(frame.data)
    data[position] ^= change
    before = len(frame.data) if around == "between frames" else 0
    behind = {"alone": b"", "between frames": frame.data, "bytes behind": bytes(TRAILER_BYTES + 6)}[around]
    frames = decode_stream(frame.data[:before] + bytes(data) + behind)
    where = f"byte {position} xor {change:#04x}, {around}"
    wanted = 3 if around == "between frames" else 1
    assert len(frames) == wanted, f"{where}: {len(frames)} frames, not {wanted}"
    for i, found in enumerate(frames):
        hit = found.start == before
        assert hit or found.complete and not found.errors, f"{where}: frame {i} beside it is damaged too"
        wrong = np.flatnonzero((found.samples != frame.samples).reshape(len(frame.samples), -1).any(1)).tolist()
        assert set(wrong) <= set(found.bad_rows), f"{where}: rows {wrong} are wrong, {found.bad_rows} are told"
        assert len(found.bad_rows) <= hit, f"{where}: {len(found.bad_rows)} rows are lost: {found.bad_rows}"
    lost = sum(len(found.bad_rows) for found in frames)
    assert lost == 0 or around == "bytes behind" and position >= HEADER_BYTES, f"{where}: a row is lost, not mended"
    return lost


def sweep(name, around, count, seed, size=None):
    """Every position of a frame, ``count`` changes each: dict frame, around, bytes, tried, mended, row_lost, failures.

    failures: list of text, at most 10.
    """
    frame, found, failures, tried = real_frame(name, size), [0, 0], [], 0
    for position in range(len(frame.data)):
        for change in changes(count, [seed, position]):
            tried += 1
            try:
                found[check_position(frame, position, change, around)] += 1
            except Exception as error:
                failures.append(f"{name}: {error}")
    return {
        "frame": name,
        "around": around,
        "bytes": len(frame.data),
        "tried": tried,
        "mended": found[0],
        "row_lost": found[1],
        "failures": failures[:10],
        "failed": len(failures),
    }
