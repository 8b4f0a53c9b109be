"""The programs' parameters and results, and what the host computes of the same frame."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.digital.stream import decode_stream
from talbot.models.parameters import ParameterError, TileParameters
from talbot.rtl.test_chip_1.golden import WORDS, bytes_of, words_of
from talbot.rtl.test_chip_1.programs import JOB

COUNTS = JOB + 32  # address of the cells' counts, ahead of the stream
RIGHT, OTHER_KIND, DAMAGED = range(3)  # status


@dataclass(frozen=True)
class Wake:
    """When a frame wakes the host: `least_cells` cells of 2^shift x 2^shift tiles have `least_edges` each."""

    shift: int = 0
    least_edges: int = 4
    least_cells: int = 8


@dataclass(frozen=True)
class Edges:
    """Results of the program `edges`. counts: edges of each cell (rows, cols). busy: cells that count for `Wake`."""

    status: int
    edges: int
    busy: int
    counts: npt.NDArray[np.uint8]


def cells_of(stream: bytes, shift: int) -> tuple[int, int]:
    """Return the rows and columns of cells of a frame's array."""
    rows, cols = int.from_bytes(stream[9:11], "big"), int.from_bytes(stream[11:13], "big")
    return -(-rows // (stream[8] >> 4 << shift)), -(-cols // ((stream[8] & 15) << shift))


def memory_of(stream: bytes, wake: Wake) -> bytes:
    """Return the memory from JOB on: parameters, counts, stream. Raises ParameterError where they do not fit."""
    rows, cols = cells_of(stream, wake.shift)
    start = COUNTS + -(-rows * cols // 4) * 4
    if start + len(stream) > 4 * WORDS:
        raise ParameterError(f"stream = {len(stream)} bytes: must be at most {4 * WORDS - start} with these cells")
    words = start, COUNTS, wake.shift, wake.least_edges, wake.least_cells, 0, 0, 0
    return bytes_of(words) + bytes(start - COUNTS) + stream


def edges_of(memory: bytes, stream: bytes, wake: Wake) -> Edges:
    """Return the results in the ``memory`` from JOB on."""
    rows, cols = cells_of(stream, wake.shift)
    status, edges, busy = words_of(memory[20:32])
    counts = np.frombuffer(memory[32 : 32 + rows * cols], np.uint8).reshape(rows, cols)
    return Edges(status, edges, busy, counts)


def host_edges(stream: bytes, wake: Wake) -> Edges:
    """Return the same of a whole frame by the host's decoder."""
    tile, (rows, cols) = TileParameters(), cells_of(stream, wake.shift)
    nonzero = decode_stream(stream, tile)[0].samples[..., 0] != 0
    whole = np.zeros((rows * tile.rows << wake.shift, cols * tile.cols << wake.shift), np.uint8)
    whole[: nonzero.shape[0], : nonzero.shape[1]] = nonzero
    counts = whole.reshape(rows, -1, cols, tile.cols << wake.shift).sum((1, 3), dtype=np.uint8)
    return Edges(RIGHT, int(nonzero.sum()), int((counts >= wake.least_edges).sum()), counts)
