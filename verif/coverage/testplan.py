"""Test plans, verif/<folder>.testplan.yaml: each promise of a block's README with its cover points and tests."""

import ast
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from talbot.base.paths import PACKAGE
from talbot.models.parameters import ParameterError, SensorParameters
from talbot.rtl.tops import TOPS, build_top
from talbot.verif.coverage.points import POINTS
from talbot.verif.formal import manifest
from talbot.verif.verilated.program import Registers

KINDS = "line", "branch", "expression", "toggle"


@dataclass(frozen=True)
class Promise:
    """A promise of a README. cover: functional cover points that exercise it. tests: those that check it."""

    promise: str
    cover: tuple[str, ...]
    tests: tuple[str, ...]


@dataclass(frozen=True)
class Machine:
    """A state machine.

    registers: those that hold its state. states: name -> value. transitions: pairs of names, outside reset. blocks:
    that have it, default all.
    """

    registers: Registers
    states: dict[str, int]
    transitions: tuple[tuple[str, str], ...]
    blocks: tuple[str, ...] = ()


@dataclass(frozen=True)
class Exclusion:
    """Points that need not be hit.

    kind: of KINDS. at: each 'Module.signal', 'Module.signal[7:4]', or 'Module: text of the line'. what: the arm or edge
    ('else', '0->1') if not all. blocks: that it holds for, default all. proof: instead of a test, of what the
    points do; a toggle has one.
    """

    kind: str
    at: tuple[str, ...]
    reason: str
    what: str = ""
    blocks: tuple[str, ...] = ()
    proof: str = ""


@dataclass(frozen=True)
class TestPlan:
    """The test plan of the blocks (of rtl.tops) in a folder of rtl/."""

    __test__ = False  # not a test class
    folder: str
    blocks: tuple[str, ...]
    promises: tuple[Promise, ...]
    machines: tuple[Machine, ...]
    exclusions: tuple[Exclusion, ...]

    def machines_of(self, block: str) -> list[Machine]:
        """Return the state machines of a block."""
        return [machine for machine in self.machines if block in (machine.blocks or self.blocks)]

    def exclusions_of(self, block: str) -> list[Exclusion]:
        """Return the exclusions that hold for a block."""
        return [exclusion for exclusion in self.exclusions if block in (exclusion.blocks or self.blocks)]

    @property
    def cover(self) -> list[str]:
        """Return the names of the functional cover points, ascending."""
        return sorted({name for promise in self.promises for name in promise.cover})


@cache
def folder_of(block: str) -> str:
    """Return the folder of a block of rtl.tops below rtl/."""
    return type(build_top(block, SensorParameters())).__module__.split(".")[2]


def plan_file(folder: str) -> Path:
    """Return the test plan of a folder of rtl/."""
    return PACKAGE / "verif" / f"{folder}.testplan.yaml"


def load_plan(path: Path) -> TestPlan:
    """Return the TestPlan of a file, checked. Raises ParameterError that names the field."""
    try:
        raw = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise ParameterError(f"testplan = {path}: {error}") from None
    name = path.name
    _keys(name, raw, {"blocks", "promises", "fsm", "exclude"}, {"blocks", "promises"})
    folder = name.removesuffix(".testplan.yaml")
    blocks = _texts(f"{name}: blocks", raw["blocks"])
    for block in blocks:
        if block not in TOPS or folder_of(block) != folder:
            raise ParameterError(f"{name}: blocks = {block!r}: must be a top in rtl/{folder}")
    plan = TestPlan(
        folder,
        blocks,
        tuple(_promise(f"{name}: promises[{i}]", entry) for i, entry in enumerate(raw["promises"])),
        tuple(_machine(f"{name}: fsm[{i}]", entry, blocks) for i, entry in enumerate(raw.get("fsm") or ())),
        tuple(_exclusion(f"{name}: exclude[{i}]", entry, blocks) for i, entry in enumerate(raw.get("exclude") or ())),
    )
    _check_tests(name, plan)
    _check_cover(name, plan)
    return plan


def _keys(field: str, entry: object, allowed: Collection[str], needed: Iterable[str]) -> dict[str, Any]:
    if not isinstance(entry, dict):
        raise ParameterError(f"{field} = {entry!r}: must be a mapping of {', '.join(sorted(allowed))}")
    for key in entry:
        if key not in allowed:
            raise ParameterError(
                f"{field}.{key} = {entry[key]!r}: unknown key, must be one of {', '.join(sorted(allowed))}"
            )
    for key in needed:
        if not entry.get(key):
            raise ParameterError(f"{field}.{key} = {entry.get(key)!r}: must be given and not empty")
    return entry


def _entry(field: str, entry: object, kind: type[Promise | Machine | Exclusion]) -> dict[str, Any]:
    """Return the mapping ``entry``, whose keys must be the fields of ``kind``."""
    required = {f.name for f in fields(kind) if f.default is f.default_factory}
    return _keys(field, entry, {f.name for f in fields(kind)}, required)


def _texts(field: str, value: object) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(text, str) and text for text in value):
        raise ParameterError(f"{field} = {value!r}: must be a list of texts")
    if len(set(value)) != len(value):
        raise ParameterError(f"{field} = {value!r}: must name each once")
    return tuple(value)


def _promise(field: str, entry: object) -> Promise:
    entry = _entry(field, entry, Promise)
    return Promise(
        str(entry["promise"]), _texts(f"{field}.cover", entry["cover"]), _texts(f"{field}.tests", entry["tests"])
    )


def _blocks(field: str, entry: dict[str, Any], blocks: Sequence[str]) -> tuple[str, ...]:
    named = _texts(f"{field}.blocks", entry.get("blocks", []))
    for block in named:
        if block not in blocks:
            raise ParameterError(f"{field}.blocks = {block!r}: must be one of {', '.join(blocks)}")
    return named


def _machine(field: str, entry: object, blocks: Sequence[str]) -> Machine:
    entry = _entry(field, entry, Machine)
    states = entry["states"]
    if not isinstance(states, dict) or len(set(states.values())) != len(states):
        raise ParameterError(f"{field}.states = {states!r}: must map names to different numbers")
    steps = []
    for text in _texts(f"{field}.transitions", entry["transitions"]):
        start, _, end = (part.strip() for part in text.partition(">"))
        if start not in states or end not in states:
            raise ParameterError(f"{field}.transitions = {text!r}: must be 'state > state' of {', '.join(states)}")
        steps.append((start, end))
    registers = entry["registers"]
    if not isinstance(registers, dict) or not all(isinstance(n, int) and 1 <= n <= 32 for n in registers.values()):
        raise ParameterError(f"{field}.registers = {registers!r}: must map names to bits, 1..32")
    return Machine(tuple(registers.items()), states, tuple(steps), _blocks(field, entry, blocks))


def _exclusion(field: str, entry: object, blocks: Sequence[str]) -> Exclusion:
    entry = _entry(field, entry, Exclusion)
    if entry["kind"] not in KINDS:
        raise ParameterError(f"{field}.kind = {entry['kind']!r}: must be one of {', '.join(KINDS)}")
    proof = entry.get("proof", "")
    if (proof or entry["kind"] == "toggle") and proof not in proofs():
        raise ParameterError(f"{field}.proof = {proof!r}: must be a proof of rtl/*/formal/proofs.yaml")
    return Exclusion(
        entry["kind"],
        _texts(f"{field}.at", entry["at"]),
        str(entry["reason"]),
        str(entry.get("what", "")),
        _blocks(field, entry, blocks),
        proof,
    )


@cache
def proofs() -> frozenset[str]:
    """Return the names of all proofs."""
    return frozenset(proof.name for proof in manifest.every())


@cache
def tests_in(folder: str) -> frozenset[str]:
    """Return the names of the test functions in the files of ``folder``, methods too."""
    return frozenset(name for path in sorted((PACKAGE / folder).glob("*_test.py")) for name in _tests_of(path))


def _tests_of(path: Path) -> set[str]:
    return {
        node.name
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test")
    }


def _check_tests(name: str, plan: TestPlan) -> None:
    """Check that every test exists: a function's name in rtl/<folder>/test, or 'path/to/file_test.py::function'."""
    for i, promise in enumerate(plan.promises):
        for test in promise.tests:
            file, _, function = test.rpartition("::")
            path, names = PACKAGE / file, tests_in(f"rtl/{plan.folder}/test")
            if function not in (names if not file else _tests_of(path) if path.is_file() else ()):
                raise ParameterError(f"{name}: promises[{i}].tests = {test!r}: no such test")


def _check_cover(name: str, plan: TestPlan) -> None:
    """Check that every cover point of the plan is in verif/coverage/points/<folder>.py, and the other way round."""
    defined = set(POINTS[plan.folder])
    for i, promise in enumerate(plan.promises):
        for point in promise.cover:
            if point not in defined:
                raise ParameterError(f"{name}: promises[{i}].cover = {point!r}: must be in points/{plan.folder}.py")
    if unused := defined - set(plan.cover):
        raise ParameterError(f"{name}: promises.cover = {sorted(unused)}: cover points that belong to no promise")
