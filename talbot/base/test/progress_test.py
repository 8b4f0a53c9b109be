"""Where there is no terminal, a step and a line about it are one line each."""

import contextlib
import fcntl
import os
import struct
import sys
import termios
import time

import pytest

from talbot.base import progress
from talbot.base.progress import Steps, each, ended


def test_lines_without_a_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with Steps(["place", "route"], lines=True) as steps:
        steps.note("place")
        steps.note("route")
        steps.note("turn 2")
    assert capsys.readouterr().err == "  1/2 place\n  2/2 route\n  2/2 turn 2\n"


def test_of_short_steps_only_lines_about_them(capsys: pytest.CaptureFixture[str]) -> None:
    with Steps(["setup", "capture"]) as steps:
        steps.note("setup")
        steps.note("capture of 40 views")
    assert capsys.readouterr().err == "  1/2 capture of 40 views\n"


def test_the_time_of_a_step_that_ended_beside_others(capsys: pytest.CaptureFixture[str]) -> None:
    with Steps(["drc", "lvs"], lines=True) as steps:
        steps.note("drc")
        steps.note("lvs")
        steps.note(ended("drc", 1.26))
    assert capsys.readouterr().err == "  1/2 drc\n  2/2 lvs\n  1/2 drc: 1.3 s\n"


def test_each_is_a_line_as_it_ends(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    now = iter([0.0, 2.5, 2.5, 2.6, 4.0, 4.0])  # the second takes no time
    monkeypatch.setattr(progress, "monotonic", lambda: next(now))
    assert list(each(["inv", "nand", "nor"], "cells", str)) == ["inv", "nand", "nor"]
    assert capsys.readouterr().err == "  1/3 cells inv: 2.5 s\n  3/3 cells nor: 1.5 s\n"


@contextlib.contextmanager
def terminal(monkeypatch):
    """Standard error on a terminal of 0 x 0; yields a function that returns what was written there since."""
    here, there = os.openpty()
    fcntl.ioctl(there, termios.TIOCSWINSZ, struct.pack("HHHH", 0, 0, 0, 0))
    os.set_blocking(here, False)

    def shown() -> str:
        with contextlib.suppress(BlockingIOError):
            return os.read(here, 1 << 16).decode()
        return ""

    with os.fdopen(there, "w", buffering=1) as file, monkeypatch.context() as patch:
        patch.setattr(sys, "stderr", file)
        yield shown
    os.close(here)


def test_a_bar_moves_within_a_step_where_the_terminal_says_0_x_0(monkeypatch):
    monkeypatch.setattr(progress, "TICK", 0.02)
    with terminal(monkeypatch) as shown:
        assert progress.terminal() == {"ncols": 80, "nrows": 24}
        with Steps(["bench", "fit {a}"]) as steps:
            steps.note("bench")
            for _ in each(range(4), "hole"):
                pass
            steps.note("fit {a}")
            time.sleep(0.2)
        text = shown()
    places = [max(part.count("█") for part in text.split("\r") if f" hole, {i}/4 [00:0" in part) for i in (1, 2, 3, 4)]
    assert places == sorted(places) and places[0] < places[-1]
    assert text.count("2/2 |") > 3 and "fit {a} [00:00]" in text and "hole:" not in text  # one bar, and its clock
    assert Steps.current is None
