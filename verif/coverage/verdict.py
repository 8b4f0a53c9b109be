"""What the measurements of a block's traces come to: percent after exclusions, and what is missing."""

import math
import re
from dataclasses import dataclass, field

from .measure import Point
from .testplan import KINDS


@dataclass
class Verdict:
    """coverage: percent by kind, None where there is nothing of the kind. missing: texts, what no test reaches.
    errors: texts, exclusions that do not hold and transitions that no plan allows. excluded: points left out.
    """

    coverage: dict = field(default_factory=dict)
    missing: list = field(default_factory=list)
    errors: list = field(default_factory=list)
    excluded: int = 0

    @property
    def complete(self):
        return not self.errors and not self.missing

    def count(self, kind, wanted, hit):
        """Set the percentage of a kind; wanted, hit: collections, hit within wanted."""
        self.coverage[kind] = math.floor(1e4 * len(hit) / len(wanted)) / 100 if wanted else None  # 100: all of them


def points_of(measures):
    """Points of the first measurement, hit there or in another parameter set: dict Point -> times."""
    hits = {}
    for result in measures:
        for *values, times in result["points"]:
            key = Point(*values).key
            hits[key] = hits.get(key, 0) + times
    return {(point := Point(*values)): hits[point.key] for *values, _ in measures[0]["points"]}


def matches(exclusion, at, point):
    """True if the place ``at`` of ``exclusion`` is ``point``."""
    if exclusion.kind != point.kind:
        return False
    if point.kind != "toggle":
        module, _, code = at.partition(": ")
        return (module, code) == (point.module, point.code) and exclusion.what in ("", point.what)
    stem, bit, edge = split_toggle(point.what)
    name, high, low = re.fullmatch(r"(.*?)(?:\[(\d+)(?::(\d+))?\])?", at).groups()
    if name != f"{point.module}.{stem}" or exclusion.what not in ("", edge):
        return False
    return high is None or int(low or high) <= bit <= int(high)


def split_toggle(what):
    """('signal', 3, '0->1') of 'signal[3]:0->1'."""
    stem, bit, edge = re.fullmatch(r"(.*?)(?:\[(\d+)\])?:(.*)", what).groups()
    return stem, int(bit or 0), edge


def told(points):
    """What is missing of one kind: texts, the bits of a signal together."""
    texts, signals = [], {}
    for point in points:
        where = f"{point.kind} {point.source} {point.module} line {point.line}"
        if point.kind == "toggle":
            stem, bit, edge = split_toggle(point.what)
            signals.setdefault((where, stem, edge), []).append(bit)
        else:
            texts.append(f"{where}: {point.what} of {point.code!r}")
    return texts + [f"{where}: {stem}[{ranges(bits)}] {edge}" for (where, stem, edge), bits in signals.items()]


def ranges(bits):
    """'9:7,3' of 3, 7, 8, 9."""
    out = []
    for bit in sorted(bits):
        if out and bit == out[-1][1] + 1:
            out[-1][1] = bit
        else:
            out.append([bit, bit])
    return ",".join(f"{high}:{low}" if high > low else f"{low}" for low, high in reversed(out))


def judge(block, plan, measures):
    """The Verdict on ``block`` by its TestPlan. measures: of `measure.measure`, the main parameter set first."""
    verdict, points = Verdict(), points_of(measures)
    excluded = set()
    for exclusion in plan.exclusions_of(block):
        for at in exclusion.at:
            found = [point for point in points if matches(exclusion, at, point)]
            where = f"exclude {exclusion.kind} {at!r}{' ' + exclusion.what if exclusion.what else ''}"
            if not found:
                verdict.errors.append(f"{where}: there is no such point")
            verdict.errors += [
                f"{where}: {point.what} of {point.source} is hit {points[point]} times"
                for point in found
                if points[point]
            ]
            excluded.update(found)
    verdict.excluded = len(excluded)
    for kind in KINDS:
        wanted = [point for point in points if point.kind == kind and point not in excluded]
        verdict.count(kind, wanted, [point for point in wanted if points[point]])
        verdict.missing += told([point for point in wanted if not points[point]])
    judge_machines(verdict, plan.machines_of(block), measures)
    wanted = plan.cover
    hit = [name for name in wanted if any(result["functional"][name] for result in measures)]
    verdict.count("functional", wanted, hit)
    verdict.missing += [f"functional {plan.folder}: {name}" for name in wanted if name not in hit]
    return verdict


def judge_machines(verdict, machines, measures):
    """Add states and transitions of ``machines`` to ``verdict``."""
    wanted, hit = [], set()
    for number, machine in enumerate(machines):
        name = "+".join(register for register, _ in machine.registers)
        names = {value: state for state, value in machine.states.items()}
        wanted += [(name, state) for state in machine.states] + [(name, *step) for step in machine.transitions]
        for result in measures:
            for which, reset, before, after, _ in result["states"]:
                if which != number:
                    continue
                start, end = names.get(before, before), names.get(after, after)
                hit.add((name, end))
                if reset or start == end:
                    continue
                hit.add((name, start, end))
                if (start, end) not in machine.transitions:
                    verdict.errors.append(f"fsm {name}: {start} > {end}: no such transition in the plan")
    verdict.errors = list(dict.fromkeys(verdict.errors))
    verdict.count("fsm", wanted, hit & set(wanted))
    verdict.missing += [f"fsm {what[0]}: {' > '.join(what[1:])}" for what in wanted if what not in hit]
