"""The verdict on a block: percent covered after exclusions, and what is missing."""

import math
import re
from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from talbot.verif.coverage.measure import Measurement, Point
from talbot.verif.coverage.testplan import KINDS, Exclusion, Machine, TestPlan


@dataclass
class Verdict:
    """The coverage of a block.

    coverage: percent by kind, None where nothing of the kind exists. missing: what no test reaches, one line each.
    errors: exclusions that do not hold and transitions that no plan allows. constant: toggles of bits that are proven
    constant. excluded: other points left out.
    """

    coverage: dict[str, float | None] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    constant: int = 0
    excluded: int = 0

    @property
    def complete(self) -> bool:
        """True where nothing is missing or wrong."""
        return not self.errors and not self.missing

    def count(self, kind: str, required: Collection[object], hit: Collection[object]) -> None:
        """Set the percentage of a kind; ``hit`` is a part of ``required``."""
        self.coverage[kind] = math.floor(1e4 * len(hit) / len(required)) / 100 if required else None  # 100: all of them


class Toggle(NamedTuple):
    """A bit of a signal and its edge, '0->1' or '1->0'."""

    signal: str
    bit: int
    edge: str


def points_of(measures: Sequence[Measurement]) -> dict[Point, int]:
    """Return the points of the first measurement and how often they are hit in all of them."""
    hits = Counter()
    for measured in measures:
        for count in measured.counts:
            hits[count.point.key] += count.times
    return {count.point: hits[count.point.key] for count in measures[0].counts}


def matches(exclusion: Exclusion, at: str, point: Point) -> bool:
    """Return whether the place ``at`` of ``exclusion`` is ``point``."""
    if exclusion.kind != point.kind:
        return False
    if point.kind != "toggle":
        module, _, code = at.partition(": ")
        return (module, code) == (point.module, point.code) and exclusion.what in ("", point.what)
    stem, bit, edge = split_toggle(point.what)
    ((name, high, low),) = re.findall(r"^(.*?)(?:\[(\d+)(?::(\d+))?\])?$", at)
    if name != f"{point.module}.{stem}" or exclusion.what not in ("", edge):
        return False
    return not high or int(low or high) <= bit <= int(high)


def split_toggle(text: str) -> Toggle:
    """Return the parts of 'signal[3]:0->1'."""
    ((signal, bit, edge),) = re.findall(r"^(.*?)(?:\[(\d+)\])?:(.*)$", text)
    return Toggle(signal, int(bit or 0), edge)


def missing_lines(points: Iterable[Point]) -> list[str]:
    """Return a line for each missing point, the bits of a signal together."""
    texts, signals = [], {}
    for point in points:
        where = f"{point.kind} {point.source} {point.module} line {point.line}"
        if point.kind == "toggle":
            stem, bit, edge = split_toggle(point.what)
            signals.setdefault((where, stem, edge), []).append(bit)
        else:
            texts.append(f"{where}: {point.what} of {point.code!r}")
    return texts + [f"{where}: {stem}[{ranges(bits)}] {edge}" for (where, stem, edge), bits in signals.items()]


def ranges(bits: Iterable[int]) -> str:
    """Return '9:7,3' for 3, 7, 8, 9."""
    out: list[list[int]] = []
    for bit in sorted(bits):
        if out and bit == out[-1][1] + 1:
            out[-1][1] = bit
        else:
            out.append([bit, bit])
    return ",".join(f"{high}:{low}" if high > low else f"{low}" for low, high in reversed(out))


def is_constant(point: Point, constant: Collection[tuple[str, str, int]]) -> bool:
    """Return whether ``point`` is a toggle of a bit of ``constant`` (module, signal, bit)."""
    return point.kind == "toggle" and (point.module, *split_toggle(point.what)[:2]) in constant


def judge(
    block: str, plan: TestPlan, measures: Sequence[Measurement], constant: Collection[tuple[str, str, int]] = ()
) -> Verdict:
    """Return the Verdict on ``block`` by its TestPlan. measures: the main parameter set first. constant: bits of
    that set's Verilog, which no input changes.
    """
    verdict, points = Verdict(), points_of(measures)
    verdict.errors += [
        f"{point.module}.{point.what} = toggled: must be constant"
        for point, times in points_of(measures[:1]).items()  # whose bits ``constant`` are
        if times and is_constant(point, constant)
    ]
    points = {point: times for point, times in points.items() if not is_constant(point, constant)}
    verdict.constant = len(points_of(measures)) - len(points)
    excluded = set()
    for exclusion in plan.exclusions_of(block):
        for at in exclusion.at:
            matching = [point for point in points if matches(exclusion, at, point)]
            where = f"exclude {exclusion.kind} {at!r}{' ' + exclusion.what if exclusion.what else ''}"
            if not matching:
                verdict.errors.append(f"{where}: must match a point")
            verdict.errors += [
                f"{where}: {point.what} of {point.source} is hit {points[point]} times"
                for point in matching
                if points[point]
            ]
            excluded.update(matching)
    verdict.excluded = len(excluded)
    for kind in KINDS:
        required = [point for point in points if point.kind == kind and point not in excluded]
        verdict.count(kind, required, [point for point in required if points[point]])
        verdict.missing += missing_lines([point for point in required if not points[point]])
    judge_machines(verdict, plan.machines_of(block), measures)
    required = plan.cover
    hit = [name for name in required if any(measured.functional[name] for measured in measures)]
    verdict.count("functional", required, hit)
    verdict.missing += [f"functional {plan.folder}: {name}" for name in required if name not in hit]
    return verdict


def judge_machines(verdict: Verdict, machines: Iterable[Machine], measures: Iterable[Measurement]) -> None:
    """Add states and transitions of ``machines`` to ``verdict``."""
    required: list[tuple[str, ...]] = []
    hit = set()
    for number, machine in enumerate(machines):
        name = "+".join(register for register, _ in machine.registers)
        names = {value: state for state, value in machine.states.items()}
        required += [(name, state) for state in machine.states] + [(name, *step) for step in machine.transitions]
        for step in (step for measured in measures for step in measured.transitions if step.machine == number):
            start, end = (names.get(value, str(value)) for value in (step.before, step.after))
            hit.add((name, end))
            if step.reset or start == end:
                continue
            hit.add((name, start, end))
            if (start, end) not in machine.transitions:
                verdict.errors.append(f"fsm {name}: {start} > {end}: no such transition in the plan")
    verdict.errors = list(dict.fromkeys(verdict.errors))
    verdict.count("fsm", required, hit & set(required))
    verdict.missing += [f"fsm {item[0]}: {' > '.join(item[1:])}" for item in required if item not in hit]
