"""Exceptions of a command as one line and a status: bad input, a full disk, and what nobody foresaw."""

import errno
import re
import sys
from argparse import Namespace
from pathlib import Path
from types import SimpleNamespace

import pytest

from talbot.base import failure
from talbot.base.command import Parser, execute
from talbot.base.tools import ToolError
from talbot.models.parameters import ParameterError


@pytest.fixture
def status(monkeypatch, tmp_path, capsys):
    """status(error): the exit status of a command that raises it, and its lines on standard error."""
    monkeypatch.setattr(failure, "__file__", str(tmp_path / "talbot" / "base" / "failure.py"))
    monkeypatch.setattr(failure.tempfile, "tempdir", str(tmp_path / "tmp"))

    def status(error):
        def run(options: Namespace) -> int:
            raise error

        parser = Parser(prog="talbot")
        parser.set_defaults(run=run, writes_in="out", out=tmp_path / "out")
        return execute(parser, []), capsys.readouterr().err.splitlines()

    return status


@pytest.mark.parametrize("checkout", [False, True])
def test_an_unforeseen_exception_is_one_line_status_3_and_a_traceback_in_a_file(status, tmp_path, checkout):
    if checkout:
        (tmp_path / "pyproject.toml").touch()
    found, (line,) = status(KeyError("no\nsuch"))
    path = Path(re.search(r"its traceback is in (\S+);", line)[1])
    assert found == 3 and line.startswith("talbot: error: internal: KeyError: 'no\\nsuch'; ") and "CONTRIBUTING" in line
    assert path.parent == tmp_path / ("build" if checkout else "tmp")
    assert "Traceback" in path.read_text(encoding="utf-8") and "in run\n    raise error" in path.read_text(
        encoding="utf-8"
    )


def test_the_traceback_comes_where_no_folder_takes_it(status, tmp_path, monkeypatch):
    (tmp_path / "tmp").touch()
    found, lines = status(ZeroDivisionError("x"))
    assert found == 3 and "Traceback (most recent call last):" in lines
    assert lines[-1].startswith("talbot: error: internal: ZeroDivisionError: x; its traceback is above")


@pytest.mark.parametrize(
    "error, said", [(ParameterError("a = 1: must be 2"), "a = 1"), (ToolError("yosys: x"), "yosys")]
)
def test_what_is_foreseen_is_status_2(status, error, said):
    found, (line,) = status(error)
    assert found == 2 and line.startswith(f"talbot: error: {said}")


@pytest.mark.parametrize(
    "error, file",
    [
        (OSError(errno.ENOSPC, "No space left on device", "/mnt/a.gds"), "/mnt/a.gds"),
        (OSError(errno.ENOSPC, "No space left on device"), None),
        (OSError("4096 requested and 96 written"), None),  # of numpy's tofile
        (ToolError("g++ failed with status 1:\n/tmp/x.s: fatal error: No space left on device"), None),
    ],
)
def test_a_full_disk_is_named_and_what_to_free(status, monkeypatch, tmp_path, error, file):
    monkeypatch.setattr(failure, "_free", lambda path: 0 if path == tmp_path / "out" else 1 << 30)
    found, (line,) = status(error)
    assert found == 2
    assert line == (
        f"talbot: error: file = {file or f'{tmp_path}/out (0 MiB free)'}: no space left; "
        "free some on that disk (make clean removes build/, with results and caches)"
    )


def test_a_full_disk_behind_standard_output(status, monkeypatch):
    with open("/dev/full", "w", encoding="utf-8") as full:
        monkeypatch.setattr(sys, "stdout", full)
        full.write("x")
        found, (line,) = status(OSError(errno.ENOSPC, "No space left on device"))
    assert found == 2 and "file = output: no space left" in line


def test_a_disk_with_room_is_not_called_full(status, monkeypatch):
    monkeypatch.setattr(failure, "_free", lambda path: 1 << 30)
    assert "file = output: no space left" in status(OSError(errno.ENOSPC, "No space left on device"))[1][0]


def test_a_package_that_is_missing_is_no_internal_error(status, capsys):
    def call():
        raise ModuleNotFoundError("No module named 'klayout'", name="klayout.db")

    assert failure.reported("talbot", call) == 2
    assert capsys.readouterr().err.startswith("talbot: error: package = klayout: not installed")
    assert failure.reported("talbot", lambda: SimpleNamespace().missing) == 3
