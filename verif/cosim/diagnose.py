"""Diagnosis: the fault of a dictionary whose computed codes are those of a row."""

from collections.abc import Iterator
from typing import NamedTuple

from talbot.models.digital.sar import decisions
from talbot.verif.cosim.deck import BITS
from talbot.verif.cosim.faults import Fault
from talbot.verif.cosim.row import Row, RowRequest

SOUND = "no fault"


class Finding(NamedTuple):
    """The best explanation.

    name: of the fault. error: sum of the codes' distances from it, LSB; next_error: from the next best one;
    sound_error: from a sound circuit.
    """

    name: str
    error: int
    next_error: int
    sound_error: int


def dictionary(row: RowRequest) -> Iterator[Fault]:
    """Every fault that the row's lanes may have, and its pixels where they are in the circuit."""
    columns, lanes = row.read
    for lane in lanes:
        yield Fault("comparator", (lane,))
        for bit in range(BITS):
            yield Fault("capacitor", (lane, bit))
    for column in columns if row.pixels else ():
        yield Fault("diodes", (column,))
        yield Fault("row", (column,))


def value_of(value: float, column: int, edge: bool, fault: Fault | None) -> float:
    """Return the output of ``column`` with ``fault`` for ``value`` (LSB); 0 through a line that is cut."""
    if fault == Fault("diodes", (column,)) and edge:
        return -value
    return 0.0 if fault and fault.kind == "row" and column >= fault.where[0] else value


def code_of(value: float, lane: int, unsigned: bool, threshold: int, fault: Fault | None) -> int:
    """Return the code of ``value`` (LSB) on a lane with ``fault``, in charge alone.

    A capacitor that is missing samples nothing and adds nothing: a code without its bit is compared with the value
    times what is left of the 256 units.
    """
    of_lane = fault and fault.kind in ("comparator", "capacitor") and fault.where[0] == lane
    here = fault if of_lane else None
    weight = 1 << here.where[1] if here and here.kind == "capacitor" else 0
    search = decisions(unsigned, threshold)
    try:
        asked = next(search)
        while True:
            level = (asked & ~weight) - 0.5
            above = (value + (0 if unsigned else 128)) * (256 - weight) >= 256 * level
            asked = search.send(above != bool(here and here.kind == "comparator"))
    except StopIteration as end:
        return int(end.value[0])


def diagnose(row: Row) -> Finding:
    """The fault whose codes are nearest to those of ``row``; none where all are within an LSB of a sound circuit's.

    A capacitor of one unit that is missing is thus not found: its codes are those of noise.
    """
    asked = row.request
    unsigned, threshold = asked.mode != "edge", asked.threshold if asked.mode == "edge" else 0

    def distances(fault: Fault | None) -> list[int]:
        values = [value_of(s.value, s.column, asked.mode == "edge", fault) for s in row.samples]
        expected = [code_of(v, s.lane, unsigned, threshold, fault) for v, s in zip(values, row.samples, strict=True)]
        return [abs(s.code - code) for s, code in zip(row.samples, expected, strict=True)]

    sound = distances(None)
    errors = {fault.name: sum(distances(fault)) for fault in dictionary(asked)}
    (name, best), (_, after), *_ = sorted(errors.items(), key=lambda item: item[1])
    if max(sound) <= 1:
        return Finding(SOUND, sum(sound), best, sum(sound))
    return Finding(name, best, min(after, sum(sound)), sum(sound))
