"""The suite's counting, on small test files."""

from dataclasses import replace

import pytest

from talbot.base.command import main
from talbot.base.paths import ROOT
from talbot.rtl.tops import TOPS
from talbot.verif.results import BlockResults
from talbot.verif.suite import command
from talbot.verif.suite.blocks import BLOCKS, FOLDERS, blocks_of, level_of
from talbot.verif.suite.command import count, forget, jobs, options_of, summarize
from talbot.verif.suite.pytest_folder import Case, FolderRun, folders, run_folder

FILE = """
import pytest

class TestRTL:
    def test_good(self):
        pass

def test_bad():
    assert 1 == 2, "one is not two"

def test_left_out():
    pytest.skip("no tool")
"""


@pytest.fixture
def repository(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "x_test.py").write_text(FILE)
    (tmp_path / "a" / "x_bench_test.py").write_text("def test_slow(): assert False")
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "y_test.py").write_text("import no_such_module")
    (tmp_path / "pyproject.toml").write_text("[tool.pytest.ini_options]\npython_files = '*_test.py'\n")
    return tmp_path


def test_outcomes_of_a_folder(repository):
    cases = run_folder("a", root=repository).cases
    assert [(c.test, c.outcome) for c in cases] == [
        ("a/x_test.py::TestRTL::test_good", "passed"),
        ("a/x_test.py::test_bad", "failed"),
        ("a/x_test.py::test_left_out", "skipped"),
    ]
    assert "one is not two" in cases[1].message and "no tool" in cases[2].message


SEEDED = """
import hypothesis, hypothesis.strategies as st

@hypothesis.given(st.integers())
def test_any(number):
    open("drawn", "a").write(f"{number} ")
"""


@pytest.mark.slow
def test_a_seed_draws_the_same_again(repository, monkeypatch):
    """Where a CI runs the tests, too."""
    (repository / "conftest.py").write_text((ROOT / "conftest.py").read_text())
    (repository / "c").mkdir()
    (repository / "c" / "z_test.py").write_text(SEEDED)
    drawn = []
    monkeypatch.delenv("CI", raising=False)
    for seed in (1, 1, 2):
        run_folder("c", options_of(seed)[1:], repository)
        drawn.append((repository / "drawn").read_text())
        (repository / "drawn").unlink()
        monkeypatch.setenv("CI", "true")
    assert drawn[0] == drawn[1] != drawn[2]


def test_a_file_that_cannot_be_read_is_a_failure(repository):
    cases = run_folder("b", root=repository).cases
    assert any(c.outcome == "failed" and "no_such_module" in c.message for c in cases)


def test_every_folder_has_a_block():
    prefixes = [prefix for prefix, _ in FOLDERS]
    assert all(prefix == "" or (ROOT / prefix).is_dir() for prefix in prefixes)
    found = {block for folder in folders() for block in blocks_of(folder)}
    assert found == set(BLOCKS) and set(TOPS) <= found
    assert folders() and all(folder.split("/")[-1] == "test" for folder in folders())


@pytest.mark.parametrize(
    "test, level",
    [
        ("rtl/x/test/x_test.py::TestIcarusTwoLanes::test_a", "Icarus"),
        ("rtl/x/test/x_test.py::TestVerilog::test_a", "Verilator"),
        ("rtl/x/test/x_test.py::TestRTL::test_a", "RTL"),
        ("rtl/x/test/x_test.py::TestCL::test_a", "CL"),
        ("rtl/x/test/x_test.py::test_verilog", ""),
        ("imaging/simulate/test/f.py::test_icarus_same", "Icarus"),
        ("verif/faults/test/f.py::test_x", "Verilator"),
        ("models/test/x_test.py::TestThing::test_a", ""),
    ],
)
def test_levels(test, level):
    assert level_of(test) == level


def test_a_divider_counts_for_what_it_names():
    assert blocks_of("rtl/quad_divider/test", "x::test_y[radix4-3]") == ("QuadDividerRadix4",)
    assert len(blocks_of("rtl/quad_divider/test", "x::test_y")) == 4


def test_counts_by_block(repository):
    found = summarize([replace(run_folder("a", root=repository), folder="rtl/edge_adc/test")])["EdgeAdc"]
    tests = found.tests
    assert (tests.passed, tests.failed, tests.skipped) == (1, 1, 1) and tests.levels == {"RTL": 1}
    assert found.simulators == ["PyMTL3"] and len(found.open_points) == 2
    assert found.open_points[0].startswith("test a/x_test.py::test_bad = failed: ")


@pytest.mark.parametrize(
    "reason, points", [("no tool", 1), ("needs z3", 1), ("needs tinyrv", 0), ("needs tinyrv, z3", 1), ("needs x", 1)]
)
def test_a_test_without_what_make_installs_is_an_open_point(reason, points):
    entry = BlockResults()
    count(entry, "rtl/edge_adc/test", Case("a::b", "skipped", 0.0, reason))
    assert (entry.tests.skipped, len(entry.open_points)) == (1, points)


def test_failures_are_tried_again(tmp_path):
    planned = jobs(["models/test", "rtl/test"], {"rtl/test": 5})
    kept = [job.file(tmp_path) for job in planned]
    for path in kept:
        path.write_text("{}")
    passed, failed = Case("a", "passed", 0.0, ""), Case("b", "failed", 0.0, "")
    forget(planned, [FolderRun("", 0.0, cases) for cases in ([passed], [passed, failed])], tmp_path)
    assert [path.exists() for path in kept] == [True, False]


def test_an_unknown_folder(capsys):
    assert main(command, ["--folder", "nowhere"]) == 2
    assert capsys.readouterr().err.startswith("verif.suite: error: folder = 'nowhere': must be a folder of tests, as ")
