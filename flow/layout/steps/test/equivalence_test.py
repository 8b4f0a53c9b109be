"""Equal designs are proven equal, and every planted fault is found."""

import re
from dataclasses import replace

import pytest

from talbot.base.steps import StepError
from talbot.cells.netlist.function import Storage
from talbot.flow.layout.steps.equivalence import Equivalence, EquivalenceParameters
from talbot.flow.layout.steps.synthesis import Synthesis, SynthesisParameters
from talbot.flow.layout.timing import liberty
from talbot.signoff.netlist.netlist import Instance, Netlist

pytestmark = pytest.mark.needs("yosys")

RTL = """
module Counter(input clk, input reset, input [1:0] step, output reg [3:0] count, output high);
  reg never, odd;
  assign high = (count > 4'd9) | never;
  always @(posedge clk) begin
    count <= reset ? 4'd0 : count + {2'b00, step} + {3'b000, odd};
    never <= reset ? 1'b0 : step[0] & 1'b0;
    odd <= count[0];
  end
endmodule
"""
CELLS = {
    "inv_x1": ("nq", "!i"),
    "buf_x1": ("q", "i"),
    "nand2_x1": ("nq", "!(i0&i1)"),
    "nor2_x1": ("nq", "!(i0|i1)"),
    "xor2_x1": ("q", "i0^i1"),
    "zero_x1": ("zero", "0"),
    "one_x1": ("one", "1"),
    "dff_x1": ("q", "IQ"),
}
FLIP_FLOP = Storage("ff", "clk", 1, "i", ("i",))
PORTS = {name: (*sorted(set(re.findall(r"i\d?", function))), output) for name, (output, function) in CELLS.items()}
LIBERTY = liberty.liberty(
    {
        name: liberty.Function({output: function}, FLIP_FLOP if name == "dff_x1" else None)
        for name, (output, function) in CELLS.items()
    },
    PORTS | {"dff_x1": ("clk", "i", "q")},
    dict.fromkeys(CELLS, 10.0),
)


def synthesized(folder, verilog):
    """What Synthesis says of ``verilog``; in ``folder`` rtl.v, cells.lib and what the step made."""
    (folder / "rtl.v").write_text(verilog)
    (folder / "cells.lib").write_text(LIBERTY)
    step = Synthesis(SynthesisParameters("Counter", "clk", 10.0, 0))
    return step.run(
        {"rtl": folder / "rtl.v", "liberty": folder / "cells.lib"},
        {name: folder / file for name, file in step.outputs.items()},
    )


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Folder with the synthesized Counter."""
    folder = tmp_path_factory.mktemp("counter")
    found = synthesized(folder, RTL)
    assert found["flip_flops"] == 5 and found["cell_area_um2"] == 10.0 * found["cells"]
    return folder


def verdict(folder, netlist, rtl=RTL, reset="reset"):
    """What Equivalence says of ``netlist`` (Netlist) against the Verilog ``rtl``."""
    netlist.write(folder / "tried.json")
    (folder / "tried.v").write_text(netlist.verilog())
    (folder / "tried_rtl.v").write_text(rtl)
    return Equivalence(EquivalenceParameters("Counter", reset=reset)).run(
        {
            "rtl": folder / "tried_rtl.v",
            "netlist": folder / "tried.json",
            "verilog": folder / "tried.v",
            "liberty": folder / "cells.lib",
        },
        {"summary": folder / "equivalence.json"},
    )


def test_the_netlist_is_proven_with_its_constant_register_shown_by_induction(made):
    assert verdict(made, Netlist.read(made / "netlist.json")) == {
        "equivalence": "proven",
        "registers": 5,
        "constant_registers": 1,
        "double_registers": 0,
        "idle_registers": 0,
    }


@pytest.mark.parametrize("old, new", [("4'd9", "4'd8"), ("odd <= count[0]", "odd <= count[1]"), ("4'd0 :", "4'd1 :")])
def test_a_changed_bit_of_the_rtl_is_found(made, old, new):
    assert verdict(made, Netlist.read(made / "netlist.json"), RTL.replace(old, new))["equivalence"] == "failed"


def test_every_swapped_cell_is_found(made):
    netlist = Netlist.read(made / "netlist.json")
    swaps = {"nand2_x1": "nor2_x1", "nor2_x1": "nand2_x1", "xor2_x1": "nand2_x1"}
    places = [k for k, instance in enumerate(netlist.instances) if instance.cell in swaps][:4]
    for k in places:
        old = netlist.instances[k]
        pins = {"nq" if pin == "q" else pin: net for pin, net in old.pins.items()}
        swapped = (*netlist.instances[:k], Instance(old.name, swaps[old.cell], pins), *netlist.instances[k + 1 :])
        assert verdict(made, replace(netlist, instances=swapped))["equivalence"] == "failed"


@pytest.mark.parametrize("reset, result", (("rst_n", "proven"), ("reset", "failed")))
def test_a_reset_may_be_active_at_0(tmp_path, reset, result):
    """A register that is constant only after the reset; the other name's is no port."""
    rtl = RTL.replace("input reset", "input rst_n").replace("reset ?", "!rst_n ?").replace("step[0] & 1'b0", "never")
    synthesized(tmp_path, RTL.replace("input reset", "input rst_n").replace("reset ?", "!rst_n ?"))
    netlist = Netlist.read(tmp_path / "netlist.json")
    kept = tuple(i for i in netlist.instances if i.name != "never_reg")
    found = verdict(tmp_path, replace(netlist, instances=kept), rtl, reset)
    assert (found["equivalence"], found["constant_registers"]) == (result, int(result == "proven"))


def test_a_cut_net_is_found(made):
    netlist = Netlist.read(made / "netlist.json")
    k = next(k for k, i in enumerate(netlist.instances) if i.cell.startswith("nand2"))
    old = netlist.instances[k]
    cut = (*netlist.instances[:k], replace(old, pins=old.pins | {"i0": "nowhere"}), *netlist.instances[k + 1 :])
    assert verdict(made, replace(netlist, instances=cut))["equivalence"] == "failed"


@pytest.mark.parametrize("source, result", (("count[1]", "proven"), ("count[2]", "failed")))
def test_a_register_that_nothing_reads_is_compared_where_it_is(made, source, result):
    """A macro has registers that the design around it does not use."""
    netlist = Netlist.read(made / "netlist.json")
    spare = Instance("spare_reg", "dff_x1", {"clk": "clk", "i": source, "q": "spare"})
    rtl = RTL.replace("endmodule", "  reg spare;\n  always @(posedge clk) spare <= count[1];\nendmodule")
    assert verdict(made, replace(netlist, instances=(*netlist.instances, spare)), rtl)["equivalence"] == result


@pytest.mark.parametrize("read, result", (("lost & count[3] & ~count[3]", "proven"), ("lost & count[3]", "failed")))
def test_a_register_without_effect_may_hold_anything(made, read, result):
    """It is in the Verilog's cone of an output, and neither a constant nor a double: the netlist lacks it."""
    rtl = RTL.replace("| never", f"| never | ({read})").replace("odd;", "odd, lost;", 1)
    rtl = rtl.replace("odd <=", "lost <= step[1] ^ step[0];\n    odd <=")
    found = verdict(made, Netlist.read(made / "netlist.json"), rtl)
    assert (found["equivalence"], found["idle_registers"]) == (result, 1)


def test_a_flip_flop_that_is_no_register_is_named(made):
    netlist = Netlist.read(made / "netlist.json")
    renamed = [replace(i, name="other_reg") if i.name == "count[0]_reg" else i for i in netlist.instances]
    with pytest.raises(StepError, match="the RTL has no register other"):
        verdict(made, replace(netlist, instances=tuple(renamed)))


# A table that is read beyond its end (x), and two registers that are always equal, of which Yosys keeps one
TABLE = """
module Counter(input clk, input reset, input [1:0] step, output [3:0] count, output high);
  reg [3:0] kept [0:2];
  reg [1:0] row, tile;
  assign count = kept[step];
  assign high = (row > step) ^ (tile == 2'd2);
  always @(posedge clk) begin
    if (reset) begin
      kept[0] <= 4'd1; kept[1] <= 4'd5; kept[2] <= 4'd8; row <= 2'd0; tile <= 2'd0;
    end else begin
      if (step != 2'd3) kept[step] <= kept[step] + 4'd3;
      if (step[0]) begin row <= tile + step; tile <= tile + step; end
    end
  end
endmodule
"""


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    folder = tmp_path_factory.mktemp("table")
    synthesized(folder, TABLE)
    return folder


def test_a_double_is_shown_to_be_one_and_what_the_verilog_leaves_open_is_open(table):
    found = verdict(table, Netlist.read(table / "netlist.json"), TABLE)
    assert (found["equivalence"], found["constant_registers"], found["double_registers"]) == ("proven", 0, 2)


@pytest.mark.parametrize(
    "old, new",
    [
        ("count = kept[step]", "count = kept[step ^ 2'd1]"),
        ("count = kept[step]", "count = kept[step] ^ {3'd0, step == 2'd2}"),
        ("row <= tile + step", "row <= tile - step"),
        ("row <= 2'd0", "row <= 2'd1"),
        ("tile == 2'd2", "tile == 2'd1"),
    ],
)
def test_a_change_beside_what_is_open_or_double_is_found(table, old, new):
    assert verdict(table, Netlist.read(table / "netlist.json"), TABLE.replace(old, new))["equivalence"] == "failed"


# Two registers that are always equal; no random state shows that their upper bit is not always 0
RARE = """
module Counter(input clk, input reset, input [47:0] key, output [1:0] state, output same);
  reg [1:0] row, tile;
  assign state = row;
  assign same = tile[1] ^ tile[0];
  always @(posedge clk)
    if (reset) begin row <= 2'd0; tile <= 2'd0; end
    else begin
      row <= {key == 48'haaaa_5555_f00f, row[0] ^ key[0]};
      tile <= {key == 48'haaaa_5555_f00f, tile[0] ^ key[0]};
    end
endmodule
"""


def test_a_wrong_guess_of_a_constant_does_not_hide_a_double(tmp_path):
    synthesized(tmp_path, RARE)
    netlist = Netlist.read(tmp_path / "netlist.json")
    found = verdict(tmp_path, netlist, RARE)
    assert (found["equivalence"], found["constant_registers"], found["double_registers"]) == ("proven", 0, 1)
    assert verdict(tmp_path, netlist, RARE.replace("tile <= {key", "tile <= {~key"))["equivalence"] == "failed"


MEMORY = """
module Counter(input clk, input reset, input push, input pop, input [2:0] d, output [2:0] q);
  reg [2:0] words [0:3];
  reg [1:0] at, from;
  assign q = words[from];
  always @(posedge clk) begin
    if (push) words[at] <= d;
    at <= reset ? 2'd0 : at + push;
    if (reset) from <= 2'd0; else if (pop) from <= from + 2'd1;
  end
endmodule
"""


def test_a_memory_and_the_registers_of_its_addresses_keep_their_names(tmp_path):
    synthesized(tmp_path, MEMORY)
    netlist = Netlist.read(tmp_path / "netlist.json")
    registers = {i.name for i in netlist.instances if i.cell == "dff_x1"}
    words = {f"words[{at}][{k}]_reg" for at in range(4) for k in range(3)}
    assert registers == words | {f"{name}[{k}]_reg" for name in ("at", "from") for k in range(2)}
    assert verdict(tmp_path, netlist, MEMORY)["equivalence"] == "proven"
    assert verdict(tmp_path, netlist, MEMORY.replace("q = words[from]", "q = words[~from]"))["equivalence"] == "failed"
