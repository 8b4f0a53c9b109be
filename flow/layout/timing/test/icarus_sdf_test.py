"""What Icarus does with an SDF: why delays.py writes another one than OpenSTA's."""

import pytest

from talbot.base.tools import finish, run

pytestmark = pytest.mark.needs("iverilog")
VERILOG = """`timescale 1ns/1ps
module inv (i, nq); input i; output nq; assign nq = ~i; specify (i => nq) = (0, 0); endspecify endmodule
module top (a, y); input a; output y; wire w; inv x0 (.i(a), .nq(w)); inv x1 (.i(w), .nq(y)); endmodule
module Bench;
  reg a = 0;
  wire y;
  top dut (a, y);
  initial begin
    $sdf_annotate("FILE", dut);
    #10 a = 1;
  end
  always @(y) if ($realtime >= 10) $display("AT %.3f", $realtime - 10);
endmodule
"""
CELLS = "".join(
    f'(CELL (CELLTYPE "inv") (INSTANCE {name}) (DELAY (ABSOLUTE (IOPATH i nq {{0}} {{0}}))))' for name in ("x0", "x1")
)
WIRE = '(CELL (CELLTYPE "top") (INSTANCE) (DELAY (ABSOLUTE (INTERCONNECT x0/nq x1/i {0} {0}))))'


def simulated(folder, cells):
    """(ns from input to output through both cells, whether Icarus complained)."""
    (folder / "a.sdf").write_text(f'(DELAYFILE (SDFVERSION "3.0") (TIMESCALE 1ns) {cells})')
    (folder / "a.v").write_text(VERILOG.replace("FILE", str(folder / "a.sdf")))
    run(["iverilog", "-g2012", "-gspecify", "-s", "Bench", "-o", folder / "a.vvp", folder / "a.v"])
    done = finish(["vvp", "-n", folder / "a.vvp"])
    said = done.stdout + done.stderr
    return float(done.stdout.partition("AT ")[2].split()[0]), "SDF ERROR" in said or "error" in said.lower()


def test_whole_triples_are_annotated(tmp_path):
    assert simulated(tmp_path, CELLS.format("(0.3:0.3:0.3)")) == (0.6, False)


def test_a_triple_without_a_typical_value_is_no_delay_without_a_word(tmp_path):
    assert simulated(tmp_path, CELLS.format("(0.3::0.3)")) == (0.0, False)


def test_the_delay_of_a_wire_is_refused(tmp_path):
    delay, complained = simulated(tmp_path, WIRE.format("(0.5:0.5:0.5)") + CELLS.format("(0.3:0.3:0.3)"))
    assert complained and delay < 0.6 + 0.5
