"""Bugs that escaped before (planted.yaml), each in a copy of the sources: the block's tests must fail."""

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml

from talbot.base.jobs import Job
from talbot.base.paths import ROOT
from talbot.base.sources import code
from talbot.base.tools import ToolError, finish
from talbot.models.parameters import ParameterError
from talbot.rtl.tops import TOPS

FILE = Path(__file__).parent / "planted.yaml"
LEFT_OUT = shutil.ignore_patterns("build", ".*", "__pycache__")


@dataclass(frozen=True)
class Planted:
    """A bug of ``block``. file: of the RTL. changes: (text, replacement) in it. tests: pytest's, which must fail."""

    name: str
    block: str
    file: str
    changes: tuple[tuple[str, str], ...]
    tests: tuple[str, ...]

    def text(self) -> str:
        """Return the file with the bug. Raises ParameterError."""
        text = (ROOT / self.file).read_text(encoding="utf-8")
        for find, replace in self.changes:
            if text.count(find) != 1:
                raise ParameterError(f"{FILE.name}: {self.name}: {find!r} = {text.count(find)} times: must be once")
            text = text.replace(find, replace)
        return text


def read() -> list[Planted]:
    """Return the bugs of planted.yaml. Raises ParameterError."""
    bugs = [
        Planted(
            entry["name"], entry["block"], entry["file"], tuple(map(tuple, entry["changes"])), tuple(entry["tests"])
        )
        for entry in yaml.safe_load(FILE.read_text(encoding="utf-8"))
    ]
    for bug in bugs:
        if bug.block not in TOPS:
            raise ParameterError(f"{FILE.name}: {bug.name}: block = {bug.block}: must be one of {', '.join(TOPS)}")
    return bugs


def jobs(blocks: Iterable[str]) -> list[tuple[str, Job]]:
    """Return (block, Job) for each bug of ``blocks``."""
    blocks = set(blocks)
    return [
        (bug.block, Job(bug.name.replace(" ", "-"), is_caught, (bug,), (*map(str, bug.changes), code(*files))))
        for bug in read()
        if bug.block in blocks
        for files in [(bug.file, *(test.split("::")[0] for test in bug.tests))]
    ]


def is_caught(bug: Planted) -> bool:
    """Return whether a test of the bug fails. Raises ToolError where the tests cannot run with it."""
    done = attempt(bug, "-x", "--all")
    statuses = pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED
    ran = count("passed", done.stdout) + count("failed", done.stdout)
    if done.returncode not in statuses or count("error", done.stdout) or not ran:
        raise ToolError(f"{bug.name}: its tests cannot run: {(done.stdout + done.stderr)[-1500:]}")
    return done.returncode == pytest.ExitCode.TESTS_FAILED


def count(outcome: str, output: str) -> int:
    """Return the number of tests with an ``outcome``, 'failed' or 'error', in pytest's summary."""
    summary = [line for line in output.splitlines() if re.search(r" in [\d.]+s\b", line)]
    found = re.search(rf"\b(\d+) {outcome}s?\b", summary[-1]) if summary else None
    return int(found[1]) if found else 0


def attempt(bug: Planted, *more: str) -> subprocess.CompletedProcess[str]:
    """Run the tests of a bug in a copy of the sources. more: options of pytest."""
    text = bug.text()
    with tempfile.TemporaryDirectory(prefix="talbot-") as temporary:
        copy = Path(temporary) / "talbot"
        shutil.copytree(ROOT, copy, symlinks=True, ignore=LEFT_OUT)
        (ROOT / "build").mkdir(exist_ok=True)
        (copy / "build").symlink_to(ROOT / "build")
        (copy / bug.file).write_text(text, encoding="utf-8")
        options = *more, "-p", "no:cacheprovider", "-p", "no:xdist", "--hypothesis-seed=1"
        return finish([sys.executable, "-m", "pytest", *options, *bug.tests], {"PYTHONPATH": str(copy)}, copy)
