// PhasePath with two lanes and the radix-4 divider: off, messages pass in order; on, the four taps of every sample
// become one request, and its response two messages, in order. The divider's proof shows that the response is right.
//
// `lane`, any lane, is tracked through the store.

module PhasePathProof (input clk, input reset, input [11:0] recv__msg, input recv__val, input send__rdy,
                       input [7:0] noise_floor);
  (* anyconst *) wire on;         // constant during a frame
  (* anyconst *) wire lane;
  wire recv__rdy, send__val;
  wire [11:0] send__msg;
  PhasePath dut (.*);
  localparam SAMPLE = 2;

  (* hierconn *) wire \dut.full ;
  (* hierconn *) wire [1:0] \dut.kind ;
  (* hierconn *) wire [9:0] \dut.data ;
  (* hierconn *) wire [1:0] \dut.tap ;
  (* hierconn *) wire [1:0] \dut.turn ;
  (* hierconn *) wire [5:0] \dut.in_flight ;
  (* hierconn *) wire \dut.second ;
  (* hierconn *) wire [8:0] \dut.store.entry0.value_x ;
  (* hierconn *) wire [7:0] \dut.store.entry0.value_y ;
  (* hierconn *) wire [8:0] \dut.store.entry1.value_x ;
  (* hierconn *) wire [7:0] \dut.store.entry1.value_y ;
  (* hierconn *) wire [17:0] \dut.divider.recv__msg ;
  (* hierconn *) wire \dut.divider.recv__val ;
  (* hierconn *) wire \dut.divider.recv__rdy ;
  (* hierconn *) wire [28:0] \dut.divider.send__msg ;
  (* hierconn *) wire \dut.divider.ctrl.running ;
  (* hierconn *) wire \dut.divider.ctrl.done ;
  (* hierconn *) wire [3:0] \dut.divider.dpath.count ;
  wire requests = \dut.divider.recv__val && \dut.divider.recv__rdy ;
  wire [7:0] phase = \dut.divider.send__msg [16:9], amp = \dut.divider.send__msg [7:0];
  wire amp_valid = \dut.divider.send__msg [8];

  // The position of the next message in its step: tap, number of the sample, samples a tap
  reg [1:0] tap, index, samples;
  wire [1:0] kind = recv__msg[11:10];
  wire last = recv__msg[9];
  wire taken = recv__val && recv__rdy;

  // The message inside, with its position, and the current request
  reg here = 0, requested = 0, phase_sent;
  reg [11:0] msg;
  reg [1:0] msg_tap, msg_index;
  wire tapped = on && msg[11:10] == SAMPLE;
  wire passes = here && !tapped;
  wire stores = here && tapped && msg_tap != 3;
  wire sent = send__val && send__rdy;
  wire leaves = stores || requests || sent && !requested;

  // The taps of the tracked lane
  reg [7:0] i0, i90, i180;
  reg first = 1, was_reset, was_val, was_rdy;
  reg [11:0] was_msg;
  reg [3:0] quiet;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= send__val; was_rdy <= send__rdy; was_msg <= send__msg;
    quiet <= reset || send__val || leaves || !(here || requested) ? 0 : quiet + !(&quiet);
    if (reset) begin
      here <= 0; requested <= 0; phase_sent <= 0; tap <= 0; index <= 0;
    end else begin
      if (taken) begin
        here <= 1; msg <= recv__msg; msg_tap <= tap; msg_index <= index;
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
      if (requests) begin
        requested <= 1; phase_sent <= 0;
      end else if (sent && requested) begin
        phase_sent <= 1;
        if (phase_sent) requested <= 0;
      end
    end
  end

  wire [11:0] answer = {2'd2, 2'b0, phase_sent ? (amp_valid ? amp : 8'd0) : phase};
  wire [11:0] passed = msg[11:10] == SAMPLE ? {msg[11:10], 2'b0, msg[7:0]} : msg;
  wire [8:0] x = {1'b0, i0} - {1'b0, i180}, y = {1'b0, msg[7:0]} - {1'b0, i90};
  wire [16:0] entry = lane ? {\dut.store.entry1.value_x , \dut.store.entry1.value_y }
                           : {\dut.store.entry0.value_x , \dut.store.entry0.value_y };
  wire [1:0] at_tap = here && tapped ? msg_tap : tap, at_index = here && tapped ? msg_index : index;
  wire [2:0] stored = at_tap + (at_index > lane);     // taps of the tracked lane
  wire [3:0] digits_left = requested ? (\dut.divider.ctrl.done ? 0 : 4 - \dut.divider.dpath.count ) : 0;

  always @* begin
    if (first) assume (reset);
    // A step is four taps of as many samples, at most one a lane; no other message is within it
    if (on && recv__val) begin
      assume (kind == SAMPLE || tap == 0 && index == 0);
      if (kind == SAMPLE) assume (tap == 0 ? index < 1 || last : last == (index == samples));
    end
    if (!first && !was_reset) begin
      p_request: assert (!requests || here && tapped && msg_tap == 3 && (msg_index != lane
              || \dut.divider.recv__msg == {x, y}));
      p_answer: assert (!(send__val && requested) || send__msg == answer);
      p_pass: assert (!(send__val && !requested) || passes && send__msg == passed);
      p_room: assert (!recv__rdy || !here || leaves);
      p_time: assert (quiet < 6);
      p_stable: assert (!was_val || was_rdy || send__val && send__msg == was_msg);
    end
    if (!first) begin
      inv_register: assert (\dut.full == here && (!here || {\dut.kind , \dut.data } == msg));
      inv_place: assert (!on || (here && tapped ? \dut.tap == msg_tap && \dut.turn == 2'd1 << msg_index && msg_index < 2
                                   && {tap, index} == (msg[9] ? {msg_tap + 2'd1, 2'd0} : {msg_tap, msg_index + 2'd1})
                                 : \dut.tap == tap && \dut.turn == 2'd1 << index));
      inv_samples: assert (!on || index < 2 && (tap == 0 || samples < 2 && index <= samples));
      inv_last: assert (!on || !(here && tapped) || (msg_tap == 0 ? msg_index == 0 || msg[9]
                                                     : samples < 2 && msg[9] == (msg_index == samples)));
      inv_marks: assert (!(on && here && !tapped) || tap == 0 && index == 0);
      inv_requested: assert (\dut.in_flight == requested
                             && requested == (\dut.divider.ctrl.running || \dut.divider.ctrl.done )
                             && !(\dut.divider.ctrl.running && \dut.divider.ctrl.done ) && (!requested || on)
                             && \dut.second == (requested && phase_sent));
      inv_phase_sent: assert (!(requested && phase_sent) || \dut.divider.ctrl.done );
      inv_count: assert (!\dut.divider.ctrl.running || \dut.divider.dpath.count < 4);
      inv_entry: assert (!on || stored == 0 || stored > 3 || at_tap != 0 && lane > samples
                         || (stored == 1 ? entry[16:8] == {1'b0, i0} : entry == {stored == 3 ? x : {1'b0, i0}, i90}));
      inv_quiet: assert (requested ? quiet + digits_left <= 5 : quiet <= 1);
    end
  end

  always @* if (!first && !was_reset) begin
    c_pass: cover (!on && sent && send__msg[11:10] == 3);
    c_phase: cover (on && sent && requested && phase_sent && send__msg[7:0] == 9);
    c_step: cover (on && requests && msg_index == 1 && lane);
  end
endmodule
