// AdcBank with any number of lanes: every step's messages leave once, in order, lane by lane; for any `rdy`, any
// answers of every lane's comparator and any reset. Steps are kept in a queue of two with the lanes whose results are
// not sent. One lane, any, is compared with the reference of rtl/edge_adc/formal/lane.sv; since it may be every one,
// nothing is assumed of the others.

module AdcBankProof (
  input clk, input reset, input [`LANES + 24:0] step__msg, input step__val, input scan__rdy, input [2:0] mode,
  input [6:0] threshold, input [`LANES - 1:0] comparator
);
  localparam FRAME = 0, SAMPLE = 2, END = 3;
  wire [8 * `LANES - 1:0] dac;
  wire hold, wake, unsigned_, idle, step__rdy, scan__val;
  wire [9:0] row; wire [7:0] group; wire [2:0] k; wire [1:0] sub;
  wire [`LANES - 1:0] en;
  wire [31:0] made, left_out;
  wire [11:0] scan__msg;
  AdcBank dut (.*);
  (* hierconn *) wire \dut.at_pins ;
  (* hierconn *) wire [1:0] \dut.pins_kind ;
  (* hierconn *) wire \dut.mark ;
  (* hierconn *) wire [1:0] \dut.mark_kind ;
  (* hierconn *) wire [9:0] \dut.mark_row ;
  (* hierconn *) wire [`LANES - 1:0] \dut.remaining ;
  (* hierconn *) wire [`LANES - 1:0] \dut.taken ;
  (* hierconn *) wire [`LANES - 1:0] \dut.busy ;
  (* hierconn *) wire [`LANES - 1:0] \dut.free ;
  (* hierconn *) wire [9:0] \dut.result ;
  (* hierconn *) wire \dut.ternary ;
  wire ternary = \dut.ternary ;
  `LANE_REGISTERS
  wire at_pins = \dut.at_pins , mark = \dut.mark , convertible = &\dut.free ;
  wire [1:0] pins_kind = \dut.pins_kind ;
  wire [`LANES - 1:0] remaining = \dut.remaining , lanes_busy = \dut.busy ;

  // The tracked lane
  (* anyconst *) wire [4:0] any;
  wire [4:0] at = any & (`LANES - 1);
  wire [`LANES - 1:0] tracked = 1 << at;
  wire enabled = |(en & tracked), go = hold && enabled;
  wire running, busy, free, startable, found, holds;
  wire [7:0] lane_dac = dac >> 8 * at, expected_dac;
  wire [8:0] result, elder;
  wire [1:0] ready;
  Lane lane (.clk(clk), .reset(reset), .go(go), .unsigned_(mode[1:0] != 0), .threshold(threshold),
             .ternary(mode == 4), .comparator(|(comparator & tracked)), .rdy(|(\dut.taken & tracked)), .running(running), .busy(busy),
             .free(free), .startable(startable), .dac(expected_dac), .found(found), .result(result), .ready(ready),
             .elder(elder), .its_state(states >> 3 * at), .its_trial(lane_dac), .its_full(fulls >> at),
             .its_code(codes >> 8 * at), .its_converted(converted >> at), .holds(holds));

  // Steps inside: kind, row, lanes whose results are not sent; a step without lanes sends nothing and is not kept
  reg [1:0] inside = 0;
  reg [`LANES + 11:0] front, behind;
  wire [1:0] front_kind = front[`LANES + 11 -: 2];
  wire [9:0] front_row = front[`LANES + 9 -: 10];
  wire [`LANES - 1:0] front_lanes = front[`LANES - 1:0], turn = front_lanes & (~front_lanes + 1);
  wire is_sample = front_kind == SAMPLE, last = front_lanes == turn, mine = is_sample && turn == tracked;
  wire take = step__val && step__rdy, sent = scan__val && scan__rdy;
  wire [`LANES + 11:0] step = {step__msg[`LANES + 24 -: 12], step__msg[`LANES - 1:0]};
  wire samples = step__msg[`LANES + 24 -: 2] == SAMPLE;
  wire enters = take && !(samples && step__msg[`LANES - 1:0] == 0);
  wire leaves = sent && (!is_sample || last);

  reg first = 1, was_reset, was_val, was_rdy, was_sample, was_inside, was_blocked, was_unsigned, was_ternary;
  reg [11:0] was_msg;
  reg [`LANES + 22:0] was_pins;
  reg [2:0] was_mode;
  reg [1:0] quiet;
  reg [6:0] was_threshold;
  reg [31:0] conversions, zeros;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= scan__val; was_rdy <= scan__rdy; was_msg <= scan__msg;
    was_sample <= take && samples && !reset; was_blocked <= !reset && (take || at_pins && leaving && !leaves);
    was_pins <= reset ? 0 : take ? step__msg[`LANES + 22:0] : {row, group, k, sub, en};
    was_mode <= mode; was_ternary <= ternary; was_unsigned <= unsigned_; was_threshold <= threshold; was_inside <= inside != 0 || take;
    quiet <= reset || busy || hold || scan__val || inside == 0 || is_sample && !mine ? 0 : quiet + !(&quiet);
    if (reset) begin
      inside <= 0; conversions <= 0; zeros <= 0;
    end else begin
      inside <= inside + enters - leaves;
      if (inside - leaves == 0) front <= step;
      else if (leaves) front <= behind;
      else if (sent) front[`LANES - 1:0] <= front_lanes & ~turn;
      if (enters) behind <= step;
      if (sent && front_kind == FRAME) begin
        conversions <= 0; zeros <= 0;
      end else if (sent && is_sample) begin
        conversions <= conversions + \dut.result [8];
        zeros <= zeros + !\dut.result [8];
      end
    end
  end

  wire leaving = mark || remaining != 0;
  wire waits = at_pins && !(pins_kind == SAMPLE && en == 0);
  wire [`LANES + 11:0] waiting = leaving ? behind : front;

  always @* begin
    if (first) a_reset: assume (reset);
    else begin
      a_config: assume (!was_inside || mode == was_mode && threshold == was_threshold);
      p_reset: assert (!was_reset || {scan__val, hold, en, row, group, k, sub, made, left_out} == 0
                                     && dac == 0 && step__rdy && idle);
      // A lane's configuration is constant while it converts
      p_config: assert (!busy || unsigned_ == was_unsigned && threshold == was_threshold && ternary == was_ternary);
      // The step at the pins
      p_hold: assert (hold == was_sample);
      p_wake: assert (wake == (take && samples));
      p_pins: assert ({row, group, k, sub, en} == was_pins && unsigned_ == (mode[1:0] != 0));
      p_start: assert (!go || startable);
      p_dac: assert (!running || lane_dac == expected_dac);
      p_idle: assert (idle == !(hold || lanes_busy != 0) && busy == |(lanes_busy & tracked));
      p_room: assert (step__rdy == (!hold && !at_pins && convertible) && (free || !convertible) && inside <= 2
                      && !(step__rdy && inside == 2));
      // A step leaves the pins when the one before has left
      p_moves: assert (at_pins == was_blocked);
      // Messages: marks, and in its turn the tracked lane's result
      p_message: assert (!scan__val || inside != 0
                         && scan__msg[11:8] == (is_sample ? {2'd2, last, 1'b0} : {front_kind, front_row[9:8]})
                         && (is_sample ? !mine || {\dut.result [8], scan__msg[7:0]} == elder
                             : scan__msg[7:0] == front_row[7:0]));
      p_turn: assert (!(leaving && mine) || scan__val == (ready != 0));
      p_stable: assert (was_reset || !was_val || was_rdy || scan__val && scan__msg == was_msg);
      p_time: assert (quiet < 2);
      p_counts: assert (made == conversions && left_out == zeros);
      inv_lane: assert (holds);
      inv_ready: assert (ready + running + go == |(remaining & tracked) + (at_pins && pins_kind == SAMPLE && enabled));
      inv_inside: assert (inside == leaving + waits && !(mark && remaining != 0));
      inv_front: assert (!leaving || (mark ? {\dut.mark_kind , \dut.mark_row } == {front_kind, front_row} && !is_sample
                                      : is_sample && front_lanes == remaining));
      inv_waiting: assert (!waits || waiting[`LANES + 11:`LANES] == {pins_kind, row}
                           && (pins_kind != SAMPLE || waiting[`LANES - 1:0] == en));
      inv_hold: assert (!hold || at_pins && pins_kind == SAMPLE && (!enabled || startable));
      inv_quiet: assert (quiet == 0 || leaving || quiet < 1);
    end
  end

  always @* if (!first && !was_reset) begin
    c_mine: cover (inside == 2 && sent && mine && enabled && `LANES - 1 == at);
    c_all: cover (scan__val && &front_lanes && !was_rdy);
    c_converted: cover (found && result[8] && `LANES - 1 == at);
    c_sign: cover (sent && mine && scan__msg[7:0] == 8'hFF && ternary);
    c_left_out: cover (sent && front_kind == END && left_out == 2);
  end
endmodule
