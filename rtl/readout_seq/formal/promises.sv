// Assumptions about ReadoutSeq's neighbours (docs/chip.md): the register file writes no configuration while the chip is
// busy (its proof of p_write). AmpCtrl uses amp_row only while ReadoutSeq is busy.

module ReadoutSeqPromises (
  input clk, input reset, input busy, input [1:0] mode, input [23:0] mask, input [7:0] row0, input [7:0] row1,
  input [7:0] col0, input [7:0] col1, input [1:0] decimation, input overlap, input [9:0] exposure, output promised, output amp_row_counts
);
  wire [70:0] now = {mode, mask, row0, row1, col0, col1, decimation, overlap, exposure};
  reg [70:0] before;
  reg kept = 1;
  assign promised = kept & (~busy | reset | now == before);
  assign amp_row_counts = busy;
  always @(posedge clk) begin
    kept <= promised; before <= now;
  end
endmodule
