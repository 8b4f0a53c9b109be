"""Twins with high-threshold transistors: hidden from the mapper, and what OpenROAD may swap for their cells."""

from talbot.base.liberty.read import parse
from talbot.cells.compact.catalogue import HIGH, named
from talbot.flow.layout.chain import stages
from talbot.flow.layout.design import design
from talbot.flow.layout.options import Options
from talbot.flow.layout.steps.stage import Stage, design_tcl
from talbot.flow.layout.steps.synthesis import plain_cells
from talbot.flow.layout.variables import Floor
from talbot.platforms.twins import TWIN

LIBERTY = """library(one) {
  cell(inv_x1) { area : 1; }
  cell(inv_x1_hvt) { area : 1; }
}
"""


def test_the_mapper_does_not_see_twins(tmp_path):
    (tmp_path / "given.lib").write_text(LIBERTY)
    chosen = plain_cells(tmp_path, dict.fromkeys(("liberty", "timing", "slowest"), tmp_path / "given.lib"))
    assert set(chosen) == {"liberty", "timing"}
    assert all([cell.name for cell in parse(path.read_text()).all("cell")] == ["inv_x1"] for path in chosen.values())


def test_a_twin_has_the_transistors_of_its_cell_but_for_the_model():
    for name in HIGH:
        cell, twin = named(name), named(f"{name}{TWIN}")
        assert (cell.ports, cell.n, cell.p, cell.functions) == (twin.ports, twin.n, twin.p, twin.functions)
        assert cell.models == {"n": "nfet_01v8", "p": "pfet_01v8"} and twin.models["p"] == "pfet_01v8_hvt"


def test_repair_does_not_use_twins_and_thresholds_know_the_clock():
    steps = [step for step in stages(design("edge_adc"), Options(), Floor()) if isinstance(step, Stage)]
    texts = {step.name: design_tcl(step.parameters) for step in steps}
    assert all("set dont_use {*_hvt}" in text and "set twin {_hvt}" in text for text in texts.values())
    assert "set clock {clk}" in texts["thresholds"]
