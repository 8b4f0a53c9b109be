import numpy as np
import pytest

from talbot.models.digital.divider import phase_error, quad_divide
from talbot.models.stability import Case, table
from talbot.verif.stability import FRAMES, SUBJECTS, divider_cases, frame_cases, measured


def test_divider_cases_hold():
    cases = divider_cases()
    assert len(cases) == 5 and all(c.ok for c in cases)


def test_phase_error_goes_the_short_way_round():
    x, y = np.array([255]), np.array([-1])
    assert np.abs(phase_error(quad_divide(x, y).phase, x, y)).max() < 0.75


def test_a_single_row_through_the_verilog():
    """Of a size that has its simulator in imaging/frame/test/frame_test.py, too."""
    name, arguments = FRAMES[1]
    (case,) = frame_cases(name, arguments)
    assert case.ok


def test_a_subject_is_measured_with_warnings_as_errors(monkeypatch):
    def warn():
        np.log(np.zeros(1))
        return [Case("a", "", "", True)]

    monkeypatch.setattr(
        "talbot.verif.stability.SUBJECTS", {"optics": lambda: {"x": warn}, "cells": lambda: {"y": warn}}
    )
    with pytest.raises(FloatingPointError):
        measured(["optics"])
    with pytest.warns(RuntimeWarning):
        assert [case.name for case in measured(["cells"])] == ["a"]


@pytest.mark.needs("layout")
def test_the_cells_are_a_subject():
    titles = [*SUBJECTS["cells"]()]
    assert len(titles) == 26 and titles[0] == "loads and slews" and titles[-1].startswith("corner ")


def test_table_marks_what_failed():
    lines = table([Case("a", "0", "0", True), Case("b", "0", "1", False)]).splitlines()
    assert lines[1].startswith("ok") and lines[2].startswith("FAILED")
