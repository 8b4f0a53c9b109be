"""Hold where every input goes straight into a register: more buffers than there are cells."""

import pytest

from talbot.base.steps import Runner
from talbot.flow.layout.chain import stages, synthesis_steps
from talbot.flow.layout.design import Design
from talbot.flow.layout.options import Options
from talbot.flow.layout.test import counter
from talbot.flow.layout.variables import Floor

pytestmark = [pytest.mark.slow, pytest.mark.needs(*counter.NEEDS)]

VERILOG = """
module Registers(input clk, input [199:0] d, output reg [199:0] q);
  always @(posedge clk) q <= d;
endmodule
"""


def test_the_clock_tree_ends_with_every_hold_repaired(tmp_path):
    design, options = Design("registers", "Registers", ""), Options()
    runner = Runner(tmp_path / "steps", counter.files(design, VERILOG, tmp_path))
    for step in synthesis_steps(design, options):
        runner.run(step)
    ended = {step.name: runner.run(step)["metrics"] for step in stages(design, options, Floor(0.3, 1.0))[:4]}
    assert list(ended)[-1] == "cts" and not any(metrics["stopped"] for metrics in ended.values())
