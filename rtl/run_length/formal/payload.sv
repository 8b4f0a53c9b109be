// PayloadPacker, for segments of any length and any pattern of `rdy`: any bit of any token, chosen by `watch` and
// `which`, is sent at its place, and every byte is full except for zeros at the end of the segment. `tokens` proves what
// the tokens mean. Together: a segment's bytes, decoded, are its samples.

module PayloadProof (
  input clk, input reset, input restart, input push, input flush, input coded, input [6:0] threshold, input [7:0] code,
  input rdy, input watch, input [4:0] which
);
  (* anyconst *) wire signs;  // a segment has one mode; the coder begins each from its start
  wire ready, val;
  wire [7:0] octet;
  PayloadPacker dut (.*);
  (* hierconn *) wire [5:0] \dut.count ;
  (* hierconn *) wire [33:0] \dut.gathered ;
  (* hierconn *) wire [26:0] \dut.coder.bits ;
  (* hierconn *) wire [4:0] \dut.coder.length ;
  (* hierconn *) wire \dut.coder.open ;
  (* hierconn *) wire [5:0] \dut.coder.k ;
  (* hierconn *) wire [10:0] \dut.coder.run ;
  wire [26:0] token = \dut.coder.bits ;
  wire [4:0] length = \dut.coder.length ;
  wire [33:0] gathered = \dut.gathered ;

  // Bits inside, the tracked bit and how many are before it
  reg [5:0] inside = 0, before;
  reg following = 0, followed;
  wire take = val && rdy;
  wire [33:0] padding = gathered << inside;
  wire [5:0] left = inside - (take ? 8 : 0);
  reg first = 1, was_reset, was_val, was_rdy;
  reg [7:0] was_octet;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= val; was_rdy <= rdy; was_octet <= octet;
    if (reset) begin
      inside <= 0; following <= 0;
    end else begin
      // A segment ends with a bit for the zeros that no token has coded, then zeros up to a full byte
      inside <= flush ? ((left + \dut.coder.open + 6'd7) & 6'h38) : push ? left + length : left;
      if (following) begin
        if (take) before <= before - 8;
        if (take && before < 8) following <= 0;
      end else if (push && watch && which < length) begin
        following <= 1; followed <= token[length - 1 - which]; before <= left + which;
      end
    end
  end

  always @* begin
    if (first) a_reset: assume (reset);
    // RunLengthCtrl: one action at a time, samples and ends of segments only while there is room
    else a_control: assume (push + flush <= 1 && (ready || !push && !flush));
    if (!first && !was_reset) begin
      p_bit: assert (!(take && following && before < 8) || octet[7 - before] == followed);
      p_bytes: assert (val == (inside >= 8));
      p_padding: assert (padding == 0);
      p_stable: assert (!was_val || was_rdy || val && octet == was_octet);
    end
    if (!first) begin
      inv_coder: assert (\dut.coder.k [5:2] <= 12 && (!signs || \dut.coder.k >= 4) && (\dut.coder.run == 0
              || \dut.coder.run < (13'd1 << \dut.coder.k [5:2]) >> 1));
      inv_inside: assert (\dut.count == inside && inside < 35);
      inv_bit: assert (!following || before < inside && gathered[33 - before] == followed);
    end
  end

  always @* if (!first && !was_reset) begin
    c_open: cover (flush && \dut.coder.open );
    c_follow: cover (take && following && before == 3);
  end
endmodule
