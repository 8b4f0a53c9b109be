"""Resynchronisation: a wrong byte anywhere in a frame of any mode loses at most one segment."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.imaging.frame import job
from talbot.imaging.frame.request import request
from talbot.models.chip import golden_frame
from talbot.models.digital.stream import decode_stream, segments
from talbot.models.parameters import MODES, SIGNED
from talbot.models.parameters.stream_format import HEADER_BYTES, TRAILER_BYTES
from talbot.verif.results import Sweep

FRAMES = {**{mode: (mode, False) for mode in MODES}, "phase": ("tof", True)}
# Rows, cols of the array that sees the default scene
SIZES: dict[str, tuple[int, int]] = dict.fromkeys(SIGNED, (96, 144))
SIZE = 24, 36  # ... in the other modes, whose rows are plain bytes
AROUND = "alone", "between frames", "followed by bytes"


@dataclass(frozen=True, eq=False)
class Real:
    """A frame. data: its bytes. samples: their content, (rows, cols, subs). most: rows of its longest segment."""

    data: bytes
    samples: npt.NDArray[np.int16]
    most: int


def real_frame(name: str, size: tuple[int, int] | None = None) -> Real:
    """Return frame ``name`` of FRAMES of the default scene through the golden chip. size: rows, cols."""
    mode, phase = FRAMES[name]
    rows, cols = size or SIZES.get(name, SIZE)
    settings = request(rows=rows, cols=cols, mode=mode, phase=phase)
    scene, todo = job.see(settings)
    exposed = job.expose(settings, scene, todo)
    golden = golden_frame(exposed.samples, settings.sensor, settings.frame, exposed.front_end)
    (frame,) = decode_stream(golden.stream)
    lines = frame.samples.reshape(rows, -1)
    sent = ((int(row), lines[row, frame.layout.places_of(i)].tolist()) for i, row in enumerate(frame.layout.rows))
    return Real(golden.stream, golden.sent, max(many for _, _, many in segments(frame.header, sent)))


def changes(count: int, seed: Sequence[int]) -> list[int]:
    """Return ``count`` ways to change a byte (xor, 1..255): each single bit, all bits, then random ones."""
    some = [1 << bit for bit in range(8)] + [0xFF]
    others = [c for c in np.random.default_rng(seed).permutation(np.arange(1, 256)).tolist() if c not in some]
    return (some + others)[:count]


def check_position(frame: Real, position: int, change: int, around: str) -> int:
    """Decode the frame with one byte changed; returns 1 if a segment is lost, else 0. Raises AssertionError."""
    data = bytearray(frame.data)
    data[position] ^= change
    before = len(frame.data) if around == "between frames" else 0
    after = {"alone": b"", "between frames": frame.data, "followed by bytes": bytes(TRAILER_BYTES + 6)}[around]
    frames = decode_stream(frame.data[:before] + bytes(data) + after)
    where = f"byte {position} xor {change:#04x}, {around}"
    expected = 3 if around == "between frames" else 1
    assert len(frames) == expected, f"{where}: {len(frames)} frames, not {expected}"
    for i, decoded in enumerate(frames):
        hit = decoded.start == before
        assert hit or decoded.complete and not decoded.errors, f"{where}: frame {i} is damaged, too"
        wrong = np.flatnonzero((decoded.samples != frame.samples).reshape(len(frame.samples), -1).any(1)).tolist()
        assert set(wrong) <= set(decoded.bad_rows), f"{where}: rows {wrong} are wrong, {decoded.bad_rows} are reported"
        assert len(decoded.bad_rows) <= hit * frame.most, f"{where}: rows {decoded.bad_rows} are lost"
    lost = int(any(decoded.bad_rows for decoded in frames))
    assert lost == 0 or around == "followed by bytes" and position >= HEADER_BYTES, f"{where}: a row is lost"
    return lost


def sweep(name: str, around: str, count: int, seed: int, size: tuple[int, int] | None = None) -> Sweep:
    """Try ``count`` changes at every position of a frame."""
    frame, outcomes, failures, tried = real_frame(name, size), [0, 0], [], 0
    for position in range(len(frame.data)):
        for change in changes(count, [seed, position]):
            tried += 1
            try:
                outcomes[check_position(frame, position, change, around)] += 1
            except Exception as error:
                failures.append(f"{name}: {error}")
    return Sweep(name, around, len(frame.data), tried, outcomes[0], outcomes[1], failures[:10], len(failures))
