// Clock and reset for Bench in an event-driven simulator (Icarus).
module Clock #(
    parameter int ROWS = 384, COLS = 384, LANES = 8, TILE_ROWS = 4, TILE_COLS = 6
);
  reg clk = 0, reset = 1;
  wire done;
  wire [9:0] row;
  wire [31:0] cycles;
  Bench #(.ROWS(ROWS), .COLS(COLS), .LANES(LANES), .TILE_ROWS(TILE_ROWS), .TILE_COLS(TILE_COLS))
      bench (.clk(clk), .reset(reset), .done(done), .row(row), .cycles(cycles));
  always #5 clk = ~clk;
  initial #42 reset = 0;

  // A frame that never ends is an error, not a hang (status 1, as of every $fatal)
  reg [63:0] max_cycles;
  initial if (!$value$plusargs("max_cycles=%d", max_cycles)) max_cycles = 64'd1_000_000_000;
  always @(posedge clk) begin
    if (done) $finish;
    else if (cycles >= max_cycles) $fatal(1, "no frame end within %0d cycles", max_cycles);
  end
endmodule
