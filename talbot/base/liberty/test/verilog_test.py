"""Cells' functions in Verilog: registers begin with a bit each, not with X."""

import subprocess

import pytest

from talbot.base.liberty.functional import add_cell, library
from talbot.base.liberty.verilog import write_models
from talbot.base.liberty.write import text

BENCH = """module bench;
  wire [63:0] q, same;
  reg clk = 0;
  genvar k;
  generate for (k = 0; k < 64; k = k + 1) begin : g
    dff register (.d(q[k]), .c(clk), .q(q[k]));
    differ gate (.a(q[k]), .b(q[k]), .q(same[k]));
  end endgenerate
  initial begin #1 $display("%b %b", q, same); clk = 1; #1 $display("%b %b", q, same); end
endmodule
"""


@pytest.mark.needs("iverilog", "yosys")
def test_registers_begin_with_random_bits(tmp_path):
    cells = library("l")
    add_cell(cells, "dff", 1.0, ("d", "c", "q"), {"q": "IQ"}, {"clocked_on": "c", "next_state": "d"}, "c")
    add_cell(cells, "differ", 1.0, ("a", "b", "q"), {"q": "a ^ b"})
    (tmp_path / "l.lib").write_text(text(cells))
    (tmp_path / "bench.v").write_text(BENCH)
    write_models(tmp_path / "l.lib", tmp_path / "cells.v")
    files = [tmp_path / name for name in ("bench.v", "cells.v")]
    subprocess.run(["iverilog", "-g2012", "-o", tmp_path / "program", *files], check=True)
    printed = subprocess.run(["vvp", "-n", tmp_path / "program"], check=True, capture_output=True, text=True).stdout
    (begun, same), later = (line.split() for line in printed.splitlines())
    assert set(begun) == {"0", "1"} and set(same) == {"0"}
    assert later == [begun, same]
