"""The report: summary of all steps, broken limits, missing and failed steps."""

import copy
import json
import sys
from dataclasses import is_dataclass, replace

import pytest

from talbot.base.check import ONLY
from talbot.base.command import main
from talbot.models.parameters import ParameterError
from talbot.rtl.tops import TOPS
from talbot.verif.report import command, document, limits, steps
from talbot.verif.report.merge import figures, summarize, totals
from talbot.verif.report.page import render
from talbot.verif.report.steps import Outcome, Step, run_step
from talbot.verif.results import COVERAGE, BlockResults, Fuzz, Mutants, Property, Resync, StuckAt, Tests
from talbot.verif.suite.blocks import BLOCKS

PROOF = Property("a.one", "boolector (3.2)", "unbounded", "proven", True, 1.5)
GOOD = BlockResults(
    tests=Tests(passed=5),
    proofs=[PROOF],
    coverage=dict.fromkeys(COVERAGE, 100.0),
    mutants=Mutants(made=50, equivalent=4, killed=46, survived=0),
)
FUZZ = {
    "Decoder": BlockResults(fuzz=Fuzz(10**6, 0, 1), resync=Resync(10**6, 0, 0, [])),
    "Host": BlockResults(fuzz=Fuzz(10**6, 0, 1)),
    "AspChip": BlockResults(fuzz=Fuzz(900, 0, 1, kinds={"cycles": 10**7})),
}


def everything():
    """Return the results of all steps without a failure."""
    return summarize(
        [
            {block: copy.deepcopy(GOOD) for block in TOPS},
            copy.deepcopy(FUZZ),
            {"AspChip": BlockResults(stuck_at=StuckAt(faults=9000, sample=500, detected=360))},
            {block: BlockResults(tests=Tests(passed=3)) for block in BLOCKS if block not in TOPS},
        ]
    )


LOWEST = {
    group: {f: s for f, s in named.items() if f not in ("tests.passed", "proofs.proven", "mutants.made")}
    for group, named in limits.read().items()
}


def test_the_results_of_all_steps_are_merged():
    one = BlockResults(tests=Tests(3, 1, levels={"RTL": 3}), simulators=["Icarus"], open_points=["a"])
    two = BlockResults(
        tests=Tests(4, 0, levels={"RTL": 1, "FL": 2}),
        proofs=[PROOF],
        coverage={"line": 99.0},
        simulators=["Icarus", "Verilator"],
        open_points=["b"],
    )
    entry = summarize([{"EdgeAdc": one}, {"EdgeAdc": two}])["EdgeAdc"]
    assert entry.tests == Tests(7, 1, levels={"RTL": 4, "FL": 2})
    measured = dict.fromkeys(("branch", "expression", "toggle", "fsm", "functional"))
    assert entry.coverage == {"line": 99.0} | measured
    assert entry.proofs == [PROOF] and entry.open_points == ["a", "b"]
    assert entry.simulators == ["Icarus", "Verilator"]
    assert set(summarize([])) == set(BLOCKS)


def test_simulators_that_come_with_counts():
    one = BlockResults(simulators=["PyMTL3", "Icarus"])
    benches = {"Icarus": Tests(passed=3), "Verilator": Tests(passed=2)}
    two = BlockResults(simulators=list(benches), benches=benches)
    entry = summarize([{"EdgeAdc": one}, {"EdgeAdc": two}])["EdgeAdc"]
    assert entry.simulators == ["PyMTL3", "Icarus", "Verilator"]
    assert entry.benches == benches


def test_nothing_falls_when_all_is_well():
    assert limits.fallen(everything(), LOWEST) == []


def changed(part, names, value):
    """``part`` of a result with the field or key ``names`` (outermost first) set to ``value``."""
    if not names:
        return value
    name, *rest = names
    if is_dataclass(part):
        return replace(part, **{name: changed(getattr(part, name), rest, value)})
    return part | {name: changed(part[name], rest, value)}


def change(path, value):
    return changed(everything(), path, value)


@pytest.mark.parametrize(
    "path, value, line",
    [
        (("EdgeAdc", "tests", "failed"), 1, "EdgeAdc.tests.failed = 1: limit at most 0"),
        (("Flow", "tests", "failed"), 2, "Flow.tests.failed = 2: limit at most 0"),
        (("AspChip", "stuck_at", "detected"), 314, "AspChip.stuck_at.share = 62.80: limit at least 63"),
        (("RunLength", "coverage", "toggle"), 99.96, "RunLength.coverage.toggle = 99.96: limit at least 100"),
        (("RegFile", "coverage", "line"), None, "RegFile.coverage.line = not measured: limit at least 100"),
        (("AmpCtrl", "proofs"), [replace(PROOF, result="unknown")], "AmpCtrl.proofs.unproven = 1: limit at most 0"),
        (
            ("AmpCtrl", "proofs"),
            [replace(PROOF, twin_fails=False)],
            "AmpCtrl.proofs.twins_not_caught = 1: limit at most 0",
        ),
        (("Cordic", "mutants", "survived"), 1, "Cordic.mutants.survived = 1: limit at most 0"),
        (("Cordic", "mutants", "killed"), 45, "Cordic.mutants.score = 97.83: limit at least 100"),
        (("Decoder", "fuzz", "failures"), 1, "Decoder.fuzz.failures = 1: limit at most 0"),
        (("Host", "open_points"), ["x"], "Host.open_points = 1: limit at most 0"),
    ],
)
def test_a_figure_that_falls_is_named_with_its_limit(path, value, line):
    assert line in limits.fallen(change(path, value), LOWEST)


def test_total_and_missing_blocks():
    summary = everything()
    assert limits.fallen(summary, {"total": {"mutants.made": {"min": 601}}}) == [
        "total.mutants.made = 600: limit at least 601"
    ]
    assert limits.fallen(summary, {"Nobody": {"tests.failed": {"max": 0}}}) == [
        "Nobody = no results: limits.json has limits for it"
    ]
    assert totals(summary)["tests.passed"] == 5 * len(TOPS) + 3 * (len(BLOCKS) - len(TOPS))


def test_a_figure_that_a_block_cannot_have():
    held = {"rtl": {"coverage.fsm": {"min": 100}}, "EdgeAdc": {"coverage.fsm": {"none": "it has no state machine"}}}
    assert limits.fallen(change(("EdgeAdc", "coverage", "fsm"), None), held) == []
    assert limits.fallen(change(("RegFile", "coverage", "fsm"), None), held) == [
        "RegFile.coverage.fsm = not measured: limit at least 100"
    ]
    assert limits.fallen(change(("EdgeAdc", "coverage", "fsm"), 50.0), held) == [
        "EdgeAdc.coverage.fsm = 50: limit at least 100"
    ]


@pytest.mark.parametrize(
    "text",
    [
        "{",
        '{"rtl": {"tests.failed": {"most": 0}}}',
        '{"rtl": {"tests.failed": {}}}',
        '{"rtl": {"tests.failed": {"max": "none"}}}',
    ],
)
def test_wrong_limits(tmp_path, text):
    (tmp_path / "limits.json").write_text(text)
    with pytest.raises(ParameterError, match="^limits"):
        limits.read(tmp_path / "limits.json")


def test_figures():
    found = figures(everything()["AmpCtrl"])
    assert (found["proofs.proven"], found["mutants.score"], found["coverage.line"]) == (1, 100.0, 100.0)
    assert Mutants(made=3, equivalent=3).score == 100 and figures(BlockResults())["mutants.score"] is None


STEP = "import json, pathlib, sys\npathlib.Path({out!r}).write_text({text!r})\nsys.exit({status})\n"


@pytest.mark.parametrize(
    "text, status, problem",
    [
        ('{"AmpCtrl": {"open_points": []}}', 0, ""),
        ('{"AmpCtrl": {"open_points": ["x"]}}', 1, ""),
        ('{"AmpCtrl": {"tests": {"passed": 1, "failed": 1}}}', 1, ""),
        (
            '{"AmpCtrl": {"open_points": []}}',
            1,
            "step one = exit status 1: its results name no failed test or open point",
        ),
        ('{"AmpCtrl": {"open_points": []}}', 2, "step one = exit status 2: must be 0 (see its output)"),
        ("[1]", 0, "step one = no results: one.json is no dict of blocks"),
        ("{", 0, "step one = no results: one.json: "),
    ],
)
def test_how_a_step_may_end(tmp_path, monkeypatch, text, status, problem):
    (tmp_path / "step.py").write_text(STEP.format(out=str(tmp_path / "one.json"), text=text, status=status))
    monkeypatch.setattr(steps, "TALBOT", [sys.executable, tmp_path / "step.py"])
    found = run_step(Step("one", "one", "one"), tmp_path)
    assert found.problem == problem or problem and found.problem.startswith(problem)


def test_a_step_that_is_missing_keeps_no_old_results(tmp_path):
    (tmp_path / "one.json").write_text('{"AmpCtrl": {"tests": {"passed": 9, "failed": 0}}}')
    found = run_step(Step("one", "nowhere", "one"), tmp_path)
    assert found.problem == "step one = exit status 2: must be 0 (see its output)" and found.by_block == {}
    assert not (tmp_path / "one.json").exists()


def test_the_page_holds_every_block_and_every_fault():
    summary, held = everything(), limits.read()
    summary["AmpCtrl"].open_points = ["<b>a point</b>"]
    summary["EdgeAdc"].coverage["line"] = 99.96
    step = Outcome(Step("one", "a", "what one does"), 2.5, "", {})
    page = render(summary, [step], ["step two = missing"], ["EdgeAdc.coverage.line = 99.96: limit"], held, 3.0)
    for text in (*BLOCKS, "&lt;b&gt;a point", "99.9 %", "unbounded", "what one does", "step two = missing", "a.one"):
        assert text in page, text
    assert "<script" not in page and "http" not in page


def test_a_check_of_the_arguments_runs_no_step(tmp_path, monkeypatch, capsys):
    (tmp_path / "bench.json").write_text("{}")
    monkeypatch.setenv(ONLY, "1")
    assert main(command, ["--steps", "bench", "--out", str(tmp_path)]) == 0
    assert (tmp_path / "bench.json").read_text() == "{}" and capsys.readouterr() == ("", "")


def test_the_command_reads_what_steps_left(tmp_path, capsys):
    (tmp_path / "suite.json").write_text(json.dumps({"EdgeAdc": {"tests": {"passed": 3, "failed": 1}}}))
    assert main(command, ["--read", "--out", str(tmp_path)]) == 1
    errors = capsys.readouterr().err
    assert "EdgeAdc.tests.failed = 1: limit at most 0\n" in errors
    assert "step formal = no results: formal.json is missing\n" in errors
    assert json.loads((tmp_path / "summary.json").read_text())["EdgeAdc"]["tests"]["failed"] == 1
    assert (tmp_path / "report.html").exists()


def test_the_page_has_the_steps_that_ran(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("<!-- steps -->\n<!-- end of steps -->\n")
    formal, suite, stuck = (next(s for s in steps.STEPS if s.name == name) for name in ("formal", "suite", "stuck_at"))
    done = [
        Outcome(formal, 12.3, "", {"EdgeAdc": BlockResults(proofs=[PROOF, replace(PROOF, result="timeout")])}),
        Outcome(suite, 0.0, "", {"EdgeAdc": BlockResults(tests=Tests(5))}),
        Outcome(stuck, 4.0, "", {"AspChip": BlockResults(stuck_at=StuckAt(9000, 500, 333), open_points=["x"])}),
    ]
    (tmp_path / document.FILE).write_text('{"steps": ')  # damaged: begun again
    runs = document.record(done, tmp_path, 1.25)
    assert set(runs) == {"formal", "stuck_at"} and runs["formal"].seconds == 12.3
    document.put(page, [replace(outcome, seconds=0.0) for outcome in done], document.record([], tmp_path, 0.0))
    lines = page.read_text().splitlines()
    row = next(line for line in lines if line.startswith("| formal |"))
    assert (
        row.startswith("| formal | 1 of 2 properties proven, twin caught, 0 open points | 12 | 20") and "| 1.2 |" in row
    )
    assert "Not run: suite." in lines
    assert any("| stuck_at | 66.6 ± 4.0 % of stuck-at faults detected, 1 open points | 4 |" in line for line in lines)
    assert main(command, ["--read", "--out", str(tmp_path), "--document", str(tmp_path / "runs.json")]) == 2
