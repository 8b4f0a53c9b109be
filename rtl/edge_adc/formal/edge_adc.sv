// EdgeAdc in every cycle, for any `go`, `rdy` and answers of the comparator: the reference of lane.sv. And with an
// ideal comparator the code is the sampled value's, as docs/chip.md has it.

module EdgeAdcProof (
  input clk, input reset, input go, input unsigned_, input [6:0] threshold, input ternary, input comparator,
  input signed [9:0] value, input out__rdy
);
  wire [7:0] dac, out__msg;
  wire free, busy, out__val, converted;
  EdgeAdc dut (.*);
  (* hierconn *) wire [2:0] \dut.state ;

  wire running, expected_busy, expected_free, startable, window, found, holds;
  wire [3:0] number;
  wire [7:0] bits, expected_dac;
  wire [8:0] result, elder;
  wire [1:0] ready;
  Lane lane (.clk(clk), .reset(reset), .go(go), .unsigned_(unsigned_), .threshold(threshold), .ternary(ternary), .comparator(comparator),
             .rdy(out__rdy), .running(running), .busy(expected_busy), .free(expected_free), .startable(startable),
             .window(window), .number(number), .bits(bits), .dac(expected_dac), .found(found), .result(result),
             .ready(ready), .elder(elder), .its_state(\dut.state ), .its_trial(dac), .its_full(out__val),
             .its_code(out__msg), .its_converted(converted), .holds(holds));

  // `value` is at the sample-and-hold, an integer in LSB, beyond the range of both codes to include clipping
  reg signed [9:0] held;
  reg was_ideal;
  wire plain = unsigned_ && !ternary;
  wire signed [9:0] bottom = plain ? 10'sd0 : -10'sd128, top = bottom + 10'sd255, limit = {3'b0, threshold};
  wire signed [9:0] level = $signed({2'b0, dac}) + bottom;
  wire ideal = was_ideal && (!running || comparator == (held >= level));
  wire signed [9:0] clipped = held < bottom ? bottom : held > top ? top : held;
  wire small = !plain && held > -limit && held < limit;
  wire [8:0] sign = held >= limit ? 9'd1 : held <= -limit ? 9'h0FF : 9'd0;
  wire signed [9:0] least = $signed({2'b0, bits}) + bottom;      // of the values with these answers
  wire [3:0] digit = number - (window ? 2 : 0);

  reg first = 1, was_reset, was_free, was_go, was_val, was_rdy, was_unsigned, was_ternary;
  reg [8:0] was_result;
  reg [6:0] was_threshold;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_free <= free; was_go <= go; was_val <= out__val; was_rdy <= out__rdy;
    was_result <= {converted, out__msg}; was_unsigned <= unsigned_; was_threshold <= threshold;
    was_ternary <= ternary; was_ideal <= go && startable || ideal;
    if (go && startable) held <= value;
  end

  wire signed [8:0] code = $signed(out__msg), past_limit = {2'b0, was_threshold};
  always @* begin
    if (first) a_reset: assume (reset);
    else begin
      a_config: assume (!busy || unsigned_ == was_unsigned && threshold == was_threshold
                       && ternary == was_ternary);
      p_reset: assert (!was_reset || {dac, out__val, converted, busy, free} == 1);
      // The decisions, one a cycle, and the time of every result
      p_dac: assert (!running || dac == expected_dac);
      p_val: assert (out__val == (ready != 0));
      p_result: assert (!out__val || {converted, out__msg} == elder);
      p_busy: assert (busy == expected_busy);
      p_free: assert (free == expected_free);
      p_invited: assert (!(was_free && !was_go) || startable);
      p_stable: assert (was_reset || !was_val || was_rdy || out__val && {converted, out__msg} == was_result);
      // Every code of edge mode is 0 or at least T; ternary mode has three, and converts nothing
      p_window: assert (!out__val || was_val && !was_rdy || was_unsigned || was_ternary || code == 0
                        || code >= past_limit || code <= -past_limit);
      p_signs: assert (!out__val || was_val && !was_rdy || !was_ternary || !converted && code <= 1 && code >= -1);
      p_ideal: assert (!(found && ideal) || result == (ternary ? sign : small ? 9'd0 : {1'b1, clipped[7:0]}));
      inv_lane: assert (holds);
      inv_search: assert (!(running && was_ideal) || number < (window ? 2 : 0)
                          || !small && least <= clipped && clipped < least + (10'sd256 >> digit));
    end
  end

  always @* if (!first && !was_reset) begin
    c_code: cover (out__val && out__msg == 8'hD3 && threshold == 5);
    c_zero: cover (out__val && !converted);
    c_inside: cover (out__val && converted && out__msg == 0 && threshold == 5);
    c_ideal: cover (found && ideal && held == -10'sd200);
    c_two: cover (ready == 2);
    c_sign: cover (found && ideal && ternary && result == 9'h0FF);
    c_sign_waits: cover (ready == 2 && ternary && out__rdy && elder == 1);
  end
endmodule
