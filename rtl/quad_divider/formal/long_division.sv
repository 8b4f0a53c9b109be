// The state of a long division after 0 to 8 bits, 17 bits each, the first lowest: the rest, and
// the quotient so far. The proof p_defined checks it by multiplication.

module LongDivision (input [8:0] larger, input [8:0] smaller, output [152:0] states);
  assign states[16:0] = {smaller, 8'b0};
  genvar i;
  generate for (i = 0; i < 8; i = i + 1) begin : digit
    wire [16:0] state = states[17 * i +: 17];
    wire [9:0] twice = {state[16:8], 1'b0};
    wire fits = twice >= {1'b0, larger};
    wire [9:0] rest = fits ? twice - {1'b0, larger} : twice;
    assign states[17 * (i + 1) +: 17] = {rest[8:0], state[6:0], fits};
  end endgenerate
endmodule
