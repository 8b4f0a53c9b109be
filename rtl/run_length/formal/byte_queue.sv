// ByteQueue: bytes are sent in the order in which they are put, each once, for any `rdy`.
//
// `watch`, free in every cycle, chooses a byte to track when it is put: its value, and how many are ahead of it.

module ByteQueueProof (input clk, input reset, input put, input [7:0] octet, input send__rdy, input watch);
  wire ready, last, send__val;
  wire [7:0] send__msg;
  ByteQueue dut (.*);
  (* hierconn *) wire [1:0] \dut.count ;
  (* hierconn *) wire [7:0] \dut.second ;

  reg [1:0] inside = 0, ahead;
  reg following = 0;
  reg [7:0] followed;
  wire take = send__val && send__rdy;
  reg first = 1, was_reset, was_val, was_rdy;
  reg [7:0] was_msg;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= send__val; was_rdy <= send__rdy; was_msg <= send__msg;
    if (reset) begin
      inside <= 0; following <= 0;
    end else begin
      inside <= inside + put - take;
      if (following) begin
        if (take && ahead == 0) following <= 0;
        ahead <= ahead - take;
      end else if (put && watch) begin
        following <= 1; followed <= octet; ahead <= inside - take;
      end
    end
  end

  always @* begin
    if (first) a_reset: assume (reset);
    else a_put: assume (!put || ready);
    if (!first && !was_reset) begin
      p_order: assert (!(take && following && ahead == 0) || send__msg == followed);
      p_val: assert (send__val == (inside != 0));
      p_room: assert (inside <= 2 && ready == (inside < 2));
      p_last: assert (last == (inside - take == 0));
      p_stable: assert (!was_val || was_rdy || send__val && send__msg == was_msg);
    end
    if (!first) begin
      inv_count: assert (\dut.count == inside && inside <= 2);
      inv_followed: assert (!following || ahead < inside && (ahead == 0 ? send__msg : \dut.second ) == followed);
    end
  end

  always @* if (!first && !was_reset) begin
    c_full: cover (inside == 2 && following && ahead == 1);
    c_through: cover (take && put && following);
  end
endmodule
