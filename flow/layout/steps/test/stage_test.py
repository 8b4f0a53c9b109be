"""How a stage ends: routing that does not converge, a crash, and a second run with the careful setting."""

import os
import sys

import pytest

from talbot.base import openroad
from talbot.base.steps import StepError
from talbot.flow.layout.steps.stage import Stage, StageParameters, diverges, figures, net_count, processor_s, violations

# Instead of OpenROAD: a crash unless careful; then the figure, and the database
PROGRAM = """
import os, signal, sys
print("TALBOT placement_density 0.5")
if "error" in sys.argv:
    print("[ERROR X-0001] planted")
    sys.exit(1)
if "stop" in sys.argv:
    sys.exit("TALBOT stopped: planted by a script")
if "bug" in sys.argv:
    sys.exit("no such file")
if "kill" in sys.argv:
    os.kill(os.getpid(), signal.SIGKILL)
if os.environ["CAREFUL"] == "0":
    os.kill(os.getpid(), signal.SIGSEGV)
open("place.odb", "w").write("placed")
"""
# Violations after each iteration: of runs that ended, and of runs that did not
CONVERGED = ([1047, 580, 586, 193, 47, 14, 0], [1131, 618, 707, 202, 45, 3, 0])
CONVERGED += ([22809, 15342, 14536, 5175, 2793, 1832, 1143, 826, 672, 550, 224, 110, 100, 75, 68, 56, 40, 40, 22, 16],)
STALLED = [712, 487, 505, 103, 48, *[13] * 12]
HOPELESS = [3000, 2400, 2500, 2100, 2000, 1900, 1800, 1700, 1650]


@pytest.mark.parametrize("counts", CONVERGED)
def test_routing_that_converges_goes_on(counts):
    assert not any(diverges(counts[:k]) for k in range(len(counts) + 1))


@pytest.mark.parametrize("counts", [STALLED, HOPELESS])
def test_routing_that_does_not_converge_is_stopped(counts):
    assert diverges(counts) and not diverges(counts[:8])


def test_violations_are_those_of_the_last_routing():
    line = "[INFO DRT-0199]   Number of violations = {}.\n".format
    log = f"[INFO DRT-0187] Start routing.\n{line(9)}{line(0)}[INFO DRT-0187] Start routing.\n{line(4)}{line(2)}"
    assert violations(log) == [4, 2]


def test_a_crowded_core_is_stopped_after_the_first_iteration():
    assert net_count("Number of snets:          2\nNumber of nets:           2790\n") == 2790 and net_count("") == 0
    assert diverges([8840], [], 2790) and not diverges([2145], [], 1400) and not diverges([8840], [], 0)


def test_counts_are_integers_and_slacks_are_not():
    assert repr(figures("TALBOT open_nets 0\nx\nTALBOT hold_ns -0.125\n")) == "{'open_nets': 0, 'hold_ns': -0.125}"


@pytest.fixture
def place(tmp_path, monkeypatch):
    """place(*arguments): metrics of the stage `place` with the program instead of OpenROAD."""

    def run(*arguments):
        (tmp_path / "program.py").write_text(PROGRAM)
        command = [sys.executable, str(tmp_path / "program.py"), *arguments]
        monkeypatch.setattr(openroad, "command", lambda script, threads=1: command)
        step, paths = Stage(StageParameters(stage="place", top="Top")), {}
        for name in step.inputs:
            (paths := paths | {name: tmp_path / name})[name].write_text("")
        outputs = {name: tmp_path / file for name, file in step.outputs.items()}
        return step.run(paths, outputs) | {"database": outputs["database"].read_text()}

    return run


def test_a_stage_that_crashes_runs_again_with_the_careful_setting(place, tmp_path):
    assert place() == {
        "stopped": None,
        "again": "openroad ended by signal 11",
        "placement_density": 0.5,
        "database": "placed",
    }


@pytest.mark.parametrize("word, message", [("error", "[ERROR X-0001] planted"), ("stop", "planted by a script")])
def test_a_stage_that_fails_says_why_and_does_not_run_again(place, word, message):
    found = place(word)
    assert found["stopped"] == message and found["again"] is None and not found["database"]


@pytest.mark.parametrize(
    "word, message", [("bug", "place: openroad: no such file"), ("kill", "place: openroad was ended by signal 9")]
)
def test_what_is_not_the_designs_fault_is_no_result(place, word, message):
    with pytest.raises(StepError, match=message):
        place(word)


def test_an_iteration_that_takes_far_longer_than_the_first_ones_is_stopped():
    assert not diverges([2] * 5, [100] * 5 + [389]) and diverges([2] * 5, [100] * 5 + [391])
    assert not diverges([0] * 5, [1] * 5 + [179])
    # 11 violations of quad_divider_radix2: each tile may take as long as those that ended
    assert not diverges([11] * 5, [27] * 5 + [670]) and diverges([11] * 5, [27] * 5 + [680])


def test_what_follows_the_last_iteration_is_not_timed():
    # cordic: 0 violations after 314 s; then a diode was placed, and the run was stopped
    counts, seconds = [1294, 882, 810, 285, 62, 43, 11, 0], [32, 34, 32, 62, 32, 18, 6]
    assert not diverges(counts, [*seconds, 314]) and not diverges(counts, [*seconds, 3000])
    assert not diverges(counts[:-1], [*seconds, 314])


def test_a_process_is_timed_by_its_processors():
    before = processor_s(os.getpid())
    sum(k * k for k in range(3_000_000))
    assert 0.05 < processor_s(os.getpid()) - before < 20
