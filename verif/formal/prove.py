"""The independent pieces of a proof, as jobs: base and step with each engine, the covers, each property's twin."""

import re
from collections.abc import Callable
from dataclasses import dataclass

from talbot.verif.formal.engine import FAILED, PASSED, UNDECIDED, Answer, Workplace, smt2
from talbot.verif.formal.netlist import Netlist
from talbot.verif.formal.proof import Proof, labels
from talbot.verif.results import PROVEN

COUNTEREXAMPLE, TOO_WEAK = "counterexample", "induction too weak"


@dataclass(frozen=True)
class ProofResult:
    """One engine on all properties.

    result: PROVEN; COUNTEREXAMPLE, from reset; TOO_WEAK, a step from a state that may be unreachable, and no
    counterexample within twin_depth; or one of UNDECIDED. failing: assertions. output: its last lines.
    """

    result: str
    failing: list[str]
    wall_s: float
    output: str

    def cause(self, proof: Proof) -> str:
        """Return what fails and, where there is a trace, the command that shows it."""
        trace = f"; talbot formal --proof {proof.name} --show" if self.result in (COUNTEREXAMPLE, TOO_WEAK) else ""
        return (", ".join(self.failing) or self.output) + trace


@dataclass(frozen=True)
class CoverResult:
    """The cover points that are reached and those that are not. status: one of UNDECIDED, or ''."""

    reached: list[str]
    missing: list[str]
    wall_s: float
    status: str = ""


@dataclass(frozen=True)
class TwinResult:
    """A broken design. fails: it violates its property. status: of the check. step: the last one checked."""

    fails: bool
    wall_s: float
    status: str
    step: int | None


def prove(
    proof: Proof,
    engine: str,
    texts: dict[str, str],
    wrapper: str,
    edit: Callable[[Netlist], None] | None = None,
    search: bool = True,
) -> ProofResult:
    """Prove all properties of a wrapper by base and, for an induction, step.

    edit: changes the netlist. search: whether to look for a counterexample of a property where the step fails.
    """
    result = PROVEN
    with Workplace(texts, wrapper, proof.top, proof.assumed, edit=edit) as place:
        answer = place.check(engine, ["-t", str(proof.depth), "--presat"], proof.timeout)
        wall = answer.wall_s
        if answer.status != PASSED:
            result = COUNTEREXAMPLE if answer.status == FAILED else answer.status
        elif proof.method == "induction":
            answer = place.check(engine, ["-i", "-t", str(proof.depth)], proof.timeout)
            wall += answer.wall_s
            if answer.status != PASSED:
                result = TOO_WEAK if answer.status == FAILED else answer.status
    failing = failed(answer)
    if search and result in (COUNTEREXAMPLE, TOO_WEAK) and (result == TOO_WEAK or is_invariants(failing)):
        with Workplace(texts, wrapper, proof.top, proof.assumed, smt2(invariants=False), edit) as place:
            longer = place.check(engine, ["-t", str(max(proof.depth, proof.twin_depth))], proof.timeout)
        wall += longer.wall_s
        if longer.status == FAILED:
            result, failing, answer = COUNTEREXAMPLE, failed(longer), longer
    return ProofResult(result, failing, round(wall, 2), "" if result == PROVEN else _last_lines(answer.output))


def failed(answer: Answer) -> list[str]:
    """Return the labels of the assertions that fail."""
    return sorted(set(re.findall(r"Assert failed in \S+: (?:.*\()?([\w.]+)", answer.output)))


def is_invariants(names: list[str]) -> bool:
    """Return whether invariants alone fail."""
    return all(name.startswith("inv_") for name in names)


def cover(proof: Proof, texts: dict[str, str], wrapper: str) -> CoverResult:
    """Find which cover points are reached within cover_depth."""
    with Workplace(texts, wrapper, proof.top, proof.assumed) as place:
        answer = place.check(proof.engines[0], ["-c", "-t", str(proof.cover_depth)], proof.timeout)
    reached = set(re.findall(r"Reached cover statement(?: in step \d+)? at (?:\S+: )?(\w+)", answer.output))
    named = labels(proof.text).covers
    return CoverResult(
        [n for n in named if n in reached],
        [n for n in named if n not in reached],
        round(answer.wall_s, 2),
        answer.status if answer.status in UNDECIDED else "",
    )


def twin(proof: Proof, label: str, texts: dict[str, str], wrapper: str) -> TwinResult:
    """Check whether the broken design violates property ``label``."""
    depth = proof.twins[label].depth or proof.twin_depth
    with Workplace(texts, wrapper, proof.top, proof.assumed, smt2(label)) as place:
        answer = place.check(proof.engines[0], ["-t", str(depth)], proof.timeout)
    steps = re.findall(r"Checking assertions in step (\d+)", answer.output)
    fails = answer.status == FAILED and f": {label}" in answer.output
    return TwinResult(fails, round(answer.wall_s, 2), answer.status, int(steps[-1]) if steps else None)


def _last_lines(output: str, count: int = 3) -> str:
    return " / ".join(line.strip() for line in output.strip().splitlines()[-count:])
