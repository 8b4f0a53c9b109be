"""Animated WebP written frame by frame, so that no number of frames fills the memory.

Pillow encodes the frames, each alone and lossless; this file lines them up (RFC 9649, sections 2.3 to 2.7).
"""

import io
import struct
from pathlib import Path
from types import TracebackType
from typing import Self

from PIL import Image

HEADER = 12  # bytes of a still picture before its chunk
LONGEST = (1 << 24) - 1  # ms that a frame can be shown


class Animation:
    """An animation that repeats for ever, in the file ``path``; complete when the context ends."""

    def __init__(self, path: Path) -> None:
        self._file, self._size, self._shown = path.open("wb"), (0, 0), 0.0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        end = self._file.tell()
        self._file.seek(4)
        self._file.write(struct.pack("<I", max(end - 8, 0)))
        self._file.close()

    def add(self, picture: Image.Image, seconds: float) -> None:
        """Add an RGB picture, shown for ``seconds``; all have one size. Raises ValueError for another, OSError."""
        if self._size == (0, 0):
            self._size = picture.size
            self._file.write(b"RIFF\0\0\0\0WEBP")
            self._file.write(
                _chunk(b"VP8X", b"\x02\0\0\0" + _sides(picture)) + _chunk(b"ANIM", b"\xff\xff\xff\xff\0\0")
            )
        if picture.size != self._size:
            raise ValueError(f"picture = {picture.size}: must be of the animation's size, {self._size}")
        still = io.BytesIO()
        picture.save(still, "WEBP", lossless=True, method=1, quality=0)  # fast: 2 ms of 384 x 384 sparse edges
        start, self._shown = round(1000 * self._shown), self._shown + seconds
        shown = min(round(1000 * self._shown) - start, LONGEST)  # the sum stays right where ms are rounded
        place = bytes(6) + _sides(picture) + struct.pack("<I", shown)[:3] + b"\x02"  # replaces what is below
        self._file.write(_chunk(b"ANMF", place + still.getvalue()[HEADER:]))


def _sides(picture: Image.Image) -> bytes:
    return b"".join(struct.pack("<I", side - 1)[:3] for side in picture.size)


def _chunk(name: bytes, data: bytes) -> bytes:
    return name + struct.pack("<I", len(data)) + data + bytes(len(data) % 2)
