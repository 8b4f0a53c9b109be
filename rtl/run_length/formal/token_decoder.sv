// The model decoder, a token at a time, from docs/stream.md (Payload): the meaning of the bits at the front of `window`
// in the decoder's state, and the state after them.

module TokenDecoder (
  input [26:0] window, input [5:0] k, input [2:0] r2, input [7:0] credit, input [6:0] threshold, input signs,
  output literal, output zeros_only, output [11:0] zeros, output [7:0] value, output [4:0] length,
  output [5:0] k_next, output [2:0] r2_next, output [7:0] credit_next, output valid
);
  wire dense = threshold < 4 && !signs;
  wire [3:0] q = k[5:2];
  wire [2:0] order = r2[2:1] + 3'd1;
  wire [11:0] span = q == 0 ? 0 : 12'd1 << (q - 4'd1);
  assign literal = !signs && credit[7:2] < q + 6'd16;
  assign zeros_only = !literal && q != 0 && !window[26];

  // A single sample (q = 0); or 1, n in q - 1 bits, a value. Of a value p zero bits, a one, and the bits behind it
  wire [10:0] n = q == 0 ? 11'd0 : window[25:15] >> (4'd12 - q);
  wire [26:0] number = window << q;
  reg [4:0] p;
  integer i;
  always @* begin
    p = 27;
    for (i = 0; i < 27; i = i + 1) if (number[i]) p = 26 - i;
  end
  wire [5:0] bits = p == 0 ? order + 1 : order + 2 * p;
  wire [26:0] whole = number >> (27 - bits);
  wire [8:0] x = p == 0 ? whole[8:0] - (9'd1 << order) : whole[8:0];
  wire [7:0] base = threshold == 0 ? 1 : threshold;

  // 0, -base, base, -base - 1, base + 1, ...; behind zeros without the 0
  wire [8:0] place = q == 0 ? x : x + 1;
  wire [8:0] magnitude = place == 0 ? 0 : ((place + 9'd1) >> 1) + base - 1;

  // In ternary mode the value is the sign alone
  wire [7:0] sign = number[26] ? 8'd1 : 8'hFF;

  assign valid = signs || literal || zeros_only || p + order <= 8 && magnitude <= 127 + place[0];
  assign zeros = literal ? 0 : zeros_only ? span : n;
  assign value = signs ? sign : literal ? window[26:19] : place[0] ? -magnitude[7:0] : magnitude[7:0];
  assign length = literal ? 8 : zeros_only ? 1 : signs ? q + 1 : q + bits;

  wire [9:0] spent = credit + 10'd33 - 4 * length;
  wire none = zeros_only || !signs && place == 0;
  assign k_next = literal ? k : none ? (k >= 48 ? k : k + (dense ? 1 : 4))
                  : dense ? (k == 0 ? 0 : k - 1) : k < 12 ? 4 : k - 8;
  assign r2_next = literal || zeros_only ? r2 : p == 0 ? (r2 == 0 ? 0 : r2 - 1) : p > 1 && r2 != 7 ? r2 + 1 : r2;
  assign credit_next = spent > 255 ? 255 : spent[7:0];
endmodule
