"""Planted bugs: one that a test detects, one that none detects, and entries that do not fit the sources."""

from dataclasses import replace
from functools import reduce
from importlib import import_module

import pytest

from talbot.base.tools import ToolError
from talbot.models.parameters import ParameterError
from talbot.verif.mutation.planted import Planted, is_caught, jobs, read

LIST = "    if origin in (list, tuple):\n"
BUG = Planted(
    "a bug",
    "EdgeAdc",
    "talbot/base/records.py",
    ((LIST, "    if origin is list:\n"),),
    ("talbot/base/test/records_test.py",),
)


def test_every_bug_fits_the_sources():
    assert all(bug.text() for bug in read())
    assert {block for block, _ in jobs(["RegFile"])} == {"RegFile"}


def test_the_tests_of_every_bug_exist():
    for file, *names in {tuple(name.split("::")) for bug in read() for name in bug.tests}:
        module = import_module(f"talbot.{file.removesuffix('.py').replace('/', '.')}")
        assert file.endswith("_test.py") and callable(reduce(getattr, names, module)) == bool(names)


@pytest.mark.slow
def test_a_bug_is_caught():
    assert is_caught(BUG)
    assert not is_caught(replace(BUG, changes=((LIST, f"{LIST}        pass\n"),)))
    with pytest.raises(ToolError, match="a bug: its tests cannot run"):
        is_caught(replace(BUG, changes=((LIST, "    if\n"),)))


def test_a_text_that_is_not_there():
    with pytest.raises(ParameterError, match="a bug: 'nothing' = 0 times: must be once"):
        replace(BUG, changes=(("nothing", ""),)).text()
