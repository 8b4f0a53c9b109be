"""The programs on the chip's Verilog and on the golden chip, next to what the host computes."""

import zlib

import numpy as np
import pytest

from talbot.models.digital.stream import StreamHeader, encode_frame
from talbot.models.parameters import ArrayParameters, FrameParameters, ParameterError, SensorParameters, Window
from talbot.rtl.proc.isa import signed
from talbot.rtl.test_chip_1.golden import CHANNEL, CONTROL, WRITE, GoldenChip, bytes_of, header, words_of
from talbot.rtl.test_chip_1.programs import JOB, assembled, compiled
from talbot.verif.test_chip_1.chip import Chip
from talbot.verif.test_chip_1.programs import DAMAGED, OTHER_KIND, RIGHT, Wake, edges_of, host_edges, memory_of

needs_gcc = pytest.mark.needs("riscv64-unknown-elf-gcc")
WORDS = [(0x9E3779B9 * n + 0x80000000) % 2**32 for n in range(60)]


def stream_of(rows, cols, threshold, density, resync=1, window=None, mode="edge"):
    rng = np.random.default_rng(rows)
    codes = rng.integers(-128, 128, (rows, cols, 1)) * (rng.random((rows, cols, 1)) < density)
    sensor = SensorParameters(array=ArrayParameters(rows, cols))
    window = window or Window(0, (rows - 1) // 4, 0, (cols - 1) // 6)
    frame = FrameParameters(window, mode, threshold=threshold, resync=resync)
    header_ = StreamHeader.from_frame(rows, cols, 8, frame, sensor.tile)
    return encode_frame(header_, codes if mode == "edge" else abs(codes), 1, 2, sensor.tile)


def golden_edges(code, stream, wake):
    """Return the memory from JOB on after the golden chip's run."""
    chip, memory = GoldenChip(), memory_of(stream, wake)
    for address, data in ((0, code), (JOB, memory)):
        data += bytes(-len(data) % 4)
        chip.host(header(address // 4 | WRITE, len(data) // 4) + data)
    chip.host(header(CONTROL | WRITE, 1) + bytes_of([1]))
    return chip.host(header(JOB // 4, -(-len(memory) // 4)))


def test_the_sorter():
    chip = Chip()
    chip.write(0x200, bytes_of(WORDS))
    chip.run(assembled("sort", address=0x80, length=len(WORDS)))
    assert words_of(chip.read(0x200, 4 * len(WORDS))) == sorted(WORDS, key=signed)


@pytest.mark.parametrize("length", [0, 1, 9])
def test_crc(length):
    chip, data = Chip(), bytes_of(WORDS)[:length]
    chip.write(0x200, data)
    chip.run(assembled("crc", address=0x200, length=length))
    assert chip.pin("word_waits") and words_of(chip.transfer(header(CHANNEL, 1), 4)) == [zlib.crc32(data)]


@needs_gcc
@pytest.mark.parametrize("length", [0, 1, 2, 9, 60])
def test_quicksort(length):
    chip, words = Chip(), WORDS[:length]
    chip.write(JOB, bytes_of([JOB + 8, length, *words]))
    chip.run(compiled("quicksort"))
    assert words_of(chip.read(JOB + 8, 4 * length)) == sorted(words, key=signed)


FRAMES = {
    "cut tiles": ({"rows": 9, "cols": 14, "threshold": 10, "density": 0.3}, Wake()),
    "a segment a row": ({"rows": 16, "cols": 36, "threshold": 10, "density": 0.05, "resync": 0}, Wake(1, 2, 1)),
    "under the noise": ({"rows": 12, "cols": 20, "threshold": 2, "density": 0.6, "resync": 3}, Wake(2, 9, 2)),
    "literals": ({"rows": 8, "cols": 30, "threshold": 0, "density": 1.0}, Wake(0, 24, 11)),
    "window": ({"rows": 24, "cols": 50, "threshold": 20, "density": 0.1, "window": Window(1, 4, 2, 8)}, Wake(1, 3, 2)),
    "hardly an edge": ({"rows": 30, "cols": 60, "threshold": 20, "density": 0.003, "resync": 2}, Wake(0, 1, 3)),
}


@needs_gcc
@pytest.mark.parametrize("name", FRAMES)
def test_edges_equal_the_hosts(name):
    parameters, wake = FRAMES[name]
    stream, code, chip = stream_of(**parameters), compiled("edges"), Chip()
    memory, host = memory_of(stream, wake), host_edges(stream, wake)
    chip.write(JOB, memory)
    chip.run(code)
    after = chip.read(JOB, -(-len(memory) // 4) * 4)
    edges = edges_of(after, stream, wake)
    assert (edges.status, edges.edges, edges.busy) == (RIGHT, host.edges, host.busy) and host.edges
    assert np.array_equal(edges.counts, host.counts)
    assert chip.pin("word_waits") == (host.busy >= wake.least_cells)
    assert after == golden_edges(code, stream, wake)


@needs_gcc
def test_damage_and_other_frames():
    stream, code, wake = stream_of(9, 14, 10, 0.3), compiled("edges"), Wake()
    for place in (33, len(stream) - 20):
        damaged = bytearray(stream)
        damaged[place] ^= 0x10
        assert edges_of(golden_edges(code, bytes(damaged), wake), stream, wake).status == DAMAGED
    raw = stream_of(8, 12, 10, 0.3, mode="image")
    ternary = stream[:5] + bytes([stream[5] | 8]) + stream[6:]
    for other in (raw, ternary, b"X" + stream[1:], stream[:19] + b"\0" + stream[20:]):
        assert edges_of(golden_edges(code, other, wake), stream, wake).status == OTHER_KIND


def test_a_frame_that_does_not_fit():
    with pytest.raises(ParameterError, match="stream = 20000 bytes: must be at most"):
        memory_of(stream_of(8, 12, 10, 0.1).ljust(20_000), Wake())
