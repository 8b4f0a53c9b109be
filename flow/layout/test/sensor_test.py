"""Chip and blocks of a sensor file: sizes, clock, name of the folder, the frames that the chip's netlist must pass."""

from argparse import Namespace
from dataclasses import replace

import pytest

from talbot.flow.layout.chain import input_files, netlist_tests, timing_steps
from talbot.flow.layout.design import design, design_asked, folder_name
from talbot.flow.layout.options import Options
from talbot.flow.layout.sensor.die import lay_out_sensor
from talbot.flow.layout.steps.gate_frames import few
from talbot.flow.layout.varied import CHIP, SENSOR
from talbot.models.parameters import ParameterError, Window, read_sensor

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


BLOCKS = "readout_seq", "adc_bank", "run_length", "reg_file", "phase_path"


@pytest.mark.parametrize("name", BLOCKS)
def test_a_block_follows_the_file(name, small):
    block = design_asked(name, small)
    assert block.options == design_asked(CHIP, small).options and folder_name(block, "sky130") == f"{name}-small"
    stimulus = next(step for step in timing_steps(block, Options()) if step.name == "stimulus")
    assert netlist_tests(block) == [] and stimulus.parameters.options == block.options
    assert block.clock.period_ns == 12.5


def test_a_divider_is_looked_for_in_a_chip_that_has_it(small):
    block = design_asked("cordic", small)
    assert block.divider == "cordic" and block.options[-2:] == ("--divider=cordic", "--n-frac=6")


def test_a_block_without_sizes_changes_its_clock_alone(small):
    block, standard = design_asked("edge_adc", small), design("edge_adc")
    assert block == replace(standard, clock=replace(standard.clock, period_ns=12.5), label="small")


def test_a_block_that_the_sensor_lacks_is_refused(tmp_path):
    (tmp_path / "none.toml").write_text('chip.divider = "none"')
    with pytest.raises(ParameterError, match="DESIGN = 'phase_path': must be a block of the sensor"):
        design_asked("phase_path", Namespace(sensor=tmp_path / "none.toml"))


def test_wrappers_refuse_it(small):
    line = r"tile.rows = 2: must be 4 \(this design has the sizes of the standard sensor; .* varies nothing\)"
    with pytest.raises(ParameterError, match=line):
        design_asked("tt_asp_chip", small)


def test_the_die_follows_what_circuits_are_drawn_for(small):
    text = TEXT.replace(", f_clk = 80e6", "")
    small.sensor.write_text(text)
    assert design_asked(SENSOR, small) == design_asked(CHIP, small)
    changes = {
        "array.pitch": ("12e-6", "8e-6"),
        "array.rows": ("rows = 9", "rows = 500"),
        "chip.f_clk": ("lanes", "f_clk = 80e6, lanes"),
    }
    for field, change in changes.items():
        small.sensor.write_text(text.replace(*change))
        with pytest.raises(ParameterError, match=f"{field} = .*: must be "):
            design_asked(SENSOR, small)


@pytest.mark.needs("layout")
@pytest.mark.parametrize(
    "change, words",
    [
        ("", "cols = 14: 168 um must have room for pins"),
        ("cols = 14 -> cols = 210", "array.cols = 210: must be at most 96, the lines of 2 lanes"),
    ],
)
def test_a_die_that_cannot_be_drawn_is_refused_before_anything_runs(change, words, small, tmp_path):
    text = TEXT.replace(", f_clk = 80e6", "")
    small.sensor.write_text(text.replace(*change.split(" -> ")) if change else text)
    sensor, chip = read_sensor(small.sensor), design_asked(SENSOR, small)
    with pytest.raises(ParameterError, match=words):
        lay_out_sensor(chip, Options(), None, tmp_path / "out", print, sensor)
    assert not (tmp_path / "out").exists()


@pytest.mark.needs("iverilog", "yosys")
@pytest.mark.slow
@pytest.mark.parametrize("divider", ("none", "cordic"))
def test_a_block_is_recorded_in_a_frame_of_the_sensors_chip(divider, small, tmp_path):
    small.sensor.write_text(TEXT.replace("radix2", divider).replace("n_frac = 6,", ""))
    block = design_asked("run_length", small)
    files = input_files(block, Options(), tmp_path)
    stimulus = next(step for step in timing_steps(block, Options()) if step.name == "stimulus")
    outputs = {"head": tmp_path / "head.json", "trace": tmp_path / "trace"}
    seen = stimulus.run({"rtl": files["rtl"]}, outputs)
    assert seen["source"] == "frame" and seen["results"] > 0


def test_a_small_array_is_read_whole():
    assert few(Window(0, 95, 0, 63)) == Window(3, 4, 5, 8)
    assert few(Window(0, 0, 0, 5)) == Window(0, 0, 5, 5)


@pytest.mark.needs("iverilog")
@pytest.mark.slow
@pytest.mark.parametrize("divider", ("none", "radix2"))
def test_its_frames_are_the_golden_chips(divider, small, tmp_path):
    small.sensor.write_text(TEXT.replace("radix2", divider))
    chip, cells = design_asked(CHIP, small), tmp_path / "cells.v"
    cells.write_text("")  # the RTL stands for the netlist
    files = input_files(chip, Options(), tmp_path)
    (step,) = netlist_tests(chip)
    counts = step.run({"verilog": files["rtl"], "cells": cells}, {"log": tmp_path / "frames.txt"})
    assert (counts["passed"], counts["failed"]) == (5, 0)
    assert "create_clock -name clk -period 12.5 " in files["sdc"].read_text()
