// The long division, which the dividers are compared with, is the README's definition, for every pair of operands.

module ReferenceProof (input [8:0] x, input [8:0] y);
  wire [9:0] ax = x[8] ? {1'b0, ~x} + 1 : x, ay = y[8] ? {1'b0, ~y} + 1 : y;
  wire [8:0] larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
  wire [152:0] by_hand;
  LongDivision long_division (.larger(larger), .smaller(smaller), .states(by_hand));
  wire [7:0] ratio = by_hand[143:136];

  // Zero-extended: eighteen bits are enough for every product
  wire [17:0] product = {10'b0, ratio} * {9'b0, larger};
  wire [17:0] wanted = {1'b0, smaller, 8'b0};
  always @* begin
    p_defined: assert (larger == smaller ? ratio == 255 : product <= wanted && wanted < product + {9'b0, larger});
    c_ratio: cover (ratio == 85);
  end
endmodule
