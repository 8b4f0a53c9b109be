"""Cycles of the programs on test chip 1: `python -m talbot.verif.test_chip_1.measure` writes its page of results."""

import random
import sys
from collections.abc import Sequence
from dataclasses import replace

from talbot.base.files import insert
from talbot.base.paths import ROOT
from talbot.base.table import markdown_table
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.request import request
from talbot.models.parameters import STANDARD, ArrayParameters
from talbot.rtl.proc.isa import signed
from talbot.rtl.test_chip_1.golden import CONTROL, WRITE, GoldenChip, bytes_of, header, words_of
from talbot.rtl.test_chip_1.programs import JOB, assembled, compiled
from talbot.verif.test_chip_1.chip import Chip
from talbot.verif.test_chip_1.programs import RIGHT, Wake, edges_of, host_edges, memory_of

PAGE = ROOT / "docs" / "results" / "test_chip_1.md"
FRAMES = (  # scene, pixels of a side, shift of the cells
    ("motorcycle", 96, 0),
    ("motorcycle", 192, 1),
)
LENGTHS = 2, 32, 1024


def ran(program: bytes, address: int, memory: bytes) -> tuple[int, int, Chip]:
    """Return cycles and instructions of ``program`` with ``memory`` from ``address`` on, and the chip."""
    chip, golden = Chip(), GoldenChip()
    chip.write(address, memory)
    cycles = chip.run(program)
    for place, data in ((0, program), (address, memory)):
        data += bytes(-len(data) % 4)
        golden.host(header(place // 4 | WRITE, len(data) // 4) + data)
    golden.host(header(CONTROL | WRITE, 1) + bytes_of([1]))
    return cycles, golden.fetched, chip


def frame_row(scene: str, side: int, shift: int, program: bytes) -> Sequence[str]:
    """Return a frame's row of the table. Raises ValueError where the chip and the host differ."""
    sensor = replace(STANDARD, array=ArrayParameters(side, side))
    stream, wake = golden_result(request(scene=scene, sensor=sensor)).golden.stream, Wake(shift)
    memory, host = memory_of(stream, wake), host_edges(stream, wake)
    cycles, instructions, chip = ran(program, JOB, memory)
    edges = edges_of(chip.read(JOB, -(-len(memory) // 4) * 4), stream, wake)
    equal = (edges.counts == host.counts).all() and (edges.edges, edges.busy) == (host.edges, host.busy)
    if edges.status != RIGHT or not equal:
        raise ValueError(f"{scene}, {side} x {side}: the chip's counts differ from the host's")
    wakes = "yes" if chip.pin("word_waits") else "no"
    numbers = len(stream), edges.edges, edges.busy
    return (
        scene,
        f"{side} x {side}",
        *(f"{n:,}" for n in numbers),
        wakes,
        f"{cycles:,}",
        f"{cycles / instructions:.2f}",
    )


def sort_row(length: int, program: bytes) -> Sequence[str]:
    """Return a length's row of the table of sorting."""
    rng = random.Random(length)
    words = [rng.getrandbits(32) for _ in range(length)]
    software, instructions, chip = ran(program, JOB, bytes_of([JOB + 8, length, *words]))
    results = [words_of(chip.read(JOB + 8, 4 * length))]
    hardware, _, chip = ran(assembled("sort", address=0x80, length=length), 0x200, bytes_of(words))
    results.append(words_of(chip.read(0x200, 4 * length)))
    if any(result != sorted(words, key=signed) for result in results):
        raise ValueError(f"{length} words are not sorted")
    return (
        f"{length:,}",
        f"{software:,}",
        f"{software / instructions:.2f}",
        f"{hardware:,}",
        f"{software / hardware:.1f}",
    )


def main() -> int:
    """Write the tables of PAGE."""
    edges, quicksort = compiled("edges"), compiled("quicksort")
    frames = [frame_row(*frame, edges) for frame in FRAMES]
    head = "scene", "pixels", "bytes", "edges", "busy regions", "wakes the host", "cycles", "CPI"
    insert(PAGE, "frames", markdown_table(head, frames, 2))
    head = "words", "quicksort, cycles", "CPI", "sorter, cycles", "ratio"
    insert(PAGE, "sorting", markdown_table(head, (sort_row(length, quicksort) for length in LENGTHS), 0))
    print(PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
