"""`python -m verif.suite`: every pytest test, a folder a job, counted by block and level: build/verify/suite.json.

A test that is skipped is an open point: what it would have shown is not shown.
"""

import argparse
import json
import shutil
import sys
from pathlib import Path

from base.jobs import Job, run
from base.paths import ROOT
from base.sources import code
from models.parameters import ParameterError
from verif.results import OUT, write_step

from .blocks import blocks_of, level_of
from .pytest_folder import folders, run_folder

FAILED = "failed"
TOOLS = "iverilog", "yosys", "g++", "z3"  # where one is missing, tests are skipped


def jobs(wanted, seconds):
    """A Job a folder, the longest first. seconds: dict folder -> of its last run."""
    setup = [ROOT / "pyproject.toml", *map(shutil.which, TOOLS)]
    ordered = sorted(wanted, key=lambda folder: -seconds.get(folder, 1e9))
    return [
        Job(folder.replace("/", "-"), run_folder, (folder,), (code(folder, "conftest"), *setup)) for folder in ordered
    ]


def forget(planned, done, store):
    """Drop the kept results with a failed or skipped test, so that the next run tries them again."""
    for job, result in zip(planned, done, strict=True):
        if any(case["outcome"] != "passed" for case in result["cases"]):
            (store / f"{job.name}.{job.digest}.json").unlink(missing_ok=True)


def summarize(done):
    """By block: tests {passed, failed, skipped, seconds, levels, simulators, failures}, faults, open_points."""
    found = {}
    for result in done:
        for case in result["cases"]:
            for block in blocks_of(result["folder"], case["test"]):
                count(found.setdefault(block, empty()), result["folder"], case)
    return found


def empty():
    return {
        "tests": {"passed": 0, "failed": 0, "skipped": 0, "seconds": 0.0, "levels": {}, "failures": []},
        "simulators": [],
        "faults": [],
        "open_points": [],
    }


def count(entry, folder, case):
    """Add one case to a block's entry."""
    tests, outcome, level = entry["tests"], case["outcome"], level_of(case["test"])
    tests[outcome] += 1
    tests["seconds"] += case["seconds"]
    if level and outcome == "passed":
        tests["levels"][level] = tests["levels"].get(level, 0) + 1
        simulator = {"RTL": "PyMTL3"}.get(level, level)
        if level not in ("FL", "CL") and simulator not in entry["simulators"]:
            entry["simulators"].append(simulator)
    if outcome == FAILED:
        tests["failures"].append({"test": case["test"], "message": case["message"]})
        entry["open_points"].append(f"test {case['test']} = failed: {case['message'][:200]}")
    elif outcome == "skipped":
        entry["open_points"].append(f"test {case['test']} = skipped: {case['message'][:200]}")
    if folder.startswith("verif/faults"):
        entry["faults"].append({"fault": case["test"].split("::")[-1], "result": outcome})


def last_seconds(store):
    """Seconds that each folder took in the newest of the kept runs: dict."""
    found = {}
    for path in sorted(store.glob("*.json"), key=lambda p: p.stat().st_mtime):
        result = json.loads(path.read_text())
        found[result["folder"]] = result["seconds"]
    return found


def arguments():
    parser = argparse.ArgumentParser(
        prog="python -m verif.suite",
        description=__doc__.split("`: ")[1],
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--folder", nargs="+", metavar="NAME", help="test folders; default: every one")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of suite.json; default: build/verify")
    return parser


def main(argv=None):
    """Returns 0, 1 when a test failed, 2 for a wrong argument."""
    options = arguments().parse_args(argv)
    store = options.out / "suite"
    try:
        known = folders()
        for folder in options.folder or ():
            if folder not in known:
                raise ParameterError(f"folder = {folder!r}: must be one of {', '.join(known)}")
        planned = jobs(options.folder or known, last_seconds(store) if store.exists() else {})
        done = run(planned, store, "tests")
    except (ParameterError, OSError) as error:
        print(f"verif.suite: {error}", file=sys.stderr)
        return 2
    forget(planned, done, store)
    found = summarize(done)
    write_step("suite", found, options.out)
    cases = [case for result in done for case in result["cases"]]
    for case in cases:
        if case["outcome"] != "passed":
            print(f"verif.suite: {case['test']} = {case['outcome']}: {case['message'][:300]}", file=sys.stderr)
    print(", ".join(f"{sum(c['outcome'] == o for c in cases)} {o}" for o in ("passed", "failed", "skipped")))
    return int(any(case["outcome"] == FAILED for case in cases))


if __name__ == "__main__":
    sys.exit(main())
