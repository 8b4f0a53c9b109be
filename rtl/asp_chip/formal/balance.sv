// Balance: the trim of the pixel type at (row, k), for every row and column of the tile, whatever the trims are.
//
// type_at comes from the golden tile (verif/formal/tables.py).

module BalanceProof (input clk, input reset, input [9:0] row, input [2:0] k, input [24 * 16 - 1:0] trims);
  wire [9:0] balance;
  Balance dut (.*);

  wire [4:0] position = row % `TILE_ROWS * `TILE_COLS + k;

  always @* begin
    p_trim: assert (k >= `TILE_COLS || balance == trims[16 * type_at(position) +: 10]);
    c_last: cover (row == 1023 && k == `TILE_COLS - 1 && balance == 10'h200);
  end
endmodule
