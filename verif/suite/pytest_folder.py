"""The tests of one folder in a process of their own: what passed, failed and was left out, and how long it took."""

import re
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

from base.tools import ToolTimeout, finish
from verif.results import ROOT

TESTED = "models", "base", "rtl", "pixels", "flow", "verif", "talbot"
# Layouts have an environment of their own, in which `make test` runs these, too
LAYOUTS = "flow/handoff", "flow/layout", "flow/openroad", "platforms", "base/steps"
SECONDS = 1500  # a folder's tests that take longer hang
NO_TESTS = 5  # pytest's exit status


def folders():
    """Folders that hold tests, but those of layouts, relative to the repository: list of text, ascending."""
    found = {
        str(path.parent.relative_to(ROOT))
        for top in TESTED
        for path in (ROOT / top).rglob("*_test.py")
        if not path.name.endswith("_bench_test.py")
    }
    return sorted(folder for folder in found if not folder.startswith(LAYOUTS))


def run_folder(folder, root=ROOT, options=("--all",)):
    """Run the tests of ``folder`` (not of folders below): dict folder, seconds, cases.

    options: of pytest; --all runs the tests marked slow, too. cases: list of {test, outcome, seconds, message}; outcome:
    'passed', 'failed' or 'skipped'. Where pytest itself ends badly, that is a failed case too.
    """
    root = Path(root)
    files = sorted(
        str(p.relative_to(root)) for p in (root / folder).glob("*_test.py") if not p.name.endswith("_bench_test.py")
    )
    with tempfile.TemporaryDirectory(prefix="talbot-") as out:
        report = Path(out) / "report.xml"
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-p",
            "no:xdist",
            "-p",
            "no:cacheprovider",
            f"--junitxml={report}",
            "-o",
            "junit_family=xunit1",
            *options,
            *files,
        ]
        # Compiled models lie in a folder a worker (rtl/harness/testbench.py): two folders' tests must not share one.
        worker = "verify-" + re.sub(r"\W", "-", folder)
        try:
            done = finish(command, {"PYTEST_XDIST_WORKER": worker}, root, SECONDS)
            status, said = done.returncode, (done.stdout + done.stderr).strip()[-1500:]
        except ToolTimeout as error:
            status, said = -1, str(error)
        cases = list(read_report(report)) if report.exists() else []
    if status not in (0, 1, NO_TESTS) or not cases or status == 1 and all(c["outcome"] != "failed" for c in cases):
        cases.append(
            {
                "test": folder,
                "outcome": "failed",
                "seconds": 0.0,
                "message": f"pytest ended with status {status}: {said}",
            }
        )
    return {"folder": folder, "seconds": sum(c["seconds"] for c in cases), "cases": cases}


def read_report(path):
    """The cases of a junit file, as `run_folder` gives them: generator."""
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        outcome, message = "passed", ""
        for found in case:
            if found.tag in ("failure", "error"):
                outcome, message = "failed", found.get("message", "") or (found.text or "")[-800:]
                break
            if found.tag == "skipped":
                outcome, message = "skipped", found.get("message", "")
        file = case.get("file") or case.get("classname", "").replace(".", "/") + ".py"
        parts = [file, *([case.get("classname").rsplit(".", 1)[-1]] if in_class(case, file) else []), case.get("name")]
        yield {
            "test": "::".join(parts),
            "outcome": outcome,
            "seconds": float(case.get("time", 0)),
            "message": " ".join(message.split())[:800],
        }


def in_class(case, file):
    """True when the case's classname goes on behind its module."""
    return case.get("classname", "").rsplit(".", 1)[-1] != Path(file).stem
