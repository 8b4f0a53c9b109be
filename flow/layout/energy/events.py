"""What a frame makes the digital part do, by the golden model: what its switching energy is fitted to."""

from typing import NamedTuple

from talbot.models.chip import GoldenFrame


class DigitalEvents(NamedTuple):
    """Counts of a frame.

    cycles: of the clock while the chip is busy. rows: read. samples: that the converters gave. decisions: of the
    comparators. bytes: of the stream. divisions: of the phases.
    """

    cycles: int
    rows: int
    samples: int
    decisions: int
    bytes: int
    divisions: int


def digital_events(golden: GoldenFrame, cycles: int) -> DigitalEvents:
    """The events of a golden frame whose chip was busy for ``cycles``."""
    divisions = int(golden.read.sum()) if golden.frame.phase else 0
    rows, sent = int(golden.read.any(1).sum()), len(golden.stream)
    return DigitalEvents(cycles, rows, golden.samples, golden.decisions, sent, divisions)
