"""Registers behind clock gates are proven to be those of the Verilog, and no gate that is none is taken for one."""

from dataclasses import replace

import pytest

from talbot.base.steps import StepError
from talbot.cells.netlist.function import Storage
from talbot.flow.layout.steps.equivalence import Equivalence, EquivalenceParameters
from talbot.flow.layout.steps.synthesis import Synthesis, SynthesisParameters
from talbot.flow.layout.steps.test.equivalence_test import CELLS, FLIP_FLOP, PORTS
from talbot.flow.layout.timing import liberty
from talbot.signoff.netlist.netlist import Instance, Netlist

pytestmark = pytest.mark.needs("yosys")

RTL = """
module Kept(input clk, input reset, input go, input [3:0] d, output reg [3:0] kept, output reg [1:0] count);
  always @(posedge clk)
    if (reset) begin kept <= 4'd5; count <= 2'd0; end
    else begin
      if (go) kept <= d;
      count <= count + {1'b0, kept[0]};
    end
endmodule
"""
GATE = Storage("gate", "clk", 1, "i", ("i",))
FUNCTIONS = {name: liberty.Function({pin: function}, None) for name, (pin, function) in CELLS.items()}
FUNCTIONS |= {"dff_x1": liberty.Function({"q": "IQ"}, FLIP_FLOP), "cg_x1": liberty.Function({"q": "clk & IQ"}, GATE)}
SEQUENTIAL = {"dff_x1": ("clk", "i", "q"), "cg_x1": ("clk", "i", "q")}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Folder with rtl.v, cells.lib and what Synthesis made of them."""
    folder = tmp_path_factory.mktemp("kept")
    (folder / "rtl.v").write_text(RTL)
    (folder / "cells.lib").write_text(liberty.liberty(FUNCTIONS, PORTS | SEQUENTIAL, dict.fromkeys(FUNCTIONS, 10.0)))
    step = Synthesis(SynthesisParameters("Kept", "clk", 10.0, 0))
    outputs = {name: folder / file for name, file in step.outputs.items()}
    found = step.run({"rtl": folder / "rtl.v", "liberty": folder / "cells.lib"}, outputs)
    assert (found["flip_flops"], found["clock_gates"]) == (6, 1)
    return folder


def verdict(folder, netlist, cells="cells.lib"):
    """What Equivalence says of ``netlist`` (Netlist)."""
    netlist.write(folder / "tried.json")
    (folder / "tried.v").write_text(netlist.verilog())
    files = {"rtl": "rtl.v", "netlist": "tried.json", "verilog": "tried.v", "liberty": cells}
    inputs = {name: folder / file for name, file in files.items()}
    return Equivalence(EquivalenceParameters("Kept")).run(inputs, {"summary": folder / "equivalence.json"})[
        "equivalence"
    ]


def changed(netlist, name, **pins):
    """The same with other nets at the pins of the instances whose name begins with ``name``."""
    found = [i for i in netlist.instances if i.name.startswith(name)]
    assert found
    return replace(
        netlist, instances=tuple(replace(i, pins=i.pins | pins) if i in found else i for i in netlist.instances)
    )


def gate_of(netlist):
    return next(i for i in netlist.instances if i.cell == "cg_x1")


def test_a_gated_netlist_is_proven(made):
    netlist = Netlist.read(made / "netlist.json")
    clocks = {i.name: i.pins["clk"] for i in netlist.instances if i.cell == "dff_x1"}
    assert {name for name, net in clocks.items() if net == gate_of(netlist).pins["q"]} == {
        f"kept[{k}]_reg" for k in range(4)
    }
    assert verdict(made, netlist) == "proven"


def test_another_enable_or_clock_is_found(made):
    netlist = Netlist.read(made / "netlist.json")
    gate = gate_of(netlist)
    assert verdict(made, changed(netlist, gate.name, i="go")) == "failed"  # without the reset
    assert verdict(made, changed(netlist, "kept[1]", clk="clk")) == "failed"
    assert verdict(made, changed(netlist, "count[0]", clk=gate.pins["q"])) == "failed"


def test_a_clock_as_data_is_refused(made):
    netlist = Netlist.read(made / "netlist.json")
    with pytest.raises(StepError, match="as data"):
        verdict(made, changed(netlist, "count[1]", i=gate_of(netlist).pins["q"]))
    with pytest.raises(StepError, match="as data"):
        verdict(made, changed(netlist, "count[1]", i="clk"))


def test_a_gate_without_a_latch_is_refused(made):
    netlist = Netlist.read(made / "netlist.json")
    gate = gate_of(netlist)
    plain = [i for i in netlist.instances if i != gate]
    plain.append(Instance("low", "nand2_x1", {"i0": gate.pins["i"], "i1": "clk", "nq": "not_gated"}))
    plain.append(Instance("high", "inv_x1", {"i": "not_gated", "nq": gate.pins["q"]}))
    with pytest.raises(StepError, match="no gate with a latch"):
        verdict(made, replace(netlist, instances=tuple(plain)))


def test_a_latch_that_is_open_while_the_clock_is_high_is_refused(made):
    text = (made / "cells.lib").read_text()
    assert text.count('"!clk"') == 1
    (made / "wrong.lib").write_text(text.replace('"!clk"', '"clk"'))
    with pytest.raises(StepError, match="no gate with a latch"):
        verdict(made, Netlist.read(made / "netlist.json"), "wrong.lib")
