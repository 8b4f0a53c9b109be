// The three dividers in parallel: the same request gives the same response. Their latencies differ; the first response
// is kept until the others are ready.

module EqualProof (input clk, input reset);
  (* anyconst *) wire [17:0] request;
  (* anyconst *) wire [7:0] floor;
  wire rdy2, rdy4, rdyp, val2, val4, valp;
  wire [28:0] msg2, msg4, msgp;
  reg [3:0] turn = 0;
  wire ask = turn == 1;
  QuadDividerRadix2 radix2 (.clk(clk), .reset(reset), .recv__msg(request), .recv__val(ask), .recv__rdy(rdy2),
                            .send__rdy(1'b0), .send__val(val2), .send__msg(msg2), .noise_floor(floor));
  QuadDividerRadix4 radix4 (.clk(clk), .reset(reset), .recv__msg(request), .recv__val(ask), .recv__rdy(rdy4),
                            .send__rdy(1'b0), .send__val(val4), .send__msg(msg4), .noise_floor(floor));
  QuadDividerPipelined pipelined (.clk(clk), .reset(reset), .recv__msg(request), .recv__val(ask), .recv__rdy(rdyp),
                                  .send__rdy(1'b0), .send__val(valp), .send__msg(msgp), .noise_floor(floor));
  always @(posedge clk) turn <= turn + !(&turn);

  always @* begin
    a_reset: assume (reset == (turn == 0));
    p_taken: assert (!ask || rdy2 && rdy4 && rdyp);
    p_answered: assert (turn < 11 || val2 && val4 && valp);
    p_equal24: assert (turn == 0 || !(val2 && val4) || msg2 == msg4);
    p_equal2p: assert (turn == 0 || !(val2 && valp) || msg2 == msgp);
    c_answered: cover (turn != 0 && val2 && val4 && valp && msg2[28:26] == 5);
  end
endmodule
