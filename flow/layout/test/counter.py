"""A small design, what its layout is made from, and what a layout of it needs."""

from talbot.flow.layout.timing.constraints import sdc

NEEDS = "yosys", "klayout", "coriolis", "layout"
VERILOG = """
module Counter(input clk, input reset, input [3:0] step, output reg [7:0] count, output high);
  assign high = count > 8'd99;
  always @(posedge clk) count <= reset ? 8'd0 : count + {4'd0, step};
endmodule
"""


def files(design, verilog, folder):
    """dict name -> Path, what a Runner of the Design ``design`` is given; its Verilog and constraints in ``folder``."""
    (folder / f"{design.top}.v").write_text(verilog)
    (folder / f"{design.top}.sdc").write_text(sdc(design))
    return {"rtl": folder / f"{design.top}.v", "sdc": folder / f"{design.top}.sdc"}
