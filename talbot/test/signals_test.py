"""Signals at moments all through a run, its set-up, compiler and report too: a clean end, and nothing half-written."""

import os
import random
import re
import signal
import time
from pathlib import Path

import pytest

from talbot.base.files import PART
from talbot.base.paths import ROOT
from talbot.base.test.supervise_test import running, started
from talbot.commands import main

SIZE = ("--rows", "13", "--cols", "50", "--lanes", "4")  # of other tests, too: one simulator
FRAME = "--rows 24 --cols 36 --golden"
TARGETS = {  # command -> its smallest run
    "lightfield": f"--scene coins --disparities 3 {FRAME}",
    "polar": FRAME,
    "cameras": "--scenes coins --size 60 --lux 500 --seeds 1",
    "recognize": "--count 40 --curves none --golden --workers 1",
    "depth": f"--scene tilted --disparities 3 {FRAME}",
    "pixel": "--kind amplitude --period-um 1",
    "pixel-layout": "--rows 4 --cols 6",
    "pixel-circuit": "--corners typical",
    "analog": "--corners typical --draws 20",
    "analog-layout": "--corners typical",
    "cosim": "--modes edge --cols 6 --types 1",
    "stability": "",
    "tradeoff": "--only views",
    "site": "",
}
FAST = ("polar",)


def sim(folder, *more):
    """`python -m talbot sim` on its way."""
    words = ["-m", "talbot", "sim", "--scene", "coins", *SIZE, "--out", str(folder / "out"), *more]
    return started(folder, words)


def begun(child):
    """Wait for the first line of `talbot`, which holds signals back: before it, Python ends by its own rules."""
    bit, until = 1 << signal.SIGTERM - 1, time.monotonic() + 200
    while child.poll() is None and time.monotonic() < until:
        masks = re.findall(r"Sig(?:Blk|Cgt):\s*(\w+)", Path(f"/proc/{child.pid}/status").read_text(encoding="utf-8"))
        if any(int(mask, 16) & bit for mask in masks):
            return
        time.sleep(0.005)


def end(child, sent, whole_group):
    """Send the signal; status and standard error."""
    if child.poll() is None:
        (os.killpg if whole_group else os.kill)(child.pid, sent)
    err = child.communicate(timeout=200)[1]
    assert "Traceback" not in err and "Exception" not in err
    return child.returncode, err.splitlines()


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The names that a run writes, and its seconds with all simulators compiled."""
    out = tmp_path_factory.mktemp("whole") / "out"
    main(["sim", "--scene", "coins", *SIZE, "--out", str(out)])
    begin = time.monotonic()
    child = sim(out.parent)
    child.communicate()
    return {path.name for path in out.iterdir()}, time.monotonic() - begin


PARTS = 4


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_at_a_random_moment(tmp_path, whole, part):
    """In each quarter of the run once; which signal, and whether the whole group gets it, is drawn."""
    names, seconds = whole
    child = sim(tmp_path)
    begun(child)
    time.sleep((part + random.random()) / PARTS * seconds)
    sent = random.choice((signal.SIGINT, signal.SIGTERM))
    status, err = end(child, sent, random.random() < 0.5)
    out = tmp_path / "out"
    assert status in (0, 128 + sent)
    if status:
        assert err[-1].startswith("talbot: error: ")
    assert {path.name for path in tmp_path.iterdir()} <= {"out"} and not running(f"TEST_MARK={tmp_path}")
    assert not out.exists() or {path.name for path in out.iterdir()} == names
    assert status or out.exists()


def ended_at(folder, target, sent, seconds):
    """Send the signal ``seconds`` after the smallest run of ``target`` began: no result, or all of them.

    A signal after the results moved to their place ends a run that has them.
    """
    child = started(folder, ["-m", "talbot", target, *TARGETS[target].split(), "--out", str(folder / "out")])
    begun(child)
    time.sleep(seconds)
    status, err = end(child, sent, random.random() < 0.5)
    assert status in (0, 128 + sent) and sum(line.startswith("talbot: ") for line in err) == int(status > 0), err
    assert status == 0 or err[-1].endswith("nothing was left half-written")
    assert {path.name for path in folder.iterdir()} <= {"out"} and not running(f"TEST_MARK={folder}")
    out = folder / "out"
    assert not list(folder.rglob(f"{PART}*")) and (any(out.iterdir()) if out.exists() else status)


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(
    "target", [pytest.param(name, marks=() if name in FAST else pytest.mark.slow) for name in TARGETS]
)
def test_of_another_target(tmp_path, target, sent):
    ended_at(tmp_path, target, sent, random.uniform(0, 5))


def test_in_the_compiler(tmp_path):
    sent = random.choice((signal.SIGINT, signal.SIGTERM))
    child = sim(tmp_path, "--rows", "18")  # of no other test: it is never there
    assert any("compiling" in line for line in child.stderr)
    status, _ = end(child, sent, False)
    assert status == 128 + sent and not list(tmp_path.iterdir()) and not running(f"TEST_MARK={tmp_path}")
    for left in (ROOT / "build" / "simulator").glob(f"{PART}*"):  # other tests compile beside this one
        os.kill(int(left.name.removeprefix(PART).partition("-")[0]), 0)


def test_a_folder_with_a_results_name(tmp_path):
    (tmp_path / "out" / "report.html").mkdir(parents=True)
    status, err = end(sim(tmp_path), signal.SIGCONT, False)
    assert status == 2 and "must not have a folder report.html" in err[-1] and len(err) == 1
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["report.html"]
