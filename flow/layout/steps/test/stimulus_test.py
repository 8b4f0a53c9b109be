"""The place of a block in the chip, and whether it is the same block."""

import json

import pytest

from talbot.flow.layout.steps.stimulus import (
    Stimulus,
    StimulusParameters,
    instance_of,
    middle,
    recorded,
    results,
    settled,
)
from talbot.models.parameters import Window
from talbot.rtl.verilog import export_verilog
from talbot.signoff.netlist.verilog import modules

BLOCK = """
module Leaf (input clk);
  // At rtl/leaf.py:3
  always @* begin : _lambda__s_one
  end
endmodule
"""


def test_the_same_module_elsewhere_is_the_same():
    elsewhere = BLOCK.replace("_lambda__s_one", "_lambda__s_chip_part_one").replace("leaf.py:3", "leaf.py:9")
    assert modules(elsewhere) == modules(BLOCK)
    assert modules(BLOCK.replace("input clk", "input ck")) != modules(BLOCK)


def test_the_first_instance_is_found():
    tree = {
        "Top": {"cells": {"b": {"type": "Middle"}, "a": {"type": "$and"}}},
        "Middle": {"cells": {"deep": {"type": "Leaf"}}},
        "Leaf": {"cells": {}},
    }
    assert instance_of(tree, "Top", "Leaf") == ("b", "deep")
    assert instance_of(tree, "Top", "Top") == ()
    assert instance_of(tree, "Top", "Other") is None


@pytest.mark.parametrize("tiles, columns", ((1, (2, 2)), (2, (1, 2)), (5, (0, 4))))
def test_the_tiles_of_the_middle(tiles, columns):
    made = middle(Window(0, 6, 0, 4), tiles)
    assert (made.row0, made.row1, made.col0, made.col1) == (3, 3, *columns)


def test_a_reset_lasts_as_long_as_outputs_are_unknown():
    assert settled("0 11111 xxxx0011") == "1 1f 03"
    assert settled("1 11111 11") == "1 1f 3" and settled("0 11111 11") == "0 1f 3"


def test_a_reset_with_unknown_data_is_kept():
    """RunLength's message is unknown during the chip's reset."""
    assert settled("0 xx1x1 001") == "0 05 1"


def test_a_trace_begins_fresh():
    assert recorded("0 x1 1\n0 11 1\n0 10 x\n0 10 1\n") == ["1 1 1", "0 3 1", "1 2 0", "0 2 1"]


@pytest.mark.needs("iverilog", "yosys")
def test_a_wrappers_is_that_of_its_host(tmp_path):
    top = "tt_um_talbot_divider"
    (rtl,) = export_verilog(tmp_path, [top])
    step = Stimulus(StimulusParameters(top, "tinytapeout"))
    found = step.run({"rtl": rtl}, {name: tmp_path / file for name, file in step.outputs.items()})
    lines = (tmp_path / "stimulus.trace").read_text().split("\n")[:-1]
    ports = {port["path"]: port["width"] for port in json.loads((tmp_path / "stimulus.json").read_text())["ports"]}
    assert found == {"source": "host", "cycles": len(lines), "results": 0} and len(lines) > 500
    assert ports == dict.fromkeys(("ena", "rst_n"), 1) | dict.fromkeys(
        ("ui_in", "uo_out", "uio_in", "uio_out", "uio_oe"), 8
    )
    fresh = [line.startswith("1") for line in lines]
    assert fresh[0] and not any(fresh[fresh.index(False) :])  # once reset, nothing is unknown
    assert all("x" not in line for line in lines)


def test_results_are_what_left():
    ports = [
        {"path": "a", "width": 4, "output": False},
        {"path": "send.rdy", "width": 1, "output": False},
        {"path": "send.msg", "width": 7, "output": True},
        {"path": "send.val", "width": 1, "output": True},
    ]
    lines = ["0 10 80", "0 1f ff", "0 0f ff", "0 10 7f"]  # both; both; not ready; not valid
    assert results(lines, ports) == 2
    assert results(lines, ports[:2]) == 0
