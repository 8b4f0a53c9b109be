// Assumptions about PhasePath's neighbours: `on` is constant from reset on (the register file writes no mode while the
// chip is busy); a step is four taps of as many samples each, at most one a lane, and no other message is within it.

module PhasePathPromises #(parameter LANES = 8) (
  input clk, input reset, input on, input recv__val, input recv__rdy, input [11:0] recv__msg, output promised
);
  localparam SAMPLE = 2;
  wire sample = recv__msg[11:10] == SAMPLE, last = recv__msg[9];
  reg [1:0] tap;
  reg [2:0] index, samples;         // number of the next sample in its tap; of the last one in tap 0
  reg was_reset = 1, was_on, kept = 1;
  wire shape = sample ? (tap == 0 ? index < LANES - 1 || last : last == (index == samples)) : tap == 0 && index == 0;
  assign promised = kept & (was_reset | on == was_on) & (~(on & recv__val) | shape);
  always @(posedge clk) begin
    kept <= promised; was_reset <= reset; was_on <= on;
    if (reset) begin
      tap <= 0; index <= 0;
    end else if (on & recv__val & recv__rdy & sample) begin
      index <= last ? 0 : index + 1;
      if (last) tap <= tap + 1;
      if (last && tap == 0) samples <= index;
    end
  end
endmodule
