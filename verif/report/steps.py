"""The steps of `make verify`, each a process that leaves build/verify/<file>.json."""

import importlib.util
import json
import subprocess
import sys
from dataclasses import dataclass
from time import perf_counter

from verif.results import ROOT


@dataclass(frozen=True)
class Step:
    """name: also its file's, <name>.json. module: run as ``python -m``. title: for people."""

    name: str
    module: str
    title: str


STEPS = (
    Step("formal", "verif.formal", "proofs and their broken twins"),
    Step("suite", "verif.suite", "tests of every block at every level"),
    Step("bench", "verif.bench", "cocotb benches in Icarus and Verilator"),
    Step("coverage", "verif.coverage", "coverage and test plans"),
    Step("mutation", "verif.mutation", "mutants"),
    Step("fuzz", "verif.fuzz", "fuzz and resynchronisation"),
)


@dataclass(frozen=True)
class Outcome:
    """How a step ended. problem: one line, or '' when it left its results, whatever they are. by_block: these."""

    step: Step
    seconds: float
    problem: str
    by_block: dict


def run_step(step, out):
    """Run a step, its output on this terminal; returns Outcome. Results of an earlier run are removed first."""
    results = out / f"{step.name}.json"
    results.unlink(missing_ok=True)
    if not exists(step.module):
        return Outcome(step, 0.0, f"step {step.name} = missing: there is no module {step.module}", {})
    start = perf_counter()
    status = subprocess.run([sys.executable, "-m", step.module], cwd=ROOT).returncode
    seconds = perf_counter() - start
    problem = "" if status in (0, 1) else f"step {step.name} = exit status {status}: must be 0 (see what it said)"
    by_block, unread = read_step(step, out)
    if status == 1 and not unread and not explained(by_block):
        problem = f"step {step.name} = exit status 1: its results name no failed test or open point for it"
    return Outcome(step, seconds, problem or unread, by_block)


def explained(by_block):
    """True when the results tell why their step ended with status 1."""
    return any(entry.get("open_points") or entry.get("tests", {}).get("failed") for entry in by_block.values())


def exists(module):
    """True when ``python -m module`` has something to run."""
    try:
        return importlib.util.find_spec(f"{module}.__main__") is not None
    except ModuleNotFoundError:
        return False


def read_step(step, out):
    """(results by block, '' or what is wrong with the file) of a step that has run."""
    try:
        by_block = json.loads((out / f"{step.name}.json").read_text())
    except FileNotFoundError:
        return {}, f"step {step.name} = no results: {step.name}.json is missing"
    except ValueError as error:
        return {}, f"step {step.name} = no results: {step.name}.json: {error}"
    if not isinstance(by_block, dict) or not all(isinstance(entry, dict) for entry in by_block.values()):
        return {}, f"step {step.name} = no results: {step.name}.json is no dict of blocks"
    return by_block, ""
