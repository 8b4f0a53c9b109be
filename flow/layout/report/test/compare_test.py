"""Summaries side by side: a design, the same around a macro, and the macro."""

import json

import pytest

from talbot.base.command import main
from talbot.flow.layout.report import compare
from talbot.flow.layout.report.metrics import table_6_1

SUMMARY = {
    "area_um2": 1000.0,
    "cells": 90,
    "clock_buffers": 10,
    "flip_flops": 5,
    "wire_um": 5.5,
    "lvs_match": True,
    "wns_ns": {"tt_025C": 1.5, "ss_100C": 0.25},
    "gate_tests": {"passed": 3, "failed": 0},
    "open_nets": 0,
    "wall_s": {"timing": 300.0, "routing": 20.0},
    "peak_mib": {"routing": 200},
}


@pytest.fixture
def folder(tmp_path):
    for name, more in (
        ("phase_path", {}),
        ("phase_path_macros", {"macros": {"divider": "quad_divider"}}),
        ("quad_divider", {"wall_s": {"routing": 1.0}}),
    ):
        (tmp_path / name).mkdir()
        (tmp_path / name / "summary.json").write_text(json.dumps(SUMMARY | more))
    return tmp_path


def test_rows_and_the_run_time_of_a_design_with_its_macros(folder, capsys):
    assert main(compare, ["phase_path", "phase_path_macros", "--out", str(folder)]) == 1  # limits not measured
    table = json.loads((folder / "hierarchy" / "table.json").read_text())
    assert table["run time, s"] == {"phase_path": "20.0", "phase_path_macros": "21.0", "quad_divider, a block": "1.0"}
    assert table["cells, clock buffers included"] == {
        "phase_path": "100",
        "phase_path_macros": "90",
        "quad_divider, a block": "100",
    }
    assert table["setup slack, ns"]["phase_path"] == "1.5 (tt), 0.25 (ss)"
    assert "phase_path_macros" in (folder / "hierarchy" / "report.html").read_text()
    assert "phase_path_macros" in capsys.readouterr().out


def test_a_missing_layout_is_named(tmp_path, capsys):
    assert main(compare, ["phase_path", "phase_path_macros", "--out", str(tmp_path)]) == 2
    assert "make layout DESIGN=phase_path\n" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_power_beside_that_of_the_thesis():
    found = table_6_1({"seq": 100.0, "regs": 50.0, "bank": 20.0, "phase": 30.0, "clock tree": 60.0}, 0.2)
    assert found == {
        "pixel_array": [300.0, None],
        "amplifiers": [900.0, 0.0],
        "timing": [500.0, 30.0],
        "adcs": [100.0, 4.0],
        "phase": [None, 6.0],
        "clock tree": [None, 12.0],
    }
    assert table_6_1(None, 0.2) is None
