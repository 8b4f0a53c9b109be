"""The independent pieces of a proof, as jobs: base and step with each engine, the covers, each property's twin."""

import re
from collections.abc import Callable
from dataclasses import dataclass

from talbot.verif.formal.engine import FAILED, PASSED, UNKNOWN, Workplace
from talbot.verif.formal.netlist import Netlist
from talbot.verif.formal.proof import Proof, labels
from talbot.verif.results import PROVEN


@dataclass(frozen=True)
class ProofResult:
    """One engine on all properties. result: PROVEN, FAILED or UNKNOWN. failing: properties. output: its last lines."""

    result: str
    failing: list[str]
    wall_s: float
    output: str


@dataclass(frozen=True)
class CoverResult:
    """The cover points that are reached and those that are not."""

    reached: list[str]
    missing: list[str]
    wall_s: float


@dataclass(frozen=True)
class TwinResult:
    """A broken design. fails: it violates its property. status: of the check. step: the last one checked."""

    fails: bool
    wall_s: float
    status: str
    step: int | None


def prove(
    proof: Proof, engine: str, texts: dict[str, str], wrapper: str, edit: Callable[[Netlist], None] | None = None
) -> ProofResult:
    """Prove all properties of a wrapper by base and, for an induction, step. edit: changes the netlist."""
    with Workplace(texts, wrapper, proof.top, proof.assumed, edit=edit) as place:
        answer = place.check(engine, ["-t", str(proof.depth), "--presat"], proof.timeout)
        result, wall = {PASSED: PROVEN}.get(answer.status, answer.status), answer.wall_s
        if result == PROVEN and proof.method == "induction":
            answer = place.check(engine, ["-i", "-t", str(proof.depth)], proof.timeout)
            wall += answer.wall_s
            result = PROVEN if answer.status == PASSED else UNKNOWN  # a failed step is no counterexample
    failing = sorted(set(re.findall(r"Assert failed in \S+: (?:.*\()?(\w+)", answer.output)))
    return ProofResult(result, failing, round(wall, 2), "" if result == PROVEN else _last_lines(answer.output))


def cover(proof: Proof, texts: dict[str, str], wrapper: str) -> CoverResult:
    """Find which cover points are reached within cover_depth."""
    with Workplace(texts, wrapper, proof.top, proof.assumed) as place:
        answer = place.check(proof.engines[0], ["-c", "-t", str(proof.cover_depth)], proof.timeout)
    reached = set(re.findall(r"Reached cover statement(?: in step \d+)? at (?:\S+: )?(\w+)", answer.output))
    named = labels(proof.text).covers
    return CoverResult(
        [n for n in named if n in reached], [n for n in named if n not in reached], round(answer.wall_s, 2)
    )


def twin(proof: Proof, label: str, texts: dict[str, str], wrapper: str) -> TwinResult:
    """Check whether the broken design violates property ``label``."""
    depth = proof.twins[label].depth or proof.twin_depth
    with Workplace(texts, wrapper, proof.top, proof.assumed, only=label) as place:
        answer = place.check(proof.engines[0], ["-t", str(depth)], proof.timeout)
    steps = re.findall(r"Checking assertions in step (\d+)", answer.output)
    fails = answer.status == FAILED and f": {label}" in answer.output
    return TwinResult(fails, round(answer.wall_s, 2), answer.status, int(steps[-1]) if steps else None)


def _last_lines(output: str, count: int = 3) -> str:
    return " / ".join(line.strip() for line in output.strip().splitlines()[-count:])
