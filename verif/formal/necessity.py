"""Every conjunct of every assumption is needed: without it, the proof fails."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from talbot.verif.formal.engine import UNDECIDED, Workplace
from talbot.verif.formal.netlist import Conjunct, Netlist
from talbot.verif.formal.proof import Proof
from talbot.verif.formal.prove import prove
from talbot.verif.results import PROVEN


@dataclass(frozen=True)
class NecessityResult:
    """Conjuncts by their text. needed: the proof fails without it. needless: it holds. undecided: timeouts."""

    needed: list[str] = field(default_factory=list)
    needless: list[str] = field(default_factory=list)
    wall_s: float = 0.0
    undecided: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class ConjunctResult:
    """The conjuncts of the assumptions of a proof, by their text."""

    names: list[str] = field(default_factory=list)


def conjuncts(proof: Proof, texts: dict[str, str], wrapper: str) -> ConjunctResult:
    """Return the conjuncts of the assumptions of a proof at its size; no engine runs."""
    return ConjunctResult([name for _, name in _conjuncts(proof, texts, wrapper)])


def _conjuncts(proof: Proof, texts: dict[str, str], wrapper: str) -> list[tuple[Conjunct, str]]:
    found: list[Conjunct] = []
    Workplace(
        texts,
        wrapper,
        proof.top,
        proof.assumed,
        edit=lambda netlist: found.extend(c for a in netlist.of_type("$assume") for c in netlist.conjuncts(a)),
    ).folder.cleanup()
    return [(conjunct, f"{conjunct.assumption}: {said(conjunct.source, wrapper)}") for conjunct in found]


def necessity(proof: Proof, texts: dict[str, str], wrapper: str, label: str = "") -> NecessityResult:
    """Try the proof without each conjunct of its assumptions; label: of those to try, by default all."""
    needed, needless, undecided, wall = [], [], [], 0.0
    for conjunct, name in _conjuncts(proof, texts, wrapper):
        if not conjunct.assumption.endswith(label):
            continue
        without = prove(proof, proof.engines[0], texts, wrapper, dropping(conjunct), search=False)
        wall += without.wall_s
        (needless if without.result == PROVEN else undecided if without.result in UNDECIDED else needed).append(name)
    return NecessityResult(needed, needless, round(wall, 2), undecided)


def dropping(conjunct: Conjunct) -> Callable[[Netlist], None]:
    """Return the change of a netlist that leaves ``conjunct`` out."""
    return lambda netlist: netlist.drop(conjunct)


def said(source: str, wrapper: str) -> str:
    """Return the text at a place of the wrapper ('wrapper.sv:3.5-3.20', of several the last), or the place itself."""
    places = re.findall(r"wrapper\.sv:(\d+)\.(\d+)-(\d+)\.(\d+)", source)
    if not places:
        return source
    line, begin, last, end = map(int, places[-1])
    text = wrapper.splitlines()[line - 1]
    return text[begin - 1 : end - 1] if line == last and "`" not in text else text.strip()
