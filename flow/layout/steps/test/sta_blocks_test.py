"""A design around a block: its slacks by the block's Liberty are those by the block's cells."""

import json

import pytest

from talbot.flow.layout.design import Design
from talbot.flow.layout.netlist.flatten import flattened
from talbot.flow.layout.netlist.netlist import Instance, Netlist, Port
from talbot.flow.layout.netlist.test import shift_register as small
from talbot.flow.layout.steps.block_liberty import BlockLiberty, BlockLibertyParameters
from talbot.flow.layout.steps.sta import Sta, StaParameters
from talbot.flow.layout.steps.sta_blocks import StaBlocks, StaBlocksParameters
from talbot.flow.layout.timing.constraints import sdc
from talbot.flow.layout.timing.spef import spef

pytestmark = pytest.mark.needs("sta", "yosys")
TOP = Netlist(
    "Top",
    (Port("clk", "input", 1), Port("in", "input", 1), Port("out", "output", 1)),
    (
        Instance("ahead_reg", "dff_x1", {"i": "in", "clk": "clk", "q": "n0"}),
        Instance("part", "Shift", {"clk": "clk", "a": "n0", "y": "n1", "n": "n2"}),
        Instance("u0", "inv_x1", {"i": "n1", "nq": "n3"}),
        Instance("behind_reg", "dff_x1", {"i": "n3", "clk": "clk", "q": "out"}),
    ),
)


def write(folder, **texts):
    for name, text in texts.items():
        (folder / name).write_text(text)
    return {name: folder / name for name in texts}


def run(step, inputs, folder):
    folder.mkdir()
    return step.run(inputs, {name: folder / file for name, file in step.outputs.items()})


def test_the_liberty_of_a_block_stands_for_its_cells(tmp_path):
    block, whole = small.shift(), flattened(TOP, {"part": small.shift()})
    block.write(tmp_path / "block.json")
    TOP.write(tmp_path / "top.json")
    files = write(
        tmp_path,
        liberty=small.liberty(),
        sdc=sdc(Design("top", "Top", "")),
        verilog=block.verilog(),
        spef=spef(block, {"w0": (0.001, 1.0)}),
        areas=json.dumps({"width_um": 4.0, "height_um": 5.0}),
        whole=whole.verilog(),
        wires=spef(whole, {"part.w0": (0.001, 1.0)}),
        outside=spef(TOP, {"n1": (0.001, 1.0)}),
    )
    run(BlockLiberty(BlockLibertyParameters("tt")), files | {"netlist": tmp_path / "block.json"}, tmp_path / "own")
    by_cells = run(
        Sta(StaParameters("Top", "tt", 20.0)),
        files | {"verilog": files["whole"], "spef": files["wires"]},
        tmp_path / "cells",
    )
    step = StaBlocks(StaBlocksParameters("sky130", "Top", "tt", ("Shift",)))
    assert step.inputs["Shift"] == "macro.Shift.tt"
    by_blocks = run(
        step,
        files | {"netlist": tmp_path / "top.json", "spef": files["outside"], "Shift": tmp_path / "own" / "block.lib"},
        tmp_path / "blocks",
    )
    assert by_blocks["blocks_wns_ns"] == pytest.approx(by_cells["wns_ns"], abs=0.02)
    assert by_blocks["blocks_whs_ns"] == pytest.approx(by_cells["whs_ns"], abs=0.02)
