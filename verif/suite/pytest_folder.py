"""The tests of one folder in a separate pytest process: outcomes, messages and times."""

import re
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from talbot.base.paths import ROOT
from talbot.base.supervise import RUN, lasting_temporary
from talbot.base.tools import ToolTimeout, finish

TESTED = "models", "rtl", "imaging", "memory", "pixels", "signoff", "flow", "verif", "talbot"
# Layouts have a separate environment, in which `make test` runs these
LAYOUTS = "flow/handoff", "flow/layout", "flow/openroad", "signoff", "talbot/platforms", "talbot/base/steps"
SECONDS = 1500  # limit of a folder's tests
NO_TESTS = 5  # pytest's exit status


def folders() -> list[str]:
    """Return the folders with tests, except those of layouts, relative to the repository, ascending."""
    paths = {
        str(path.parent.relative_to(ROOT))
        for top in TESTED
        for path in (ROOT / top).rglob("*_test.py")
        if not path.name.endswith("_bench_test.py")
    }
    return sorted(folder for folder in paths if not folder.startswith(LAYOUTS))


@dataclass(frozen=True)
class Case:
    """One test. outcome: 'passed', 'failed' or 'skipped'. message: of a failure or a skip."""

    test: str
    outcome: str
    seconds: float
    message: str


@dataclass(frozen=True)
class FolderRun:
    """The tests of a folder."""

    folder: str
    seconds: float
    cases: list[Case]


def run_folder(folder: str, options: Sequence[str] = (), root: Path = ROOT) -> FolderRun:
    """Run the tests of ``folder`` (not of folders below it); a pytest that fails itself is a failed case, too.

    options: of pytest.
    """
    files = sorted(
        str(p.relative_to(root)) for p in (root / folder).glob("*_test.py") if not p.name.endswith("_bench_test.py")
    )
    with tempfile.TemporaryDirectory(prefix="talbot-") as out:
        report = Path(out) / "report.xml"
        plugins = "-p", "no:xdist", "-p", "no:cacheprovider", "-o", "junit_family=xunit1"
        command = [sys.executable, "-m", "pytest", *plugins, f"--junitxml={report}", *options, *files]
        # Compiled models are kept in a folder per worker (rtl/harness): two folders' tests must not share one.
        worker = "verify-" + re.sub(r"\W", "-", folder)
        try:
            # As in a shell: a command that a test starts supervises itself
            variables = {"PYTEST_XDIST_WORKER": worker, RUN: "", "TMPDIR": str(lasting_temporary())}
            done = finish(command, variables, root, SECONDS)
            status, output = done.returncode, (done.stdout + done.stderr).strip()[-1500:]
        except ToolTimeout as error:
            status, output = -1, str(error)
        cases = list(read_report(report)) if report.exists() else []
    if status not in (0, 1, NO_TESTS) or not cases or status == 1 and all(c.outcome != "failed" for c in cases):
        cases.append(Case(folder, "failed", 0.0, f"pytest ended with status {status}: {output}"))
    return FolderRun(folder, sum(c.seconds for c in cases), cases)


def read_report(path: Path) -> Iterator[Case]:
    """Yield the cases of a junit file."""
    for case in ElementTree.parse(path).iter("testcase"):
        outcome, message = "passed", ""
        for child in case:
            if child.tag in ("failure", "error"):
                outcome, message = "failed", child.get("message", "") or (child.text or "")[-800:]
                break
            if child.tag == "skipped":
                outcome, message = "skipped", child.get("message", "")
        classname = case.get("classname", "")
        file = case.get("file") or classname.replace(".", "/") + ".py"
        last = classname.rsplit(".", 1)[-1]  # the module, or a class in it
        parts = [file, *([last] if last != Path(file).stem else []), case.get("name", "")]
        yield Case("::".join(parts), outcome, float(case.get("time", 0)), " ".join(message.split())[:800])
