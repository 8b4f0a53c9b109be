"""The steps of `make verify`, each a process that writes build/verify/<name>.json."""

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from talbot.base.paths import ROOT
from talbot.base.records import from_json
from talbot.verif.results import SEED, BlockResults

TALBOT = [sys.executable, "-m", "talbot"]


@dataclass(frozen=True)
class Step:
    """A step. name: of its file, <name>.json. command: of `talbot`. title: for people. seeded: it has --seed."""

    name: str
    command: str
    title: str
    seeded: bool = False


STEPS = (
    Step("formal", "formal", "proofs and their mutated twins"),
    Step("suite", "suite", "tests of every block at every level", True),
    Step("bench", "cocotb", "cocotb benches in Icarus and Verilator", True),
    Step("coverage", "coverage", "coverage and test plans"),
    Step("mutation", "mutate", "mutants"),
    Step("stuck_at", "stuck-at", "stuck-at faults by a test at the pins"),
    Step("fuzz", "fuzz", "fuzz and resynchronisation", True),
)


@dataclass(frozen=True)
class Outcome:
    """Result of a step. problem: one line, '' where it wrote its results. by_block: these."""

    step: Step
    seconds: float
    problem: str
    by_block: dict[str, BlockResults]


def run_step(step: Step, out: Path, seed: int = SEED) -> Outcome:
    """Run a step, its output on this terminal. Results of an earlier run are removed first."""
    results = out / f"{step.name}.json"
    results.unlink(missing_ok=True)
    start = perf_counter()
    options = ["--out", out.resolve(), *(["--seed", str(seed)] if step.seeded else [])]
    status = subprocess.run([*TALBOT, step.command, *options], cwd=ROOT).returncode
    seconds = perf_counter() - start
    problem = "" if status in (0, 1) else f"step {step.name} = exit status {status}: must be 0 (see its output)"
    by_block, unread = read_step(step, out)
    if status == 1 and not unread and not explained(by_block):
        problem = f"step {step.name} = exit status 1: its results name no failed test or open point"
    return Outcome(step, seconds, problem or unread, by_block)


def explained(by_block: dict[str, BlockResults]) -> bool:
    """Return whether the results say why their step ended with status 1."""
    return any(entry.open_points or entry.tests.failed for entry in by_block.values())


def read_step(step: Step, out: Path) -> tuple[dict[str, BlockResults], str]:
    """Return the results of a step that has run, and '' or what is wrong with the file."""
    try:
        return from_json(
            dict[str, BlockResults], json.loads((out / f"{step.name}.json").read_text(encoding="utf-8"))
        ), ""
    except FileNotFoundError:
        return {}, f"step {step.name} = no results: {step.name}.json is missing"
    except ValueError as error:
        return {}, f"step {step.name} = no results: {step.name}.json: {error}"
    except (AttributeError, KeyError, TypeError):
        return {}, f"step {step.name} = no results: {step.name}.json is no dict of blocks"
