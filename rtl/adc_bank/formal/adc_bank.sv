// AdcBank with two lanes: every step's messages are sent in order, each once, with the codes of the values that its
// lanes sampled, for any `rdy` and any values. A lane is tracked as in rtl/edge_adc/formal/lane.sv; steps that wait are
// in a queue of two, with the lanes whose results are not sent.

module AdcBankProof (
  input clk, input reset, input [26:0] step__msg, input step__val, input scan__rdy, input [1:0] mode,
  input [6:0] threshold, input signed [9:0] value0, input signed [9:0] value1
);
  wire [15:0] dac;
  wire hold, unsigned_, idle, step__rdy, scan__val;
  wire [9:0] row; wire [7:0] group; wire [2:0] k; wire [1:0] sub, en, comparator;
  wire [31:0] made, left_out;
  wire [11:0] scan__msg;
  AdcBank dut (.*);
  localparam FRAME = 0, SAMPLE = 2, END = 3, SEARCH = 4;

  (* hierconn *) wire \dut.at_pins ;
  (* hierconn *) wire [1:0] \dut.pins_kind ;
  (* hierconn *) wire \dut.mark ;
  (* hierconn *) wire [1:0] \dut.mark_kind ;
  (* hierconn *) wire [9:0] \dut.mark_row ;
  (* hierconn *) wire [1:0] \dut.remaining ;
  (* hierconn *) wire [1:0] \dut.taken ;
  (* hierconn *) wire [2:0] \dut.lane0.state ;
  (* hierconn *) wire [2:0] \dut.lane1.state ;
  (* hierconn *) wire \dut.lane0.full ;
  (* hierconn *) wire \dut.lane1.full ;
  (* hierconn *) wire [7:0] \dut.lane0.code ;
  (* hierconn *) wire [7:0] \dut.lane1.code ;
  (* hierconn *) wire \dut.lane0.search_made ;
  (* hierconn *) wire \dut.lane1.search_made ;
  wire at_pins = \dut.at_pins , mark = \dut.mark ;
  wire [1:0] pins_kind = \dut.pins_kind , remaining = \dut.remaining , taken = \dut.taken ;
  wire [2:0] state0 = \dut.lane0.state , state1 = \dut.lane1.state ;
  wire full0 = \dut.lane0.full , full1 = \dut.lane1.full ;

  wire [1:0] due0, due1;
  wire [8:0] result0, result1;    // converted, code
  wire holds0, holds1;
  Lane lane0 (.clk(clk), .reset(reset), .go(hold
          && en[0]), .unsigned_(mode != 0), .threshold(threshold), .value(value0),
              .dac(dac[7:0]), .val(full0), .rdy(taken[0]), .code(\dut.lane0.code ), .converted(\dut.lane0.search_made ),
              .state(state0), .comparator(comparator[0]), .due(due0), .due_code(result0[7:0]),
              .due_converted(result0[8]), .holds(holds0));
  Lane lane1 (.clk(clk), .reset(reset), .go(hold
          && en[1]), .unsigned_(mode != 0), .threshold(threshold), .value(value1),
              .dac(dac[15:8]), .val(full1), .rdy(taken[1]), .code(\dut.lane1.code ),
                      .converted(\dut.lane1.search_made ),
              .state(state1), .comparator(comparator[1]), .due(due1), .due_code(result1[7:0]),
              .due_converted(result1[8]), .holds(holds1));

  // Steps inside: kind, row, lanes whose results are due; a step without lanes sends nothing and is not kept
  reg [1:0] inside = 0;
  reg [13:0] front, behind;
  wire [1:0] front_kind = front[13:12], front_lanes = front[1:0];
  wire [9:0] front_row = front[11:2];
  wire [1:0] turn = front_lanes & (~front_lanes + 1);
  wire is_sample = front_kind == SAMPLE, only = front_lanes == turn;
  wire [8:0] result = turn[0] ? result0 : result1;
  wire [11:0] due = is_sample ? {2'd2, only, 1'b0, result[7:0]} : {front_kind, front_row};
  wire take = step__val && step__rdy, sent = scan__val && scan__rdy;
  wire [13:0] step = {step__msg[26:15], step__msg[1:0]};
  wire enters = take && !(step[13:12] == SAMPLE && step[1:0] == 0);
  wire leaves = sent && (!is_sample || only);

  reg first = 1, was_reset, was_val, was_rdy, was_take, was_sample, was_here;
  reg [11:0] was_msg;
  reg [24:0] was_pins;
  reg [1:0] was_mode, quiet;
  reg [6:0] was_threshold;
  reg [31:0] conversions, zeros;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= scan__val; was_rdy <= scan__rdy; was_msg <= scan__msg;
    was_take <= take; was_sample <= take && step__msg[26:25] == SAMPLE;
    was_pins <= take ? step__msg[24:0] : {row, group, k, sub, en};
    was_mode <= mode; was_threshold <= threshold; was_here <= inside != 0 || hold || at_pins;
    quiet <= reset || !idle || scan__val || inside == 0 ? 0 : quiet + !(&quiet);
    if (reset) begin
      inside <= 0; conversions <= 0; zeros <= 0;
    end else begin
      inside <= inside + enters - leaves;
      if (inside - leaves == 0) front <= step;
      else if (leaves) front <= behind;
      else if (sent) front[1:0] <= front_lanes & ~turn;
      if (enters) behind <= step;
      if (sent && front_kind == FRAME) begin
        conversions <= 0; zeros <= 0;
      end else if (sent && is_sample) begin
        conversions <= conversions + result[8];
        zeros <= zeros + !result[8];
      end
    end
  end

  wire drains = mark || remaining != 0;
  wire waits = at_pins && !(pins_kind == SAMPLE && en == 0);
  wire [13:0] pins = {pins_kind, row, en};
  wire [13:0] waiting = drains ? behind : front;
  wire [1:0] on_pins = at_pins && pins_kind == SAMPLE && !hold ? en : 2'b0;

  always @* begin
    if (first) assume (reset);
    else assume (!(was_here || was_take) || mode == was_mode && threshold == was_threshold);
    if (!first && !was_reset) begin
      p_message: assert (!scan__val || inside != 0 && scan__msg == due);
      p_time: assert (quiet < 2);
      p_room: assert (inside <= 2 && !(step__rdy && inside == 2));
      p_hold: assert (hold == was_sample);
      p_pins: assert ({row, group, k, sub, en} == was_pins);
      p_idle: assert (!idle || due0 == full0 && due1 == full1);
      p_counts: assert (made == conversions && left_out == zeros);
      p_stable: assert (!was_val || was_rdy || scan__val && scan__msg == was_msg);
    end
    if (!first) begin
      inv_lanes: assert (holds0 && holds1);
      inv_due: assert (due0 == remaining[0] + on_pins[0] && due1 == remaining[1] + on_pins[1]);
      inv_inside: assert (inside == drains + waits && !(mark && remaining != 0));
      inv_front: assert (!drains || (mark ? {\dut.mark_kind , \dut.mark_row } == {front_kind, front_row} && !is_sample
                                     : is_sample && front_lanes == remaining));
      inv_waiting: assert (!waits || waiting[13:12] == pins_kind && waiting[11:2] == row
                           && (pins_kind != SAMPLE || waiting[1:0] == en));
      inv_hold: assert (!hold || at_pins && pins_kind == SAMPLE && !(state0 != 0 && !(state0 == SEARCH && dac[0]
              && !full0))
                                 && !(state1 != 0 && !(state1 == SEARCH && dac[8] && !full1)));
      inv_quiet: assert (quiet == 0 || !(idle && !scan__val && inside != 0) || drains || quiet < 1);
    end
  end

  always @* if (!first && !was_reset) begin
    c_both: cover (inside == 2 && scan__val && front_lanes == 3 && !was_rdy);
    c_end: cover (sent && front_kind == END && made == 1);
  end
endmodule
