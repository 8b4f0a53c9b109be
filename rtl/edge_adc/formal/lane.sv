// The reference of a lane, exact in every cycle: the decisions of README.md with whatever the comparator answers
// (offset, noise), and the results that they give.
//
// dac: in a cycle in which `running` decides. found: `result`, {converted, code}, is decided in this cycle; ready: the
// number of results that `out` has not sent, and elder the first of them. its_...: the design's registers; holds: they
// agree with the reference, in every state that an induction starts from.

module Lane (
  input clk, input reset, input go, input unsigned_, input [6:0] threshold, input ternary, input comparator,
  input rdy,
  output reg running, output busy, output free, output startable, output window, output reg [3:0] number,
  output reg [7:0] bits, output [7:0] dac, output found, output [8:0] result, output reg [1:0] ready,
  output reg [8:0] elder,
  input [2:0] its_state, input [7:0] its_trial, input its_full, input [7:0] its_code, input its_converted, output holds
);
  localparam IDLE = 0, ABOVE = 1, BELOW = 2, OUTSIDE = 3, SEARCH = 4, WAIT = 5, WAIT_ZERO = 6;

  // Decision `number` is number + 1 cycles after go: v >= level(T) and v >= level(1 - T), then a bit each, MSB first;
  // the first two alone in ternary mode
  reg above;
  assign window = ternary || !unsigned_ && threshold != 0;
  wire [3:0] first = window ? 2 : 0;
  wire search = number >= first;
  wire [3:0] digit = number - first;
  assign dac = search ? bits | 8'h80 >> digit : number == 0 ? 8'd128 + threshold : 8'd129 - threshold;

  // The code is the answers of the search; inside the window it becomes zero
  function [8:0] coded(input [7:0] answers);
    reg signed [8:0] code, limit;
    begin
      code = {1'b0, answers} - (unsigned_ ? 9'd0 : 9'd128);
      limit = unsigned_ ? 0 : threshold;
      coded = {1'b1, -limit < code && code < limit ? 8'd0 : code[7:0]};
    end
  endfunction
  wire [7:0] answers = comparator ? dac : bits;
  wire last = running && search && digit == 7;
  wire zero = running && window && number == 1 && comparator && !above;
  wire sign = running && ternary && number == 1;
  assign found = last || zero || sign;
  assign result = sign ? (above ? 9'd1 : comparator ? 9'd0 : 9'h0FF) : zero ? 9'd0 : coded(answers);

  // One result is at `out`; one more conversion runs and waits for it
  reg [8:0] younger;
  wire taken = ready != 0 && rdy;
  assign busy = running || ready == 2;
  assign free = !busy || running && search && digit >= 6 && ready == 0;
  assign startable = !busy || last && ready == 0;
  always @(posedge clk) begin
    if (reset) begin
      running <= 0; ready <= 0;
    end else begin
      running <= go && startable || running && !found;
      ready <= ready + found - taken;
      if (ready == 0 || taken) elder <= ready == 2 ? younger : result;
      if (ready == 1) younger <= result;
    end
    if (number == 0) above <= comparator;
    number <= go && startable ? 0 : number + 1;
    bits <= go && startable ? 0 : search ? answers : bits;
  end

  wire [2:0] waits = younger == 0 ? WAIT_ZERO : ternary && younger == 1 ? OUTSIDE : WAIT;
  wire [2:0] state = ready == 2 ? waits : !running ? IDLE
                     : search ? SEARCH : number == 0 ? ABOVE : above ? OUTSIDE : BELOW;
  assign holds = its_state == state && its_full == (ready != 0) && (ready == 0 || elder == {its_converted, its_code})
                 && ready != 3 && !(running && ready == 2)
                 && (!running || !ternary || number < 2)
                 && (state != WAIT || younger == (ternary ? 9'h0FF : coded(its_trial))) && (state != WAIT_ZERO || younger == 0)
                 && (!running || its_trial == dac && (search ? digit <= 7 && !(bits & 8'hFF >> digit) : bits == 0));
endmodule
