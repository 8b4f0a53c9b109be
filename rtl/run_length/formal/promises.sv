// Assumptions about RunLength's neighbours: the configuration is constant from FRAME until frame_sync falls, the counts
// from END (README.md). Any message may arrive at any time.

module RunLengthPromises (
  input clk, input reset, input recv__val, input recv__rdy, input [11:0] recv__msg, input frame_sync, input [2:0] mode,
  input phase, input [7:0] row0, input [7:0] row1, input [7:0] col0, input [7:0] col1, input [1:0] decimation,
  input [23:0] mask, input [6:0] threshold, input [15:0] frame_number, input [1:0] resync, input [9:0] exposure,
  input [7:0] n_cm, input [15:0] t_int, input [7:0] calibration, input [31:0] made, input [31:0] left_out,
  output promised
);
  localparam FRAME = 0, END = 3;
  wire [128:0] now = {mode, phase, row0, row1, col0, col1, decimation, mask, threshold, frame_number, resync, exposure,
                      n_cm, t_int, calibration};
  wire [63:0] counts = {made, left_out};
  reg [128:0] before;
  reg [63:0] counts_before;
  reg inside = 0, ending = 0, was_sync, kept = 1;
  wire taken = recv__val & recv__rdy;
  wire starts = taken & ~inside & recv__msg[11:10] == FRAME, ends = taken & inside & recv__msg[11:10] == END;
  assign promised = kept & (reset | ~inside | now == before) & (reset | ~ending | counts == counts_before);
  always @(posedge clk) begin
    kept <= promised; before <= now; counts_before <= counts; was_sync <= frame_sync;
    inside <= ~reset & (starts | inside & ~(was_sync & ~frame_sync));
    ending <= ~reset & (ends | ending & ~(was_sync & ~frame_sync));
  end
endmodule
