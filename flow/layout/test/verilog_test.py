"""A user's Verilog: read with what it includes, refused with file and line, and a Design with the ports asked for."""

import pytest

from talbot.flow.layout.verilog import design_of, verilog_text
from talbot.models.parameters import ParameterError

pytestmark = pytest.mark.needs("yosys")

FIFO = """`include "depth.vh"
module Fifo #(parameter W = 4) (input clk, input rst_n, input push, input pop, input [W-1:0] d, output [W-1:0] q);
  reg [W-1:0] words [0:`DEPTH-1];
  reg [1:0] write, read;
  assign q = words[read];
  always @(posedge clk)
    if (!rst_n) begin write <= 0; read <= 0; end
    else begin
      if (push) begin words[write] <= d; write <= write + 1; end
      if (pop) read <= read + 1;
    end
endmodule
"""
PORTS = "module Top(input clk, input d, input [1:0] w, output reg q);\n"


@pytest.fixture
def fifo(tmp_path):
    (tmp_path / "depth.vh").write_text("`define DEPTH 4\n")
    path = tmp_path / "fifo.v"
    path.write_text(FIFO)
    return path


def test_a_design_has_the_module_and_its_ports(fifo):
    design = design_of([fifo], "Fifo", reset="rst_n", period_ns=8.0)
    assert (design.name, design.top, design.reset, design.verilog) == ("Fifo", "Fifo", "rst_n", (fifo,))
    assert (design.clock.port, design.clock.period_ns) == ("clk", 8.0)
    assert design_of([fifo], "Fifo").reset == ""


def test_the_name_of_a_block_is_not_taken(tmp_path):
    path = tmp_path / "own.v"
    path.write_text(PORTS.replace("Top", "amp_ctrl") + "always @(posedge clk) q <= d;\nendmodule\n")
    assert design_of([path], "amp_ctrl").name == "amp_ctrl_verilog"


def test_lines_count_in_the_file_that_has_them(fifo):
    assert [line for line in verilog_text([fifo]).splitlines() if line.startswith("`line")] == [
        f'`line 1 "{fifo}" 0', f'`line 1 "{fifo.parent / "depth.vh"}" 0', f'`line 2 "{fifo}" 0'
    ]  # fmt: skip
    fifo.write_text(FIFO.replace("reg [1:0] write, read;", "reg [1:0] write read;"))
    with pytest.raises(ParameterError, match=r"^verilog = \S+/fifo.v:4: syntax error"):
        design_of([fifo], "Fifo")


@pytest.mark.parametrize(
    "body, message",
    [
        ("always @(posedge clk or posedge d) if (d) q <= 0; else q <= w[0];", "must have flip-flops .*adff"),
        ("always @* if (d) q = w[0];", "must have flip-flops .*dlatch"),
        ("always @(negedge clk) q <= d;", "must take the rising edge of clk alone: .*v:2"),
        ("always @(posedge d) q <= w[0];", "must take the rising edge of clk alone"),
        ("Missing missing(.q(q));", "Missing"),
    ],
)
def test_what_cannot_be_laid_out_is_refused(tmp_path, body, message):
    path = tmp_path / "top.v"
    path.write_text(f"{PORTS}{body}\nendmodule\n")
    with pytest.raises(ParameterError, match=message):
        design_of([path], "Top")


@pytest.mark.parametrize(
    "options, message",
    [
        ({"top": "Other"}, "verilog = .*Other"),
        ({"top": "a b"}, "^top = 'a b': must be the name of a module"),
        ({"clock": "push"}, "must take the rising edge of push alone"),
        ({"clock": "d"}, "^clock = 'd': must be an input of one bit: clk, rst_n, push, pop"),
        ({"reset": "q"}, "^reset = 'q': must be an input of one bit"),
        ({"period_ns": 0.1}, "^period_ns = 0.1: must be a number in"),
    ],
)
def test_wrong_names_and_ranges_are_refused(fifo, options, message):
    with pytest.raises(ParameterError, match=message):
        design_of([fifo], **{"top": "Fifo", **options})


def test_files_that_are_not_there_or_include_themselves_are_refused(fifo):
    with pytest.raises(ParameterError, match=r"^verilog = \S+/no.v: no such file"):
        verilog_text([fifo.with_name("no.v")])
    fifo.with_name("depth.vh").write_text('`include "fifo.v"\n')
    with pytest.raises(ParameterError, match=r"must not include itself"):
        verilog_text([fifo])
