"""Every assumption has an owner: a property proven of the block that drives the input, or the interface contract.

The property must have the same text on the other side, in every cycle in which the assumption is made. A line of the
contract (docs/chip.md) is checked at run time in the whole chip (`verif.formal.contract`).
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from talbot.base.paths import ROOT
from talbot.models.parameters import ParameterError
from talbot.verif.formal.proof import Owner, Proof

CONTRACT = ROOT / "docs" / "chip.md"
STATEMENT = r"\b(?P<label>\w+)\s*:\s*(?P<kind>assert|assume|cover)\s*\("
TOKEN = re.compile(r"\\\S+|\w+|[^\s\w]")
LATER = "!first"  # after the first reset, from which every proof begins


@dataclass(frozen=True)
class Statement:
    """An assertion or assumption. condition: its tokens. guards: tokens of each condition of the `if`s around it."""

    kind: str
    condition: tuple[str, ...]
    guards: frozenset[tuple[str, ...]] = field(default_factory=frozenset)


def statements(text: str) -> dict[str, Statement]:
    """Return the labelled statements of a wrapper."""
    plain = re.sub(r"//.*|/\*[\s\S]*?\*/", "", text)
    labelled: dict[str, Statement] = {}
    blocks: list[list[str]] = []  # of each open begin, its conditions
    pending: list[str] = []  # conditions of the next statement or begin
    before: list[str] = []  # conditions of the statement or block that has ended, for an else
    at = 0
    for match in re.finditer(rf"\bif\s*\(|\belse\b|\bbegin\b|\bend\b|;|{STATEMENT}", plain):
        if match.start() < at:
            continue
        word = match[0].split("(")[0].strip()
        if word == "if":
            condition, at = _parenthesis(plain, match.end() - 1)
            pending.append(condition)
        elif match["label"]:
            condition, at = _parenthesis(plain, match.end() - 1)
            guards = {part for block in [*blocks, pending] for text in block for part in _conjuncts(text)}
            labelled[match["label"]] = Statement(match["kind"], tokens(condition), frozenset(guards))
        elif word == "begin":
            blocks.append(pending)
            pending = []
        elif word == "else":
            pending = [f"!({before[-1]})" if not before[-1].isidentifier() else f"!{before[-1]}"] if before else []
        elif word == "end":
            before = blocks.pop() if blocks else []
        elif pending:
            before, pending = pending, []
    return labelled


def _parenthesis(text: str, at: int) -> tuple[str, int]:
    """Return the text between the parenthesis at ``at`` and its other half, and the place after that."""
    depth = 0
    for i in range(at, len(text)):
        depth += {"(": 1, ")": -1}.get(text[i], 0)
        if not depth:
            return text[at + 1 : i], i + 1
    raise ParameterError(f"statement = {text[at : at + 40]!r}: must have a closing parenthesis")


def _conjuncts(condition: str) -> Iterable[tuple[str, ...]]:
    """Return the operands of a conjunction, each as tokens; the whole where another operator is outside parentheses."""
    parts, depth, last = [], 0, 0
    for i, letter in enumerate(condition):
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if not depth and condition[i : i + 2] in ("||", "? "):
            return [tokens(condition)]
        if not depth and condition[i : i + 2] == "&&":
            parts.append(condition[last:i])
            last = i + 2
    return [tokens(part) for part in (*parts, condition[last:])]


def tokens(text: str) -> tuple[str, ...]:
    """Return the tokens of an expression; a name in the design, '\\dut.packer.ready', is one."""
    return tuple(TOKEN.findall(text))


def renamed(words: Iterable[str], names: Mapping[str, str]) -> tuple[str, ...]:
    """Return tokens with the names of the other side."""
    return tuple(word for name in words for word in tokens(names.get(name, name)))


def contract(document: Path = CONTRACT) -> list[str]:
    """Return the names of the lines of the interface contract, a table of ``document``."""
    text = document.read_text(encoding="utf-8")
    _, _, section = text.partition("## Interface contract\n")
    return re.findall(r"(?m)^\| `(\w+)` \|", section.partition("\n## ")[0])


def problems(proofs: Iterable[Proof], lines: Iterable[str]) -> list[str]:
    """Return a line for each assumption without an owner, and each line of the contract that no proof assumes.

    lines: names of the contract's.
    """
    proofs, lines = list(proofs), list(lines)
    by_name = {proof.name: proof for proof in proofs}
    faults, used = [], set()
    for proof in proofs:
        if proof.size_of:
            continue
        texts = statements(proof.text)
        for label, owner in proof.assumptions.items():
            name = f"{proof.block}.{proof.name}.{label}"
            if owner.contract:
                used.add(owner.contract)
                if owner.contract not in lines:
                    faults.append(f"{name} = contract {owner.contract}: must be a line of the contract in docs/chip.md")
            elif owner.proven:
                faults += [f"{name} = {text}" for text in _unproven(texts[label], owner, by_name)]
            elif not _is_definition(proof.text, texts[label]):
                faults.append(f"{name} = no owner: must be proven of a neighbour, or in the contract of docs/chip.md")
    faults += [f"contract {line} = no assumption: must be one of a proof" for line in lines if line not in used]
    return sorted(set(faults))


def _unproven(assumption: Statement, owner: Owner, by_name: Mapping[str, Proof]) -> list[str]:
    """Return what is wrong with the property that an assumption names, in one line, or nothing."""
    name, _, label = owner.proven.partition(".")
    proof = by_name.get(name)
    other = statements(proof.text).get(label) if proof else None
    if not other or other.kind != "assert":
        return [f"{owner.proven}: must be an assertion of a proof"]
    if renamed(assumption.condition, owner.names) != other.condition:
        return [f"{' '.join(assumption.condition)}: must be the text of {owner.proven}, {' '.join(other.condition)}"]
    guards = {renamed(guard, owner.names) for guard in assumption.guards} | {tokens(LATER)}
    if odd := other.guards - guards:
        return [f"{owner.proven} under {' and '.join(map(' '.join, odd))}: must hold wherever it is assumed"]
    if tokens(LATER) in other.guards and tokens(LATER) not in assumption.guards:
        return [f"{owner.proven}: must be assumed after the first cycle only, as it is proven"]
    return []


def _is_definition(text: str, assumption: Statement) -> bool:
    """Return whether an assumption defines a free constant of the wrapper, which is no input of the block."""
    name, *rest = assumption.condition
    constant = re.search(rf"\(\* anyconst \*\) wire [^;]*\b{re.escape(name)};", text)
    return bool(constant) and rest[:2] == ["=", "="] and name not in rest and f"({name})" not in text


def parse(label: str, entry: object) -> Owner:
    """Return the owner of an assumption from proofs.yaml. Raises ParameterError."""
    if entry == "definition":
        return Owner()
    if isinstance(entry, dict) and entry.keys() in ({"contract"}, {"proven"}, {"proven", "names"}):
        return Owner(**entry)
    raise ParameterError(
        f"assumptions.{label} = {entry}: must be definition, {{contract: LINE}} or {{proven: PROOF.LABEL, names: ...}}"
    )
