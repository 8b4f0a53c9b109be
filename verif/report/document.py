"""The table of docs/results/verification.md: what each step found, in which time, of which commit."""

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

from talbot.base.files import insert, write
from talbot.base.records import from_json
from talbot.base.tools import commit
from talbot.verif.report.merge import summarize
from talbot.verif.report.steps import Outcome
from talbot.verif.results import BlockResults

FILE = "runs.json"


@dataclass(frozen=True)
class Run:
    """When a step ran. date: UTC. commit: '' outside git, with + where files differ. load: of the machine before."""

    date: str
    commit: str
    seconds: float
    load: float


def record(done: Sequence[Outcome], out: Path, load: float) -> dict[str, Run]:
    """Add the steps that ran to ``out``/runs.json; returns all that are recorded there."""
    path = out / FILE
    try:
        runs = from_json(dict[str, Run], json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, AttributeError, KeyError, TypeError):  # there is none, or it is damaged
        runs = {}
    now = f"{datetime.now(UTC):%Y-%m-%d %H:%M}"
    for outcome in done:
        if outcome.seconds:
            runs[outcome.step.name] = Run(now, commit(), round(outcome.seconds, 1), round(load, 1))
    write(path, json.dumps({name: asdict(run) for name, run in runs.items()}, indent=1) + "\n")
    return runs


def figures(by_block: Mapping[str, BlockResults]) -> str:
    """Return the figures of one step's results in a line."""
    entries = [*summarize([by_block]).values()]
    proofs = [proof for entry in entries for proof in entry.proofs]
    mutants = [entry.mutants for entry in entries if entry.mutants]
    stuck = [entry.stuck_at for entry in entries if entry.stuck_at]
    fuzz = [entry.fuzz for entry in entries if entry.fuzz]
    cycles = sum(f.kinds.get("cycles", 0) for f in fuzz)
    tests = sum(entry.tests.passed for entry in entries)
    lowest = [value for entry in entries for value in entry.coverage.values() if value is not None]
    points = sum(len(entry.open_points) for entry in entries)
    parts = [
        f"{sum(proof.good for proof in proofs):,} of {len(proofs):,} properties proven, twin caught" if proofs else "",
        f"{tests:,} tests passed" if tests else "",
        f"lowest coverage {min(lowest):.1f} %" if lowest else "",
        f"{sum(m.killed for m in mutants):,} of {sum(m.killable for m in mutants):,} mutants killed" if mutants else "",
        *(f"{s.share:.1f} ± {s.margin:.1f} % of stuck-at faults detected" for s in stuck),
        f"{sum(f.inputs for f in fuzz):,} inputs, {sum(f.failures for f in fuzz)} failures" if fuzz else "",
        f"{cycles:,} cycles of guided sessions" if cycles else "",
        f"{points} open points",
    ]
    return ", ".join(part for part in parts if part)


def table(done: Sequence[Outcome], runs: Mapping[str, Run]) -> str:
    """Return the steps that ran as a Markdown table, and a line with the others."""
    rows = ["| step | found | s | date (UTC) | commit | load before |", "|---|---|---:|---|---|---:|"]
    absent: list[str] = []
    for outcome in done:
        name = outcome.step.name
        if (run := runs.get(name)) is None:
            absent.append(name)
            continue
        done_at = f"{run.seconds:,.0f}", run.date, run.commit, f"{run.load:.1f}"
        cells = (outcome.problem, "", "", "", "") if outcome.problem else (figures(outcome.by_block), *done_at)
        rows.append(f"| {' | '.join((name, *cells))} |")
    return "\n".join([*rows, *(["", f"Not run: {', '.join(absent)}."] if absent else [])])


def put(document: Path, done: Sequence[Outcome], runs: Mapping[str, Run]) -> None:
    """Write the table of steps into ``document``. Raises ParameterError where it lacks its marks."""
    insert(document, "steps", table(done, runs))


def load() -> float:
    """Return the load of the machine in the last minute."""
    return os.getloadavg()[0]
