// EdgeAdc: every go gives one result, in order: the code of the value that was sampled with it.

module EdgeAdcProof (
  input clk, input reset, input go, input unsigned_, input [6:0] threshold, input signed [9:0] value, input out__rdy
);
  wire [7:0] dac, out__msg;
  wire free, busy, out__val, converted, comparator;
  EdgeAdc dut (.*);
  (* hierconn *) wire [2:0] \dut.state ;

  wire [1:0] due;
  wire [7:0] due_code;
  wire due_converted, holds;
  Lane lane (.clk(clk), .reset(reset), .go(go), .unsigned_(unsigned_), .threshold(threshold), .value(value), .dac(dac),
             .val(out__val), .rdy(out__rdy), .code(out__msg), .converted(converted), .state(\dut.state ), .free(free),
             .comparator(comparator), .due(due), .due_code(due_code), .due_converted(due_converted), .holds(holds));

  reg first = 1, was_reset, was_free, was_go, was_val, was_rdy, was_unsigned;
  reg [8:0] was_result;
  reg [6:0] was_threshold;
  reg [3:0] age;      // cycles after the last go in which its result could be sent
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_free <= free; was_go <= go; was_val <= out__val; was_rdy <= out__rdy;
    was_result <= {converted, out__msg}; was_unsigned <= unsigned_; was_threshold <= threshold;
    age <= reset || go ? 0 : age + !(&age);
  end

  wire window = !unsigned_ && threshold != 0;
  wire [3:0] digit = age - (window ? 2 : 0);     // of the search
  always @* begin
    if (first) assume (reset);
    else begin
      // The README's rules for go and for what is constant while busy
      assume (!go || was_reset || was_free && !was_go);
      assume (!(busy || due != 0) || unsigned_ == was_unsigned && threshold == was_threshold);
    end
    if (!first && !was_reset) begin
      p_value: assert (!out__val || {converted, out__msg} == {due_converted, due_code});
      p_made_up: assert (!out__val || due != 0);
      p_lost: assert (busy || out__val || due == 0);
      p_two: assert (due <= 2);
      p_time: assert (!(busy && age > 10) || out__val);
      p_stable: assert (!was_val || was_rdy || out__val && {converted, out__msg} == was_result);
    end
    if (!first) begin
      inv_lane: assert (holds && busy == (\dut.state != 0));
      inv_age: assert ((\dut.state != 1 || age == 0) && (\dut.state != 2 && \dut.state != 3 || age == 1)
                       && (\dut.state != 4 || dac & (8'h80 >> digit) && age <= (window ? 9 : 7)
                                               && !(dac & (8'h7F >> digit))));
    end
  end

  always @* if (!first && !was_reset) begin
    c_code: cover (out__val && out__msg == 8'hD3 && threshold == 5);
    c_zero: cover (out__val && !converted);
    c_two: cover (due == 2);
  end
endmodule
