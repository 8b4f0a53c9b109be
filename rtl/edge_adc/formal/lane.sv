// The reference of a lane: the ideal comparator's decision for its DAC code, and the codes to be sent.
//
// `value` is at the lane's input: the sample-and-hold samples it with `go`. It is an integer in LSB, with values beyond
// the range of both codes to include clipping. The comparator is the one of docs/chip.md: high when value >=
// level(dac).

module Lane (
  input clk, input reset, input go, input unsigned_, input [6:0] threshold, input signed [9:0] value, input [7:0] dac,
  input val, input rdy, input [7:0] code, input converted, input [2:0] state, input free,
  output comparator, output reg [1:0] due, output [7:0] due_code, output due_converted, output holds
);
  localparam IDLE = 0, ABOVE = 1, BELOW = 2, OUTSIDE = 3, SEARCH = 4, WAIT = 5, WAIT_ZERO = 6;

  reg signed [9:0] held;
  wire signed [9:0] level = unsigned_ ? {2'b0, dac} : {2'b0, dac} - 10'sd128;
  assign comparator = held >= level;

  // The result of a value by the README: clipped, zero in the window, and whether it needs a search
  function [8:0] result(input signed [9:0] value);
    reg signed [9:0] clipped;
    begin
      if (unsigned_) clipped = value < 0 ? 10'sd0 : value > 255 ? 10'sd255 : value;
      else clipped = value < -128 ? -10'sd128 : value > 127 ? 10'sd127 : value;
      result[8] = unsigned_ || value >= $signed({3'b0, threshold}) || value <= -$signed({3'b0, threshold});
      result[7:0] = result[8] ? clipped[7:0] : 8'd0;
    end
  endfunction

  // At most two results are due: one at `out`, one that converts or waits; the older first
  reg [8:0] elder, younger;
  wire take = val && rdy;
  assign {due_converted, due_code} = elder;
  always @(posedge clk) begin
    if (go) held <= value;
    if (reset) due <= 0;
    else begin
      due <= due + go - take;
      if (take) elder <= due == 2 ? younger : result(value);
      else if (due == 0) elder <= result(value);
      if (take || due < 2) younger <= result(value);
    end
  end

  // The search: the code on trial and the bits that are still open bracket the clipped value
  wire [8:0] running = due == 2 ? younger : elder;
  wire [8:0] of_held = result(held);
  wire signed [9:0] clipped_held = unsigned_ ? (held < 0 ? 10'sd0 : held > 255 ? 10'sd255 : held)
                                   : (held < -128 ? 10'sd0 : held > 127 ? 10'sd255 : held + 10'sd128);
  wire [9:0] low = dac & (~dac + 8'd1);
  wire window = !unsigned_ && threshold != 0;
  assign holds = due == val + (state != IDLE) && (!val || elder == {converted, code})
                 && state != 7 && (state < WAIT || val)
                 && (state == IDLE || running == of_held)
                 && (state != ABOVE || window && dac == (threshold | 8'h80))
                 && (state != BELOW || window && dac == 8'd129 - threshold && held < $signed({3'b0, threshold}))
                 && (state != OUTSIDE || window && dac == 8'd129 - threshold && held >= $signed({3'b0, threshold}))
                 && (state != SEARCH || of_held[8] && dac != 0 && {1'b0, dac} <= clipped_held + low
                                        && clipped_held < {2'b0, dac} + low)
                 && (state != WAIT || of_held[8] && dac == clipped_held)
                 && (state != WAIT_ZERO || !of_held[8]);
endmodule
