"""Changed constants: a witness fails for one; a change that no witness sees is no success; the table is complete."""

import ast
from dataclasses import replace

import pytest

from talbot.base.paths import ROOT
from talbot.base.tools import ToolError
from talbot.verif.mutation.constants import FREE, WITNESSES, constants, is_noticed, jobs
from talbot.verif.mutation.planted import count, is_caught


def test_every_constant_differs_from_the_source():
    names = [bug.name for bug in constants()]
    assert len(names) > 200
    for bug in constants():
        assert bug.text() != (ROOT / bug.file).read_text(encoding="utf-8")
        if bug.file.endswith(".py"):
            ast.parse(bug.text())
    assert any("threshold and noise_floor exchanged" in name for name in names)
    assert any("7 and 13 exchanged" in name for name in names)


def test_the_table_names_what_is_there():
    text = "".join((ROOT / file).read_text(encoding="utf-8") for file in WITNESSES)
    assert all(name in text for name in FREE)
    for _, tests in WITNESSES.values():
        assert all((ROOT / test.split("::")[0]).is_file() for test in tests)


def test_a_sample_is_of_its_blocks():
    assert {block for block, _ in jobs(["RegFile"], 1, 1)} == {"RegFile"}
    assert len(jobs(["RegFile", "AspChip"], 0.5, 1)) == 12
    assert [job.name for _, job in jobs(["AspChip"], 1, 1)] == [job.name for _, job in jobs(["AspChip"], 1, 1)]


@pytest.mark.slow
def test_a_change_is_noticed():
    bug = next(bug for bug in constants() if "4 and 10 exchanged" in bug.name)
    assert is_noticed(bug)
    ((text, _),) = bug.changes
    assert not is_noticed(replace(bug, changes=((text, f"{text}\n"),)))


@pytest.mark.slow
def test_tests_that_cannot_run_notice_nothing():
    bug = next(bug for bug in constants() if "4 and 10 exchanged" in bug.name)
    ((text, _),) = bug.changes
    wrong = replace(bug, changes=((text, f"{text}\nraise ValueError\n"),))
    assert not is_noticed(replace(wrong, tests=bug.tests[1:]))
    with pytest.raises(ToolError, match="its tests cannot run"):
        is_caught(wrong)


def test_counts_are_those_of_the_summary():
    text = "trailer.py:50: error\n1 failed, 2 errors in 3.21s\n"
    assert (count("failed", text), count("error", text), count("error", "x: error\n1 failed in 0.1s")) == (1, 2, 0)
    assert count("failed", "no summary") == 0
