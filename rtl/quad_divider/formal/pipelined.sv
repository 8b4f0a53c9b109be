// The pipelined divider: requests move from stage to stage only together, so responses are sent in order; each is the
// specified one. `request` and `floor` are any request, fixed; `mine` marks the stage that holds one of them,
// chosen at random by `watch`.

module PipelinedProof (
  input clk, input reset, input [17:0] recv__msg, input recv__val, input send__rdy, input [7:0] noise_floor,
  input watch
);
  wire recv__rdy, send__val;
  wire [28:0] send__msg;
  QuadDividerPipelined dut (.*);

  (* hierconn *) wire [29:0] \dut.stage0.out_state ;
  (* hierconn *) wire \dut.stage0.out_val ;
  (* hierconn *) wire [29:0] \dut.stage1.out_state ;
  (* hierconn *) wire \dut.stage1.out_val ;
  (* hierconn *) wire [29:0] \dut.stage2.out_state ;
  (* hierconn *) wire \dut.stage2.out_val ;
  (* hierconn *) wire [29:0] \dut.stage3.out_state ;
  (* hierconn *) wire \dut.stage3.out_val ;
  (* hierconn *) wire [29:0] \dut.stage4.out_state ;
  (* hierconn *) wire \dut.stage4.out_val ;
  (* hierconn *) wire [29:0] \dut.stage5.out_state ;
  (* hierconn *) wire \dut.stage5.out_val ;
  (* hierconn *) wire [29:0] \dut.stage6.out_state ;
  (* hierconn *) wire \dut.stage6.out_val ;
  (* hierconn *) wire [29:0] \dut.stage7.out_state ;
  (* hierconn *) wire \dut.stage7.out_val ;
  (* hierconn *) wire [29:0] \dut.stage8.out_state ;
  (* hierconn *) wire \dut.stage8.out_val ;
  wire [269:0] stages = {\dut.stage8.out_state , \dut.stage7.out_state , \dut.stage6.out_state ,
                          \dut.stage5.out_state , \dut.stage4.out_state , \dut.stage3.out_state ,
                          \dut.stage2.out_state , \dut.stage1.out_state , \dut.stage0.out_state };
  wire [8:0] there = {\dut.stage8.out_val , \dut.stage7.out_val , \dut.stage6.out_val , \dut.stage5.out_val ,
                        \dut.stage4.out_val , \dut.stage3.out_val , \dut.stage2.out_val , \dut.stage1.out_val ,
                        \dut.stage0.out_val };

  (* anyconst *) wire [17:0] request;
  (* anyconst *) wire [7:0] floor;

  // The stages of requests, from the contract only: all move when the last result is taken or is none
  reg [8:0] awaited, mine;
  reg first = 1, was_reset, was_val, was_rdy;
  reg [28:0] was_msg;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= send__val; was_rdy <= send__rdy; was_msg <= send__msg;
    if (reset) begin
      awaited <= 0; mine <= 0;
    end else if (!awaited[8] || send__rdy) begin
      awaited <= {awaited[7:0], recv__val};
      mine <= {mine[7:0], recv__val && watch && mine[7:0] == 0 && recv__msg == request && noise_floor == floor};
    end
  end

  wire octant_ok, flags_ok, phase_ok;
  wire [2:0] octant_spec;
  wire [7:0] send_ratio;
  wire [8:0] larger, smaller;
  QuadSpec spec (.x(request[17:9]), .y(request[8:0]), .noise_floor(floor), .msg(send__msg), .octant_ok(octant_ok),
                 .ratio(send_ratio), .flags_ok(flags_ok), .phase_ok(phase_ok), .octant_spec(octant_spec),
                 .larger(larger), .smaller(smaller));
  // A constant too, so that no induction step has to find again that the long division is unchanged
  (* anyconst *) wire [152:0] by_hand;
  wire [152:0] states;
  LongDivision long_division (.larger(larger), .smaller(smaller), .states(states));
  wire [7:0] ratio = by_hand[143:136];
  wire origin = request == 0;

  integer i;
  reg [29:0] stage;
  reg [16:0] division;
  always @* begin
    stage = 0; division = 0;
    for (i = 0; i < 9; i = i + 1) begin
      stage = stage | (mine[i] ? stages[30 * i +: 30] : 30'b0);
      division = division | (mine[i] ? by_hand[17 * i +: 17] : 17'b0);
    end
  end

  always @* begin
    if (first) a_reset: assume (reset);
    a_by_hand: assume (by_hand == states);
    if (!first) begin
      p_octant: assert (!mine[8] || octant_ok);
      p_ratio: assert (!mine[8] || send_ratio == (origin ? 8'd0 : ratio));
      p_flags: assert (!mine[8] || flags_ok);
      p_phase: assert (!mine[8] || phase_ok);
      // A response nine moves after its request, none without one, none lost
      p_in_step: assert (send__val == awaited[8]);
      p_room: assert (recv__rdy == (!awaited[8] || send__rdy));
      p_stable: assert (was_reset || !was_val || was_rdy || send__val && send__msg == was_msg);
      inv_there: assert (there == awaited && (mine & ~awaited) == 0);
      inv_one: assert ((mine & (mine - 1)) == 0);
      inv_stage: assert (mine == 0 || stage == {octant_spec, larger != 0 && larger >= {1'b0, floor}, larger, division});
    end
  end

  always @* if (!first && !was_reset) begin
    c_answer: cover (mine[8] && request == {9'd3, 9'h1FE});
    c_full: cover (&awaited && was_val && !was_rdy);
  end
endmodule
