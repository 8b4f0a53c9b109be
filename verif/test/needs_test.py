"""The mark `needs`: tests without their tools are skipped and counted, and the end of a run names each tool once."""

import ast
from pathlib import Path

import pytest

from talbot.base.paths import PACKAGE
from talbot.verif import needs
from talbot.verif.needs import NEEDS, Need

pytest_plugins = ["pytester"]

FILE = """
import pytest

@pytest.mark.needs("there")
def test_runs():
    pass

@pytest.mark.needs("absent", "there")
@pytest.mark.parametrize("n", [1, pytest.param(2, marks=pytest.mark.needs("other"))])
def test_is_skipped(n):
    assert False

@pytest.fixture
def program(require):
    require("absent")

def test_asks_at_run_time(program):
    assert False
"""
WITHOUT_PACKAGE = """
import pytest
import no_such_package

pytestmark = [pytest.mark.needs("package"), pytest.mark.filterwarnings("error")]

def test_one():
    assert False

class TestTwo:
    def test_two(self):
        assert False

    @pytest.mark.slow
    def test_slow(self):
        assert False
"""


@pytest.fixture
def run(pytester, monkeypatch):
    """run(text, *options): the result of pytest on a file with ``text`` and a separate table of needs."""
    table = {
        "there": Need(lambda: True, "make there"),
        "absent": Need(lambda: False, "make tools"),
        "other": Need(lambda: False, "buy it", offered=False),
        "package": Need(lambda: False, "pip install package", imported=True),
    }
    monkeypatch.setattr(needs, "NEEDS", table)
    needs.installed.cache_clear()
    pytester.makeini("[pytest]\npython_files = *_test.py\nmarkers = slow")

    def result(text, *options):
        pytester.path.joinpath("x_test.py").write_text(text)
        return pytester.runpytest_inprocess("-p", "talbot.verif.needs", "-p", "no:benchmark", *options)

    yield result
    needs.installed.cache_clear()


def test_each_need_is_listed_once_with_its_tests_and_its_command(run):
    done = run(FILE)
    done.assert_outcomes(passed=1, skipped=3)
    done.stdout.fnmatch_lines(["skipped for want of:", "  absent  3 tests  make tools", "  other   1 test   buy it"])


@pytest.mark.parametrize("absent, status", [("absent", 1), ("other", 0)])
def test_complete_fails_where_debian_or_pypi_have_it(run, absent, status):
    done = run(f"import pytest\n@pytest.mark.needs('{absent}')\ndef test_one(): pass\n", "--complete")
    assert done.ret == status


def test_complete_fails_where_a_reason_is_no_need(run):
    assert run("import pytest\ndef test_one(): pytest.skip('no cheese')\n", "--complete").ret == 1


def test_a_second_run_leaves_out_what_passed_in_the_first(run, pytester):
    run(FILE, "--passed", "build/passed.txt")
    assert pytester.path.joinpath("build/passed.txt").read_text() == "x_test.py::test_runs\n"
    run(FILE, "--without", "build/passed.txt").assert_outcomes(skipped=3, deselected=1)


def test_an_unknown_need_is_refused_at_collection(run):
    done = run("import pytest\n@pytest.mark.needs('yosis')\ndef test_one(): pass\n")
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    done.stderr.fnmatch_lines(["*needs = yosis (x_test.py::test_one): must be of there, absent*"])


def test_a_file_whose_package_is_missing_is_not_imported_and_its_tests_count(run):
    done = run(WITHOUT_PACKAGE)
    done.assert_outcomes(skipped=3)
    done.stdout.fnmatch_lines(["  package  3 tests  pip install package"])


def test_every_need_answers():
    assert {type(need.installed()) for need in NEEDS.values()} == {bool}


def test_no_test_words_a_missing_tool_by_itself():
    """Tests state needs by the mark only: no skipif, importorskip or pytest.skip outside the fixtures of --netlist."""
    parts = [part for part in sorted(PACKAGE.iterdir()) if part.is_dir()]
    files = [file for part in parts for file in part.rglob("*_test.py") if file != Path(__file__)]
    assert len(files) > 300
    worded = [
        f"{file}:{node.lineno}"
        for file in files
        if "skip" in (text := file.read_text("utf-8"))
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Attribute)
        and node.attr in ("skipif", "importorskip", "skip")
        and ast.unparse(node).startswith("pytest.")
    ]
    assert not worded
