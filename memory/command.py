"""A static RAM's cells under plain logic rules, drawn and checked; their margins and a column in ngspice."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.arguments import whole_of
from talbot.base.jobs import worker_count
from talbot.base.progress import Steps
from talbot.memory.parameters import SramParameters
from talbot.models.parameters import check_int


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot sram`."""
    add, default = parser.add_argument, SramParameters()
    add("--words", type=whole_of, default=default.words, help="words, a power of two, 128..1024")
    add("--bits", type=whole_of, default=default.bits, help="bits of a word, 1..64")
    add("--draws", type=whole_of, default=200, help="cells with mismatch for each margin, 0..10000")
    add("--workers", type=worker_count, default=1, help="processes; -1: all cores")
    add("--document", type=Path, help="also put the tables between the marks of this file: docs/results/sram.md")
    add("--out", type=Path, help="folder for the results (default: build/sram)")


def run(options: Namespace) -> int:
    """Draw, check, measure, write the page and print the figures; 1 where a check fails."""
    from talbot.base.paths import RESULTS

    sram = SramParameters(options.words, options.bits)
    check_int("draws", options.draws, 0, 10000)
    from talbot.memory.job import STEPS, make
    from talbot.memory.tables import tables

    out = options.out or RESULTS / "sram"
    with Steps(STEPS, lines=True) as steps:
        summary = make(sram, options.draws, out, options.workers, options.document, steps.note)
    print(
        f"{sum(summary['drc'].values())} violations, LVS {'matches' if summary['lvs_match'] else 'DIFFERS'}, "
        f"{summary['antennas']} antennas"
    )
    for head, rows in tables(summary).values():
        for row in (head, *rows):
            print(f"  {row[0]:58} {' '.join(f'{text:>16}' for text in row[1:])}")
    print(f"  {summary['wall_s']:.0f} s; look at {out / 'sram.html'}")
    return 0 if summary["passed"] else 1
