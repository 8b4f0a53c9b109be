"""A small design, what its layout is made from, and what a layout of it needs."""

from talbot.flow.layout.steps.stage import scripts
from talbot.flow.layout.timing.constraints import sdc

NEEDS = "yosys", "klayout", "openroad", "layout"
VERILOG = """
module Counter(input clk, input reset, input [3:0] step, output reg [7:0] count, output high);
  assign high = count > 8'd99;
  always @(posedge clk) count <= reset ? 8'd0 : count + {4'd0, step};
endmodule
"""


def files(design, verilog, folder):
    """dict name -> Path, what a Runner of the Design ``design`` is given; its Verilog and constraints in ``folder``."""
    (folder / f"{design.top}.v").write_text(verilog)
    for name, propagated in (("sdc", True), ("place_and_route_sdc", False)):
        (folder / name).write_text(sdc(design, propagated))
    names = "sdc", "place_and_route_sdc"
    return {"rtl": folder / f"{design.top}.v", **{name: folder / name for name in names}, **scripts()}
