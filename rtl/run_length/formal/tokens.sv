// TokenCoder, for segments of any length: the model decoder beside the coder reads each token when it is coded, with any
// bits after it (`tail`), and finds the samples since the previous token, and the token's length.

module TokensProof (
  input clk, input reset, input restart, input push, input coded, input [6:0] threshold, input [7:0] code,
  input [26:0] tail
);
  (* anyconst *) wire signs;  // a segment has one mode; the coder begins each from its start
  wire [26:0] bits;
  wire [4:0] length;
  wire open;
  TokenCoder dut (.*);
  (* hierconn *) wire [5:0] \dut.k ;
  (* hierconn *) wire [2:0] \dut.r2 ;
  (* hierconn *) wire [10:0] \dut.run ;
  (* hierconn *) wire [7:0] \dut.credit ;

  // The decoder
  reg [5:0] k;
  reg [2:0] r2;
  reg [7:0] credit;
  wire [26:0] window = bits << (27 - length) | tail >> length;
  wire literal, zeros_only, valid;
  wire [11:0] zeros;
  wire [7:0] value, credit_next;
  wire [4:0] decoded_length;
  wire [5:0] k_next;
  wire [2:0] r2_next;
  TokenDecoder decoder (.window(window), .k(k), .r2(r2), .credit(credit), .threshold(threshold), .signs(signs), .literal(literal),
                        .zeros_only(zeros_only), .zeros(zeros), .value(value), .length(decoded_length), .k_next(k_next),
                        .r2_next(r2_next), .credit_next(credit_next), .valid(valid));

  // Samples since the last token: zeros, then the one that is taken now, if any; one inside the threshold is a zero
  reg [11:0] run = 0;
  wire signed [8:0] signed_code = {code[7], code};
  wire [8:0] magnitude = signed_code < 0 ? -signed_code : signed_code;
  wire is_zero = signs ? !code[0] : magnitude < (threshold == 0 ? 1 : threshold);
  wire [7:0] sample = is_zero ? 0 : signs ? {{7{code[7]}}, 1'b1} : code;
  wire makes = push && coded && length != 0;

  reg first = 1, was_reset;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset;
    if (reset || restart) begin
      run <= 0; k <= threshold < 4 && !signs ? 8 : 16; r2 <= 2; credit <= 128;
    end else if (makes) begin
      run <= 0; k <= k_next; r2 <= r2_next; credit <= credit_next;
    end else if (push && coded) run <= run + 1;
  end

  always @* begin
    if (first) a_reset: assume (reset);
    if (!first && !was_reset) begin
      p_length: assert (!makes || decoded_length == length && valid);
      p_literal: assert (!(makes && literal) || value == sample && run == 0);
      p_zeros: assert (!(makes && zeros_only) || is_zero && zeros == run + 1);
      p_value: assert (!(makes && !literal && !zeros_only) || (k < 4 || !is_zero) && value == sample && zeros == run);
      p_waits: assert (!(push && coded && length == 0) || is_zero);
      p_plain: assert (!(push && !coded) || length == 8 && bits[7:0] == code);
      p_open: assert (open == (run != 0));
    end
    if (!first) begin
      inv_coder: assert (\dut.k == k && (signs ? k >= 4 : \dut.r2 == r2 && \dut.credit == credit) && \dut.run == run
                         && k[5:2] <= 12 && (run == 0 || run < (13'd1 << k[5:2]) >> 1));
      inv_credit: assert (signs || run == 0 || credit[7:2] >= k[5:2] + 6'd16);
    end
  end

  always @* if (!first && !was_reset) begin
    c_literal: cover (makes && literal);
    c_zeros: cover (makes && zeros_only);
    c_value: cover (makes && !literal && !zeros_only && run == 2);
    c_single: cover (makes && !literal && k < 4 && value == 0);
    c_sign: cover (makes && signs && value == 8'hFF && run == 2);
    c_open: cover (open);
  end
endmodule
