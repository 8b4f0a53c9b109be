"""The steps of a layout: the README lists each with its file; installed decks are run."""

import os
import re
from dataclasses import replace
from pathlib import Path

import pytest

from talbot.flow.layout.chain import all_steps, signoff_steps, stages
from talbot.flow.layout.design import DESIGNS, design
from talbot.flow.layout.options import Options
from talbot.flow.layout.sensor.die import CHIP, die_steps
from talbot.flow.layout.sensor.plan import BLOCKS
from talbot.flow.layout.steps.stage import SCRIPTS, STAGES, design_tcl
from talbot.flow.layout.variables import Floor
from talbot.rtl.reg_file.test.reg_file_test import ARRAY
from talbot.rtl.sensor_options import sensor_with

FOLDER = Path(__file__).parents[1]
DECKS = (("klayout", Path("deck")), ("magic", Path("deck")))
STEP = re.compile(r"\[`([\w<>]+)`\]\(([\w/.]+\.py)\)")


@pytest.fixture
def steps():
    """All steps of all designs and of the die, by the name in the README."""
    options = Options(decks=DECKS)
    found = {}
    for made in DESIGNS.values():
        own = replace(options, utilization=made.utilization)
        for step in (*all_steps(made, own), *(die_steps(made, own, drawn=BLOCKS) if made.name == CHIP else ())):
            corner = next((corner for corner in options.corners if step.name.endswith(corner)), None)
            name = step.name.replace(corner, "<corner>") if corner else step.name
            found[re.sub(r"^gate_tests_.*", "gate_tests_<netlist>_<simulator>", name)] = step
    return found


def test_the_readme_lists_every_step_with_its_file(steps):
    listed = STEP.findall((FOLDER / "README.md").read_text())
    assert sorted(name for name, _ in listed) == sorted(steps)
    for name, file in listed:
        place = Path(os.path.normpath(FOLDER / file)).relative_to(FOLDER.parents[1])
        module = ".".join(("talbot", *place.with_suffix("").parts))
        assert type(steps[name]).__module__ == module, name


def test_installed_decks_are_run():
    steps = signoff_steps(design("amp_ctrl"), Options(decks=DECKS))
    assert {"foundry_drc", "magic_drc"} <= {step.name for step in steps}


@pytest.mark.parametrize("stage", [stage for stage in STAGES if "$supply" in (SCRIPTS / f"{stage}.tcl").read_text()])
def test_the_supplies_of_a_frame_have_its_names(stage):
    (step,) = (s for s in stages(DESIGNS["tt_quad_divider"], Options(), Floor()) if s.name == stage)
    assert "set supply {VPWR}" in design_tcl(step.parameters)


def test_the_register_file_has_the_parameters_of_its_tests():
    sensor = sensor_with(design("reg_file").options)
    sizes = sensor.array.rows, sensor.array.cols, sensor.chip.lanes, sensor.tile.rows, sensor.tile.cols
    assert (*sizes, sensor.chip.divider) == ARRAY
