// The register between PhasePath and RunLength: it holds a message from the cycle that takes it to the one in which it is
// taken, and takes the next in that same cycle.

module ScanQueueProof (input clk, input reset, input recv__val, input [11:0] recv__msg, input send__rdy);
  wire recv__rdy, send__val, count;
  wire [11:0] send__msg;
  PipeQueue1EntryRTL dut (.*);

  reg held = 0;
  reg [11:0] message;
  reg first = 1, was_reset, was_val, was_rdy;
  reg [11:0] was_msg;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= send__val; was_rdy <= send__rdy; was_msg <= send__msg;
    if (recv__val && recv__rdy) message <= recv__msg;
    held <= !reset && (recv__val && recv__rdy || held && !send__rdy);
  end

  always @* begin
    if (first) a_reset: assume (reset);
    if (!first) begin
      p_val: assert (send__val == held);
      p_msg: assert (!held || send__msg == message);
      p_rdy: assert (recv__rdy == (!held || send__rdy));
      p_stable: assert (was_reset || !was_val || was_rdy || send__val && send__msg == was_msg);
    end
  end

  always @* if (!first && !was_reset) begin
    c_waits: cover (held && recv__val && !send__rdy);
    c_through: cover (held && recv__val && send__rdy);
  end
endmodule
