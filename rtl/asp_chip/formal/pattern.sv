// Pattern: the formula of models/digital/pattern.py in whole numbers, for any lane of any sample; a sampled value stays
// until the next hold, whatever the address is.

module PatternProof (
  input clk, input reset, input on, input hold, input [7:0] row, input [7:0] group, input [2:0] k, input [1:0] sub,
  input [8 * `LANES - 1:0] dac, input [`LANES - 1:0] analog
);
  wire [`LANES - 1:0] comparator;
  Pattern dut (.*);

  (* anyconst *) wire [4:0] any;
  wire [4:0] lane = any % `LANES;
  (* hierconn *) wire [8 * `LANES - 1:0] \dut.held ;

  wire [31:0] tile = group * `LANES + lane;
  wire [31:0] ramp = 3 * row + 5 * tile + 40 * k + 37 * sub;
  wire quiet = row / 4 % 2 != tile / 2 % 2;

  reg first = 1;
  reg [7:0] value;
  always @(posedge clk) begin
    first <= 0;
    if (reset) value <= 0;
    else if (on && hold) value <= quiet ? 128 + ramp % 4 : ramp % 256;
  end

  always @* begin
    if (first) a_reset: assume (reset);
    if (!first) begin
      p_compare: assert (comparator[lane] == (on ? value >= dac[8 * lane +: 8] : analog[lane]));
      inv_held: assert (\dut.held [8 * lane +: 8] == value);
    end
    c_quiet: cover (!first && !reset && on && lane == `LANES - 1 && value == 131 && comparator[lane]);
    c_loud: cover (!first && !reset && on && lane == `LANES - 1 && value == 255 && comparator[lane]);
  end
endmodule
