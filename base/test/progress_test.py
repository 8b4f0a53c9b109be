"""Where there is no terminal, a step and a line about it are one line each."""

import pytest

from talbot.base.progress import Steps


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
