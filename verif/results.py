"""The results of every step of `make verify`: build/verify/<step>.json, one BlockResults per block."""

import json
from dataclasses import asdict, dataclass, field, fields
from math import sqrt
from pathlib import Path

from talbot.base.arguments import Number
from talbot.base.files import staged
from talbot.base.paths import RESULTS

OUT = RESULTS / "verify"
COVERAGE = "line", "branch", "expression", "toggle", "fsm", "functional"
PROVEN = "proven"
SEED = 1  # of what is random, unless --seed says otherwise


def seed_of(about: str) -> Number:
    """Return the option --seed of a command. about: what it is the seed of."""
    return Number("seed", about, 0, 2**32 - 1, str(SEED), note=str(SEED))


@dataclass
class Tests:
    """Counts of tests. levels: passed tests by level (FL, CL, RTL, Verilator, Icarus)."""

    __test__ = False  # not a test class
    passed: int = 0
    failed: int = 0
    skipped: int = 0
    seconds: float = 0.0
    levels: dict[str, int] = field(default_factory=dict)

    def add(self, other: "Tests") -> None:
        """Add the counts of ``other``."""
        for level, count in other.levels.items():
            self.levels[level] = self.levels.get(level, 0) + count
        for name in ("passed", "failed", "skipped", "seconds"):
            setattr(self, name, getattr(self, name) + getattr(other, name))


@dataclass(frozen=True)
class Property:
    """One property by one engine. depth: steps, or 'unbounded'. twin_fails: its broken design violates it."""

    name: str
    engine: str
    depth: int | str
    result: str
    twin_fails: bool
    wall_s: float

    @property
    def good(self) -> bool:
        """Return whether it is proven and its twin fails."""
        return self.result == PROVEN and self.twin_fails


@dataclass(frozen=True)
class Mutants:
    """Counts of mutants. equivalent: no input distinguishes them from the original."""

    made: int = 0
    equivalent: int = 0
    killed: int = 0
    survived: int = 0

    def plus(self, other: "Mutants") -> "Mutants":
        """Return the sum of the counts."""
        return Mutants(*(getattr(self, f.name) + getattr(other, f.name) for f in fields(self)))

    @property
    def killable(self) -> int:
        """Return the number of mutants that some input distinguishes from the original."""
        return self.made - self.equivalent

    @property
    def score(self) -> float:
        """Return the share of the killable mutants that a test kills, in %."""
        return 100.0 * self.killed / self.killable if self.killable else 100.0


@dataclass(frozen=True)
class Fault:
    """A fault at the pins, by its test, and the test's outcome."""

    fault: str
    result: str


@dataclass(frozen=True)
class StuckAt:
    """Stuck-at faults of the gates: all of them, those tried, and those of them that a test at the pins detects."""

    faults: int
    sample: int
    detected: int

    @property
    def share(self) -> float:
        """Return the share of the sample that is detected, in %."""
        return 100.0 * self.detected / self.sample

    @property
    def margin(self) -> float:
        """Return half of the 95 % interval of all faults around ``share``, in %."""
        p = self.detected / self.sample
        return 196 * sqrt(p * (1 - p) / self.sample * (1 - self.sample / self.faults))


@dataclass(frozen=True)
class Fuzz:
    """Fuzzed inputs. files: those tried through files, too. seconds_max: the slowest. kinds: inputs by kind."""

    inputs: int
    failures: int
    seed: int
    files: int = 0
    seconds_max: float = 0.0
    kinds: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Sweep:
    """Changes of every byte of a frame, ``tried`` in all; ``around``: the bytes before and after the frame.

    recovered: changes that lose nothing. row_lost: those that lose one row. failed: those that lose more, the first ten
    in failures.
    """

    frame: str
    around: str
    bytes: int
    tried: int
    recovered: int
    row_lost: int
    failures: list[str]
    failed: int


@dataclass(frozen=True)
class Resync:
    """The sums of all sweeps."""

    tried: int
    failures: int
    recovered: int
    frames: list[Sweep]


@dataclass
class BlockResults:
    """Results of one or all steps for a block. coverage: % by kind of COVERAGE, None where nothing was measured.

    excluded: coverage points left out. benches: cocotb tests by simulator. open_points: unmet requirements, one
    line each.
    """

    tests: Tests = field(default_factory=Tests)
    proofs: list[Property] = field(default_factory=list)
    coverage: dict[str, float | None] = field(default_factory=lambda: dict.fromkeys(COVERAGE))
    excluded: int = 0
    mutants: Mutants | None = None
    simulators: list[str] = field(default_factory=list)
    benches: dict[str, Tests] = field(default_factory=dict)
    faults: list[Fault] = field(default_factory=list)
    stuck_at: StuckAt | None = None
    fuzz: Fuzz | None = None
    resync: Resync | None = None
    open_points: list[str] = field(default_factory=list)

    def add(self, other: "BlockResults") -> None:
        """Add the results of another step."""
        self.tests.add(other.tests)
        self.proofs += other.proofs
        self.coverage |= {kind: value for kind, value in other.coverage.items() if value is not None}
        self.excluded += other.excluded
        self.mutants = (
            self.mutants.plus(other.mutants) if self.mutants and other.mutants else other.mutants or self.mutants
        )
        self.simulators += [name for name in other.simulators if name not in self.simulators]
        self.benches |= other.benches
        self.faults += other.faults
        self.stuck_at = other.stuck_at or self.stuck_at
        self.fuzz = other.fuzz or self.fuzz
        self.resync = other.resync or self.resync
        self.open_points += other.open_points


def write_step(step: str, by_block: dict[str, BlockResults], out: Path = OUT) -> None:
    """Write <step>.json into folder ``out``, and print its path."""
    with staged(out) as part:
        (part / f"{step}.json").write_text(
            json.dumps(by_block, indent=1, allow_nan=False, default=asdict) + "\n", encoding="utf-8"
        )
    print(out / f"{step}.json")
