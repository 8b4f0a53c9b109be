// PayloadPacker, for segments of any length and any pattern of `rdy`.
//
// Tokens: the model decoder beside the packer reads each token when it is coded, with any bits after it (`tail`), and
// finds the samples since the previous token, and the token's length. Bytes: any bit of any token, chosen by `watch`
// and `which`, is sent at its place, and every byte is full except for zeros at the end of the segment. Together: a
// segment's bytes, decoded, are its samples.

module PayloadProof (
  input clk, input reset, input restart, input push, input flush, input coded, input [6:0] threshold, input [7:0] code,
  input rdy, input [27:0] tail, input watch, input [4:0] which
);
  wire ready, val;
  wire [7:0] octet;
  PayloadPacker dut (.*);
  (* hierconn *) wire [5:0] \dut.count ;
  (* hierconn *) wire [34:0] \dut.gathered ;
  (* hierconn *) wire [27:0] \dut.coder.bits ;
  (* hierconn *) wire [4:0] \dut.coder.length ;
  (* hierconn *) wire [3:0] \dut.coder.k ;
  (* hierconn *) wire [3:0] \dut.coder.r2 ;
  (* hierconn *) wire [10:0] \dut.coder.run ;
  (* hierconn *) wire [7:0] \dut.coder.credit ;
  wire [27:0] token = \dut.coder.bits ;
  wire [4:0] length = \dut.coder.length ;
  wire [34:0] gathered = \dut.gathered ;

  // The decoder
  reg [3:0] k;
  reg [3:0] r2;
  reg [7:0] credit;
  wire [27:0] window = token << (28 - length) | tail >> length;
  wire literal, zeros_only, valid;
  wire [11:0] zeros;
  wire [7:0] value, credit_next;
  wire [4:0] decoded_length;
  wire [3:0] k_next;
  wire [3:0] r2_next;
  TokenDecoder decoder (.window(window), .k(k), .r2(r2), .credit(credit), .threshold(threshold), .literal(literal),
                        .zeros_only(zeros_only), .zeros(zeros), .value(value), .length(decoded_length), .k_next(k_next),
                        .r2_next(r2_next), .credit_next(credit_next), .valid(valid));

  // Samples since the last token: zeros, then the one that is taken now, if any; one inside the threshold is a zero
  reg [11:0] run = 0;
  wire signed [8:0] signed_code = {code[7], code};
  wire [8:0] magnitude = signed_code < 0 ? -signed_code : signed_code;
  wire is_zero = magnitude < (threshold == 0 ? 1 : threshold);
  wire [7:0] sample = is_zero ? 0 : code;
  wire makes = push && coded && length != 0;

  // Bits inside, the tracked bit and how many are before it
  reg [5:0] inside = 0, before;
  reg following = 0, followed, ended, fresh;  // the segment has ended; has begun without a sample so far
  wire take = val && rdy;
  wire open = run != 0;
  wire [34:0] padding = gathered << inside;
  wire [5:0] left = inside - (take ? 8 : 0);
  reg first = 1, was_reset, was_coded, was_val, was_rdy, was_row;
  reg [7:0] was_octet;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_coded <= coded;
    was_val <= val; was_rdy <= rdy; was_octet <= octet;
    if (reset || restart) begin
      run <= 0; k <= 3; r2 <= 4; credit <= 128;
    end else if (makes) begin
      run <= 0; k <= k_next; r2 <= r2_next; credit <= credit_next;
    end else if (push && coded) run <= run + 1;
    if (reset) begin
      inside <= 0; following <= 0; ended <= 0; fresh <= 1;
    end else begin
      ended <= flush || ended && !restart;
      fresh <= restart || fresh && !push && !flush;
      // A segment ends with a bit for the zeros that no token has coded, then zeros up to a full byte
      inside <= flush ? ((left + open + 6'd7) & 6'h38) : push ? left + length : left;
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
    // RunLengthCtrl: one action at a time, samples and ends of rows only while there is room
    a_control: assume (push + flush + restart <= 1 && (ready || !push && !flush));
    if (!first && !was_reset) a_config: assume (coded == was_coded || ended || fresh);
    if (!first && !was_reset) begin
      p_length: assert (!makes || decoded_length == length && valid);
      p_literal: assert (!(makes && literal) || value == sample && run == 0);
      p_zeros: assert (!(makes && zeros_only) || is_zero && zeros == run + 1);
      p_value: assert (!(makes && !literal && !zeros_only) || !is_zero && value == sample && zeros == run);
      p_waits: assert (!(push && coded && length == 0) || is_zero);
      p_plain: assert (!(push && !coded) || length == 8 && token[7:0] == code);
      p_bit: assert (!(take && following && before < 8) || octet[7 - before] == followed);
      p_bytes: assert (val == (inside >= 8));
      p_padding: assert (padding == 0);
      p_stable: assert (!was_val || was_rdy || val && octet == was_octet);
    end
    if (!first) begin
      inv_coder: assert (\dut.coder.k == k && \dut.coder.r2 == r2 && \dut.coder.credit == credit
                         && \dut.coder.run == run && r2 <= 12 && k <= 11 && run < 13'd1 << k);
      inv_credit: assert (run == 0 || {1'b0, credit[7:2]} + r2[3:1] >= k + 7'd17);
      inv_plain: assert (coded || run == 0 || ended);
      inv_fresh: assert (!fresh || run == 0);
      inv_inside: assert (\dut.count == inside && inside < 36);
      inv_bit: assert (!following || before < inside && gathered[34 - before] == followed);
    end
  end

  always @* if (!first && !was_reset) begin
    c_literal: cover (makes && literal);
    c_zeros: cover (makes && zeros_only);
    c_value: cover (makes && !literal && !zeros_only && run == 2);
    c_open: cover (flush && run != 0);
    c_follow: cover (take && following && before == 3);
  end
endmodule
