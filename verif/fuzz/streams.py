"""Inputs for the decoder: good frames and damaged ones."""

import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from talbot.models.digital.stream import StreamHeader, encode_frame
from talbot.models.parameters import LANES, MODES, FrameParameters, ParameterError, TileParameters, Window
from talbot.models.parameters.stream_format import FIELD_BYTES, HEADER_BYTES, MAGIC

SMALL_TILE = TileParameters(3, 2, TileParameters().types[:6], (5, 0, 3, 1, 4, 2))
TILES = TileParameters(), SMALL_TILE
FRAMES_MAX = 3  # frames in one input
NOISE_MAX = 400  # random bytes in one place


@dataclass(frozen=True, eq=False)
class Sent:
    """A good frame. samples: int64 (rows, cols, subs), zero where nothing is read. data: its bytes."""

    header: StreamHeader
    tile: TileParameters
    samples: npt.NDArray[np.int64]
    data: bytes


@dataclass(frozen=True, eq=False)
class Case:
    """One input. kind: a name of KINDS. sent: the frame that must be decoded, or None."""

    kind: str
    data: bytes
    tile: TileParameters
    sent: Sent | None = None


Rng = np.random.Generator
Pool = Sequence[Sent]
T = TypeVar("T")


def random_header(rng: Rng) -> tuple[StreamHeader, TileParameters]:
    """Return the header and the tile of a small array of which something is read."""
    while True:
        tile = TILES[int(rng.random() < 0.2)]
        rows, cols = int(rng.integers(1, 21)), int(rng.integers(1, 51))
        row0, row1 = sorted(rng.integers(0, -(-rows // tile.rows), 2).tolist())
        col0, col1 = sorted(rng.integers(0, -(-cols // tile.cols), 2).tolist())
        mode = MODES[rng.integers(len(MODES))]
        mask = int(rng.integers(1, 1 << tile.n_types)) if rng.random() < 0.5 else (1 << tile.n_types) - 1
        frame = FrameParameters(
            Window(row0, row1, col0, col1),
            mode,
            mask,
            int(rng.integers(0, 128)) if rng.random() < 0.5 else 4,
            int(rng.integers(0, 4)),
            mode == "tof" and rng.random() < 0.5,
            frame_number=int(rng.integers(0, 65536)),
            resync=int(rng.integers(0, 4)),
            calibration=int(rng.integers(0, 256)),
        )
        header = StreamHeader.from_frame(rows, cols, LANES[rng.integers(len(LANES))], frame, tile)
        try:
            header.layout(tile)
        except ParameterError:  # nothing to read
            continue
        return header, tile


def random_frame(rng: Rng) -> Sent:
    """Return a good frame of a small array."""
    header, tile = random_header(rng)
    shape, layout = (header.rows, header.cols, header.subs), header.layout(tile)
    codes = rng.integers(0, 256, shape)
    if header.edge:
        codes = np.clip(np.rint(rng.laplace(0, rng.choice([3, 20, 80]), shape)), -128, 127).astype(int)
        codes[(rng.random(shape) > rng.choice([0.05, 0.3, 1])) | (abs(codes) < header.threshold)] = 0
        codes = np.sign(codes) if header.mode == "ternary" else codes
    samples = np.zeros(shape, int)
    for ordinal, row in enumerate(layout.rows):
        here = row, layout.places_of(ordinal)
        samples.reshape(header.rows, -1)[here] = codes.reshape(header.rows, -1)[here]
    made, left_out = (int(n) for n in rng.integers(0, 2**32, 2))
    return Sent(header, tile, samples, encode_frame(header, samples, made, left_out, tile))


def _pick(pool: Sequence[T], rng: Rng) -> T:
    return pool[int(rng.integers(len(pool)))]


def _place(data: bytes, rng: Rng) -> int:
    """Return a position in a frame, in one case of five anywhere, else after the header."""
    return int(rng.integers(HEADER_BYTES if rng.random() < 0.8 else 0, len(data)))


def _noise(rng: Rng) -> bytes:
    """Return at most NOISE_MAX random bytes, zeros or ones."""
    size = int(rng.integers(1, NOISE_MAX + 1))
    return (rng.bytes, bytes, lambda n: b"\xff" * n)[rng.integers(3)](size)


def _wrong_byte(data: bytes, rng: Rng) -> bytes:
    out = bytearray(data)
    out[_place(data, rng)] ^= int(rng.integers(1, 256))
    return bytes(out)


def clean(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Return the frame as it is."""
    return sent.data


def one_wrong_byte(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Change one byte."""
    return _wrong_byte(sent.data, rng)


def wrong_bytes(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Change 2 to 20 bytes."""
    data = sent.data
    for _ in range(rng.integers(2, 21)):
        data = _wrong_byte(data, rng)
    return data


def cut(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Cut the frame; keep the first or the last part."""
    at = _place(sent.data, rng)
    return sent.data[:at] if rng.random() < 0.7 else sent.data[at:]


def insertion(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Insert noise."""
    at = _place(sent.data, rng)
    return sent.data[:at] + _noise(rng)[: int(rng.integers(1, NOISE_MAX))] + sent.data[at:]


def deletion(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Delete a part."""
    first, last = sorted((_place(sent.data, rng), _place(sent.data, rng)))
    return sent.data[:first] + sent.data[last:]


def doubled(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Repeat a part."""
    first, last = sorted((_place(sent.data, rng), _place(sent.data, rng)))
    return sent.data[:last] + sent.data[first:]


def splice(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Continue with a part of another frame."""
    other = _pick(pool, rng).data
    return sent.data[: _place(sent.data, rng)] + other[_place(other, rng) :]


def several(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Return some frames one after the other, each intact or damaged by one of the above, with noise between."""
    out = b""
    for _ in range(rng.integers(2, FRAMES_MAX + 1)):
        damage = (clean, one_wrong_byte, cut, deletion, insertion)[rng.integers(5)]
        out += damage(_pick(pool, rng), pool, rng) + (_noise(rng) if rng.random() < 0.2 else b"")
    return out


def hostile(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Return a header with a right CRC-32 and extreme or impossible fields, then anything."""
    fields = bytearray(sent.header.to_bytes()[:FIELD_BYTES])
    for _ in range(rng.integers(1, 6)):
        at = int(rng.integers(4, FIELD_BYTES))
        if at in (9, 11) and rng.random() < 0.5:  # rows, cols
            fields[at : at + 2] = struct.pack(">H", int(rng.choice([0, 1, 63, 256, 1024, 1025, 1536, 1537, 65535])))
        else:
            fields[at] = int(rng.choice([0, 1, 2, 0x7F, 0x80, 0xFF, int(rng.integers(256))]))
    body = _noise(rng) if rng.random() < 0.5 else _pick(pool, rng).data[HEADER_BYTES:]
    return bytes(fields) + struct.pack(">I", zlib.crc32(fields)) + body


def noise(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Return noise with a magic number here and there."""
    return b"".join((MAGIC if rng.random() < 0.5 else b"") + _noise(rng) for _ in range(rng.integers(1, 4)))


def nothing(sent: Sent, pool: Pool, rng: Rng) -> bytes:
    """Return fewer bytes than a header and one more."""
    return rng.bytes(int(rng.integers(0, HEADER_BYTES + 2)))


SURVIVED = "clean", "one wrong byte"  # every sample of these must be decoded
KINDS = {  # name: (function, share of the inputs)
    "clean": (clean, 0.03),
    "one wrong byte": (one_wrong_byte, 0.15),
    "wrong bytes": (wrong_bytes, 0.17),
    "cut": (cut, 0.09),
    "insertion": (insertion, 0.09),
    "deletion": (deletion, 0.09),
    "doubled": (doubled, 0.07),
    "splice": (splice, 0.09),
    "several frames": (several, 0.08),
    "hostile header": (hostile, 0.08),
    "noise": (noise, 0.05),
    "nothing": (nothing, 0.01),
}
_NAMES, _SHARES = tuple(KINDS), np.cumsum([share for _, share in KINDS.values()])


def make_case(pool: Pool, rng: Rng) -> Case:
    """Return one input; the decoder is sometimes given the tile of another sensor."""
    kind = _NAMES[int(np.searchsorted(_SHARES, rng.random() * _SHARES[-1]))]
    sent = _pick(pool, rng)
    right = kind in SURVIVED
    tile = sent.tile if right or rng.random() < 0.95 else _pick(TILES, rng)
    return Case(kind, KINDS[kind][0](sent, pool, rng), tile, sent if right else None)
