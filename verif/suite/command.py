"""Every pytest test, one job per folder, counted by block and level: build/verify/suite.json.

A skipped test is an open point, unless it needs what neither Debian nor PyPI offer for every machine (verif.needs).
"""

import shlex
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from talbot.base.command import failures
from talbot.base.jobs import Job, kept
from talbot.base.jobs import run as run_jobs
from talbot.base.paths import ROOT
from talbot.base.records import from_json
from talbot.base.sources import code
from talbot.base.tools import located
from talbot.models.parameters import ParameterError
from talbot.verif.needs import NEEDS, needs_in
from talbot.verif.results import OUT, SEED, BlockResults, Fault, Tests, seed_of, write_step
from talbot.verif.suite.blocks import blocks_of, level_of
from talbot.verif.suite.pytest_folder import Case, FolderRun, folders, run_folder

PASSED, FAILED, SKIPPED = "passed", "failed", "skipped"
TOOLS = "iverilog", "yosys", "g++", "z3"  # where one is missing, tests are skipped


def options_of(seed: int) -> tuple[str, ...]:
    """Return the options of pytest: slow tests, too, and the seed of the random ones."""
    return "--all", "--hypothesis-profile=seeded", f"--hypothesis-seed={seed}"


def jobs(paths: Iterable[str], seconds: Mapping[str, float], seed: int = SEED) -> list[Job]:
    """Return a Job for each folder, the longest first. seconds: of each folder's last run."""
    setup = [ROOT / "pyproject.toml", seed, *map(located, TOOLS)]
    ordered = sorted(paths, key=lambda folder: -seconds.get(folder, 1e9))
    return [
        Job(folder.replace("/", "-"), run_folder, (folder, options_of(seed)), (code(folder, "conftest"), *setup))
        for folder in ordered
    ]


def forget(planned: Sequence[Job], done: Sequence[FolderRun], store: Path) -> None:
    """Delete the kept results with a failed or skipped test, so that the next run tries them again."""
    for job, result in zip(planned, done, strict=True):
        if any(case.outcome != PASSED for case in result.cases):
            job.file(store).unlink(missing_ok=True)


def summarize(done: Iterable[FolderRun]) -> dict[str, BlockResults]:
    """Return tests, simulators, faults and open points by block."""
    results: dict[str, BlockResults] = {}
    for result in done:
        for case in result.cases:
            for block in blocks_of(result.folder, case.test):
                count(results.setdefault(block, BlockResults()), result.folder, case)
    return results


def count(entry: BlockResults, folder: str, case: Case) -> None:
    """Add one case to the results of a block."""
    level = level_of(case.test)
    tests = Tests(seconds=case.seconds, levels={level: 1} if level and case.outcome == PASSED else {})
    setattr(tests, case.outcome, 1)
    entry.tests.add(tests)
    simulator = {"RTL": "PyMTL3", "FL": "", "CL": ""}.get(level, level)
    if tests.levels and simulator and simulator not in entry.simulators:
        entry.simulators.append(simulator)
    if case.outcome == FAILED or case.outcome == SKIPPED and not is_left_out(case.message):
        entry.open_points.append(f"test {case.test} = {case.outcome}: {case.message[:200]}")
    if folder.startswith("verif/faults"):
        entry.faults.append(Fault(case.test.split("::")[-1], case.outcome))


def is_left_out(reason: str) -> bool:
    """Return whether a test was skipped for want of what `make` does not install."""
    names = needs_in(reason)
    return bool(names) and not any(NEEDS[name].offered for name in names)


def last_seconds(store: Path) -> dict[str, float]:
    """Return the seconds that each folder took in the newest of the kept runs."""
    paths = sorted(store.glob("*.json"), key=lambda path: path.stat().st_mtime)
    return {result["folder"]: result["seconds"] for path in paths for result in kept(path)}


SEED_OPTION = seed_of("of Hypothesis")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot suite`."""
    parser.add_argument("--folder", nargs="+", metavar="NAME", help="test folders; default: all")
    SEED_OPTION.add(parser)
    parser.add_argument("--out", type=Path, default=OUT, help="folder of suite.json")


def run(options: Namespace) -> int:
    """Return 0, 1 when a test failed."""
    store = options.out / "suite"
    seed = SEED_OPTION.value(options)
    every = folders()
    for folder in options.folder or ():
        if folder not in every:
            raise ParameterError(f"folder = {folder!r}: must be a folder of tests, as {every[0]}")
    planned = jobs(options.folder or every, last_seconds(store) if store.exists() else {}, seed)
    done = from_json(list[FolderRun], run_jobs(planned, store, "tests"))
    forget(planned, done, store)
    write_step("suite", summarize(done), options.out)
    cases = [case for result in done for case in result.cases]
    failures(f"{case.test} = {case.outcome}: {case.message[:300]}" for case in cases if case.outcome != PASSED)
    if failed := [case.test for case in cases if case.outcome == FAILED]:
        print(f"again: python -m pytest {' '.join((*options_of(seed), *map(shlex.quote, failed[:10])))}")
    counts = Counter(case.outcome for case in cases)
    print(", ".join(f"{counts[outcome]} {outcome}" for outcome in (PASSED, FAILED, SKIPPED)))
    return int(counts[FAILED] > 0)
