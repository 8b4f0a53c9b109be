// PhasePath: off, messages pass in order; on, the four taps of every sample become one request, and its response two
// messages, in order. The divider's proof shows that the response is right. `on` and `noise_floor` change between
// frames, in any cycle in which nothing is inside.
//
// `lane`, any lane, is tracked through the store. Generated: `LANES, and of the store and of the divider in the design
// `ENTRIES (x and y of every entry), `DIVIDER (held: requests inside; left: cycles until the oldest is answered; sound:
// its state is a possible one), `CYCLES (the most that `left` can be).

module PhasePathProof (input clk, input reset, input [11:0] recv__msg, input recv__val, input send__rdy,
                       input on, input [7:0] noise_floor);
  (* anyconst *) wire [4:0] any_lane;
  wire [4:0] lane = any_lane & (`LANES - 1);    // a power of two
  wire recv__rdy, send__val;
  wire [11:0] send__msg;
  PhasePath dut (.*);
  localparam FRAME = 0, SAMPLE = 2, END = 3;

  (* hierconn *) wire \dut.full ;
  (* hierconn *) wire [1:0] \dut.kind ;
  (* hierconn *) wire [9:0] \dut.data ;
  (* hierconn *) wire [1:0] \dut.tap ;
  (* hierconn *) wire [`LANES - 1:0] \dut.turn ;
  (* hierconn *) wire [5:0] \dut.in_flight ;
  (* hierconn *) wire \dut.second ;
  (* hierconn *) wire [17:0] \dut.divider.recv__msg ;
  (* hierconn *) wire [7:0] \dut.divider.noise_floor ;
  (* hierconn *) wire \dut.divider.recv__val ;
  (* hierconn *) wire \dut.divider.recv__rdy ;
  (* hierconn *) wire [28:0] \dut.divider.send__msg ;
  `ENTRIES
  `DIVIDER
  wire requests = \dut.divider.recv__val && \dut.divider.recv__rdy ;
  wire [7:0] phase = \dut.divider.send__msg [16:9], amp = \dut.divider.send__msg [7:0];
  wire amp_valid = \dut.divider.send__msg [8];

  // The position of the next message in its frame: tap, number of the sample, samples a tap
  reg open = 0;       // FRAME is taken, END is not
  reg [1:0] tap;
  reg [5:0] index, samples;
  wire [1:0] kind = recv__msg[11:10];
  wire last = recv__msg[9];
  wire taken = recv__val && recv__rdy;

  // The message inside, with its position, and the requests whose amplitude is not sent
  reg here = 0, phase_sent;
  reg [4:0] requested = 0;
  reg [11:0] msg;
  reg [1:0] msg_tap;
  reg [5:0] msg_index;
  wire tapped = on && msg[11:10] == SAMPLE;
  wire passes = here && !tapped && requested == 0;
  wire stores = here && tapped && msg_tap != 3;
  wire sent = send__val && send__rdy;
  wire leaves = stores || requests || passes && sent;
  wire answered = sent && requested != 0;

  // The taps of the tracked lane
  reg [7:0] i0, i90, i180;
  reg first = 1, was_reset, was_val, was_rdy, was_on, was_off;
  reg [11:0] was_msg;
  reg [4:0] quiet;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= send__val; was_rdy <= send__rdy; was_msg <= send__msg;
    was_on <= on;
    quiet <= reset || send__val || leaves || !(here || requested != 0) ? 0 : quiet + !(&quiet);
    if (reset) begin
      open <= 0; here <= 0; requested <= 0; phase_sent <= 0; tap <= 0; index <= 0; was_off <= 0;
    end else begin
      if (taken) begin
        open <= kind != END; here <= 1; msg <= recv__msg; msg_tap <= tap; msg_index <= index;
        if (kind == SAMPLE && !on) was_off <= 1;
        if (on && kind == SAMPLE) begin
          index <= last ? 0 : index + 1;
          if (last) tap <= tap + 1;
          if (last && tap == 0) samples <= index;
        end
      end else if (leaves) here <= 0;
      if (stores && msg_index == lane) begin
        if (msg_tap == 0) i0 <= msg[7:0];
        if (msg_tap == 1) i90 <= msg[7:0];
        if (msg_tap == 2) i180 <= msg[7:0];
      end
      requested <= requested + requests - (answered && phase_sent);
      if (answered) phase_sent <= !phase_sent;
    end
  end

  wire [11:0] answer = {2'd2, 2'b0, phase_sent ? (amp_valid ? amp : 8'd0) : phase};
  wire [11:0] passed = msg[11:10] == SAMPLE ? {msg[11:10], 2'b0, msg[7:0]} : msg;
  wire [8:0] x = {1'b0, i0} - {1'b0, i180}, y = {1'b0, msg[7:0]} - {1'b0, i90};
  wire [16:0] entry = entries >> 17 * lane;
  wire [1:0] at_tap = here && tapped ? msg_tap : tap;
  wire [5:0] at_index = here && tapped ? msg_index : index;
  wire [2:0] stored = at_tap + (at_index > lane);     // taps of the tracked lane

  always @* begin
    if (first) a_reset: assume (reset);
    // A step is four taps of as many samples, at most one a lane; no other message is within it
    if (on && recv__val) begin
      a_mark: assume (kind == SAMPLE || tap == 0 && index == 0);
      if (kind == SAMPLE) a_taps: assume (tap == 0 ? index < `LANES - 1 || last : last == (index == samples));
    end
    if (!first && !was_reset && (open || here)) a_constant: assume (on == was_on);
    if (!first) begin
      p_request: assert (!requests || here && tapped && msg_tap == 3 && \dut.divider.noise_floor == noise_floor
                         && (msg_index != lane || \dut.divider.recv__msg == {x, y}));
      p_answer: assert (!(send__val && requested != 0) || send__msg == answer);
      p_pass: assert (!(send__val && requested == 0) || passes && send__msg == passed);
      p_room: assert (recv__rdy == (!here || leaves));
      p_time: assert (quiet <= `CYCLES + 1);
      p_stable: assert (was_reset || !was_val || was_rdy || send__val && send__msg == was_msg);
      inv_register: assert (\dut.full == here && (!here || {\dut.kind , \dut.data } == msg));
      inv_frame: assert (open || (here ? msg[11:10] == END : requested == 0));
      inv_place: assert (here && tapped ? \dut.tap == msg_tap && \dut.turn == 1 << msg_index && msg_index < `LANES
                           && {tap, index} == (msg[9] ? {msg_tap + 2'd1, 6'd0} : {msg_tap, msg_index + 6'd1})
                         : \dut.tap == tap && \dut.turn == 1 << index);
      inv_samples: assert (index < `LANES && (tap == 0 || samples < `LANES && index <= samples));
      inv_last: assert (!(here && tapped) || (msg_tap == 0 ? msg_index < `LANES - 1 || msg[9]
                                              : samples < `LANES && msg[9] == (msg_index == samples)));
      inv_marks: assert (on && open && !(here && !tapped) || tap == 0 && index == 0);
      inv_requested: assert (\dut.in_flight == requested && requested == held && (requested == 0 || on)
                             && \dut.second == (requested != 0 && phase_sent) && sound);
      inv_phase_sent: assert (requested != 0 ? !phase_sent || left == 0 : !phase_sent);
      inv_entry: assert (!on || stored == 0 || stored > 3 || at_tap != 0 && lane > samples
                         || (stored == 1 ? entry[16:8] == {1'b0, i0} : entry == {stored == 3 ? x : {1'b0, i0}, i90}));
      inv_quiet: assert (requested != 0 ? quiet + left <= `CYCLES + 1 : quiet <= 1);
    end
  end

  always @* if (!first && !was_reset) begin
    c_pass: cover (!on && sent && send__msg[11:10] == END);
    c_phase: cover (on && sent && requested != 0 && phase_sent && send__msg[7:0] == 9);
    c_step: cover (on && requests && samples == `LANES - 1 && msg_index == lane && lane == (`LANES > 1));
    c_after_off: cover (on && requests && was_off);
    c_floor: cover (on && requests && noise_floor == 201);
  end
endmodule
