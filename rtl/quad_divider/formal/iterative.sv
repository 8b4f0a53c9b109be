// An iterative divider (`DUT, `DIGITS digits): every request gets one response, its own, and it is the specified one.
//
// `request` and `floor` are any request, fixed: the proof for it holds for all. The invariant is that the
// state equals that of the long division of its operands after as many bits.

module IterativeProof (
  input clk, input reset, input [17:0] recv__msg, input recv__val, input send__rdy, input [7:0] noise_floor
);
  wire recv__rdy, send__val;
  wire [28:0] send__msg;
  `DUT dut (.*);

  (* hierconn *) wire [3:0] \dut.dpath.count ;
  (* hierconn *) wire [29:0] \dut.dpath.state ;
  (* hierconn *) wire \dut.ctrl.running ;
  (* hierconn *) wire \dut.ctrl.done ;

  (* anyconst *) wire [17:0] request;
  (* anyconst *) wire [7:0] floor;

  // A request is in progress, it is the fixed one, and for how many cycles
  reg pending = 0, mine;
  reg [4:0] age;
  reg first = 1, was_reset, was_val, was_rdy;
  reg [28:0] was_msg;
  wire taken = recv__val && recv__rdy, left = send__val && send__rdy;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= send__val; was_rdy <= send__rdy; was_msg <= send__msg;
    if (reset) pending <= 0;
    else if (taken) begin
      pending <= 1; mine <= recv__msg == request && noise_floor == floor; age <= 1;
    end else if (left) pending <= 0;
    else age <= age + !(&age);
  end

  wire octant_ok, flags_ok, phase_ok;
  wire [2:0] octant_spec;
  wire [7:0] send_ratio;
  wire [8:0] larger, smaller;
  QuadSpec spec (.x(request[17:9]), .y(request[8:0]), .noise_floor(floor), .msg(send__msg), .octant_ok(octant_ok),
                 .ratio(send_ratio), .flags_ok(flags_ok), .phase_ok(phase_ok), .octant_spec(octant_spec),
                 .larger(larger), .smaller(smaller));

  wire [2:0] octant; wire amp_valid; wire [8:0] divisor, rest; wire [7:0] quotient;
  assign {octant, amp_valid, divisor, rest, quotient} = \dut.dpath.state ;
  wire [3:0] bits_made = \dut.ctrl.done ? 8 : 8 / `DIGITS * \dut.dpath.count ;
  // A constant too, so that no induction step has to find again that the long division is unchanged
  (* anyconst *) wire [152:0] by_hand;
  wire [152:0] states;
  LongDivision long_division (.larger(larger), .smaller(smaller), .states(states));
  wire [7:0] ratio = by_hand[143:136];
  wire origin = request == 0;

  always @* begin
    if (first) a_reset: assume (reset);
    a_by_hand: assume (by_hand == states);
    if (!first) begin
      p_octant: assert (!(send__val && mine) || octant_ok);
      p_ratio: assert (!(send__val && mine) || send_ratio == (origin ? 8'd0 : ratio));
      p_flags: assert (!(send__val && mine) || flags_ok);
      p_phase: assert (!(send__val && mine) || phase_ok);
      // No response without a request, none lost, and no second request is taken before the first response
      p_one: assert (!send__val || pending);
      p_room: assert (recv__rdy == !pending);
      p_latency: assert (!pending || send__val == (age >= `DIGITS + 1));
      p_stable: assert (was_reset || !was_val || was_rdy || send__val && send__msg == was_msg);
      inv_count: assert (!\dut.ctrl.running || \dut.dpath.count < `DIGITS && age == \dut.dpath.count + 1);
      inv_operands: assert (!(pending && mine) || octant == octant_spec && divisor == larger
                            && amp_valid == (larger != 0 && larger >= {1'b0, floor}));
      inv_division: assert (!(pending && mine) || {rest, quotient} == by_hand[17 * bits_made +: 17]);
      inv_state: assert (pending == (\dut.ctrl.running || \dut.ctrl.done ) && !(\dut.ctrl.running && \dut.ctrl.done ));
    end
  end

  always @* if (!first && !was_reset) begin
    c_answer: cover (send__val && mine && request == {9'd3, 9'h1FE});
    c_waits: cover (send__val && was_val && !was_rdy);
  end
endmodule
