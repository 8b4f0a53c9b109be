// The model decoder, a token at a time, from docs/stream.md (Payload): the meaning of the bits at the front of `window`
// in the decoder's state, and the state after them.

module TokenDecoder (
  input [27:0] window, input [3:0] k, input [3:0] r2, input [7:0] credit, input [6:0] threshold,
  output literal, output zeros_only, output [11:0] zeros, output [7:0] value, output [4:0] length,
  output [3:0] k_next, output [3:0] r2_next, output [7:0] credit_next, output valid
);
  wire [2:0] r = r2[3:1];
  assign literal = {1'b0, credit[7:2]} + r < k + 7'd17;
  assign zeros_only = !literal && !window[27];

  // 1, n in k bits, the sign, p zero bits and the value from its leading one on: 2 p + r + 1 bits of it
  wire [26:0] behind_one = window[26:0];
  wire [10:0] n = behind_one[26:16] >> (11 - k);
  wire [26:0] at_sign = behind_one << k;
  wire sign = at_sign[26];
  wire [25:0] number = at_sign[25:0];
  reg [4:0] p;
  integer i;
  always @* begin
    p = 26;
    for (i = 0; i < 26; i = i + 1) if (number[i]) p = 25 - i;
  end
  wire [4:0] bits = 2 * p + r + 1;
  wire [25:0] x = number >> (26 - bits);
  wire [7:0] base = threshold == 0 ? 1 : threshold;
  wire [8:0] magnitude = x[8:0] + base - (9'd1 << r);

  assign valid = literal || zeros_only || p + r <= 7 && magnitude <= 127 + sign;
  assign zeros = literal ? 0 : zeros_only ? 12'd1 << k : n;
  assign value = literal ? window[27:20] : sign ? -magnitude[7:0] : magnitude[7:0];
  assign length = literal ? 8 : zeros_only ? 1 : 2 + k + bits;

  wire [9:0] spent = credit + 10'd33 - 4 * length;
  assign k_next = literal ? k : zeros_only ? (k == 11 ? 11 : k + 1) : k < 2 ? 0 : k - 2;
  assign r2_next = literal || zeros_only ? r2 : p == 0 ? (r2 == 0 ? 0 : r2 - 1) : p > 1 && r2 != 12 ? r2 + 1 : r2;
  assign credit_next = spent > 255 ? 255 : spent[7:0];
endmodule
