"""Every pytest test, one job per folder, counted by block and level: build/verify/suite.json.

A skipped test is an open point: what it checks is not checked.
"""

import argparse
import json
import shutil
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from base.jobs import Job, run
from base.paths import ROOT
from base.records import from_json
from base.sources import code
from models.parameters import ParameterError
from verif.results import OUT, BlockResults, Fault, Tests, write_step

from .blocks import blocks_of, level_of
from .pytest_folder import Case, FolderRun, folders, run_folder

PASSED, FAILED, SKIPPED = "passed", "failed", "skipped"
TOOLS = "iverilog", "yosys", "g++", "z3"  # where one is missing, tests are skipped


def jobs(wanted: Iterable[str], seconds: Mapping[str, float]) -> list[Job]:
    """Return a Job for each folder, the longest first. seconds: of each folder's last run."""
    setup = [ROOT / "pyproject.toml", *map(shutil.which, TOOLS)]
    ordered = sorted(wanted, key=lambda folder: -seconds.get(folder, 1e9))
    return [
        Job(folder.replace("/", "-"), run_folder, (folder,), (code(folder, "conftest"), *setup)) for folder in ordered
    ]


def forget(planned: Sequence[Job], done: Sequence[FolderRun], store: Path) -> None:
    """Delete the kept results with a failed or skipped test, so that the next run tries them again."""
    for job, result in zip(planned, done, strict=True):
        if any(case.outcome != PASSED for case in result.cases):
            (store / f"{job.name}.{job.digest}.json").unlink(missing_ok=True)


def summarize(done: Iterable[FolderRun]) -> dict[str, BlockResults]:
    """Return tests, simulators, faults and open points by block."""
    found: dict[str, BlockResults] = {}
    for result in done:
        for case in result.cases:
            for block in blocks_of(result.folder, case.test):
                count(found.setdefault(block, BlockResults()), result.folder, case)
    return found


def count(entry: BlockResults, folder: str, case: Case) -> None:
    """Add one case to the results of a block."""
    level = level_of(case.test)
    tests = Tests(seconds=case.seconds, levels={level: 1} if level and case.outcome == PASSED else {})
    setattr(tests, case.outcome, 1)
    entry.tests.add(tests)
    simulator = {"RTL": "PyMTL3", "FL": "", "CL": ""}.get(level, level)
    if tests.levels and simulator and simulator not in entry.simulators:
        entry.simulators.append(simulator)
    if case.outcome != PASSED:
        entry.open_points.append(f"test {case.test} = {case.outcome}: {case.message[:200]}")
    if folder.startswith("verif/faults"):
        entry.faults.append(Fault(case.test.split("::")[-1], case.outcome))


def last_seconds(store: Path) -> dict[str, float]:
    """Return the seconds that each folder took in the newest of the kept runs."""
    kept = [json.loads(path.read_text()) for path in sorted(store.glob("*.json"), key=lambda p: p.stat().st_mtime)]
    return {result["folder"]: result["seconds"] for result in kept}


def arguments() -> argparse.ArgumentParser:
    """Return the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m verif.suite", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--folder", nargs="+", metavar="NAME", help="test folders; default: all")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of suite.json; default: build/verify")
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Return 0, 1 when a test failed, 2 for a wrong argument."""
    options = arguments().parse_args(argv)
    store = options.out / "suite"
    try:
        known = folders()
        for folder in options.folder or ():
            if folder not in known:
                raise ParameterError(f"folder = {folder!r}: must be one of {', '.join(known)}")
        planned = jobs(options.folder or known, last_seconds(store) if store.exists() else {})
        done = from_json(list[FolderRun], run(planned, store, "tests"))
    except (ParameterError, OSError) as error:
        print(f"verif.suite: {error}", file=sys.stderr)
        return 2
    forget(planned, done, store)
    write_step("suite", summarize(done), options.out)
    cases = [case for result in done for case in result.cases]
    for case in cases:
        if case.outcome != PASSED:
            print(f"verif.suite: {case.test} = {case.outcome}: {case.message[:300]}", file=sys.stderr)
    counts = Counter(case.outcome for case in cases)
    print(", ".join(f"{counts[outcome]} {outcome}" for outcome in (PASSED, FAILED, SKIPPED)))
    return int(counts[FAILED] > 0)


if __name__ == "__main__":
    sys.exit(main())
