"""The chip of a sensor file: sizes, clock, name of the folder, the frames that its netlist must pass."""

from argparse import Namespace

import pytest

from talbot.flow.layout.chain import input_files, netlist_tests, timing_steps
from talbot.flow.layout.design import design, design_asked, folder_name
from talbot.flow.layout.options import Options
from talbot.flow.layout.steps.gate_frames import few
from talbot.flow.layout.varied import CHIP, SENSOR
from talbot.models.parameters import ParameterError, Window

TEXT = """
array = { rows = 9, cols = 14, pitch = 12e-6 }
tile = { rows = 2, cols = 3 }
chip = { lanes = 2, divider = "radix2", n_frac = 6, f_clk = 80e6 }
"""


@pytest.fixture
def small(tmp_path):
    (tmp_path / "small.toml").write_text(TEXT)
    return Namespace(sensor=tmp_path / "small.toml")


def test_the_chip_follows_the_file(small):
    chip = design_asked(CHIP, small)
    assert chip.options[:3] == ("--rows=9", "--cols=14", "--lanes=2") and chip.clock.period_ns == 12.5
    assert (chip.divider, chip.n_frac, folder_name(chip, "sky130")) == ("radix2", 6, "asp_chip-small")
    assert folder_name(chip, "other") == "asp_chip-other-small"
    steps = {step.name: step.parameters for step in (*netlist_tests(chip), *timing_steps(chip, Options()))}
    assert steps["gate_frames"].options == steps["stimulus"].options == chip.options


def test_without_a_file_it_is_the_design():
    assert design_asked(CHIP, Namespace(sensor=None)) == design_asked(SENSOR, Namespace(sensor=None)) == design(CHIP)


@pytest.mark.parametrize("name", ("readout_seq", "tt_asp_chip", SENSOR))
def test_other_designs_refuse_it(name, small):
    line = r"tile.rows = 2: must be 4 \(DESIGN=asp_chip alone is laid out in other sizes .* varies nothing\)"
    with pytest.raises(ParameterError, match=line):
        design_asked(name, small)


def test_a_field_without_effect_is_taken(tmp_path):
    (tmp_path / "lens.toml").write_text("optics.camera.focus = 0.3")
    assert design_asked("edge_adc", Namespace(sensor=tmp_path / "lens.toml")) == design("edge_adc")


def test_a_small_array_is_read_whole():
    assert few(Window(0, 95, 0, 63)) == Window(3, 4, 5, 8)
    assert few(Window(0, 0, 0, 5)) == Window(0, 0, 5, 5)


@pytest.mark.needs("iverilog")
@pytest.mark.slow
def test_its_frames_are_the_golden_chips(small, tmp_path):
    chip, cells = design_asked(CHIP, small), tmp_path / "cells.v"
    cells.write_text("")  # the RTL stands for the netlist
    files = input_files(chip, Options(), tmp_path)
    (step,) = netlist_tests(chip)
    counts = step.run({"verilog": files["rtl"], "cells": cells}, {"log": tmp_path / "frames.txt"})
    assert (counts["passed"], counts["failed"]) == (3, 0)
    assert "create_clock -name clk -period 12.5 " in files["sdc"].read_text()
