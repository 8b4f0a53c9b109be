// Clock and reset for Bench in an event-driven simulator (Icarus).
module Clock #(
    parameter int ROWS = 384, COLS = 384, LANES = 8, TILE_ROWS = 4, TILE_COLS = 6, TAPS = 1
);
  reg clk = 0, reset = 1;
  wire done;
  wire [9:0] row;
  Bench #(.ROWS(ROWS), .COLS(COLS), .LANES(LANES), .TILE_ROWS(TILE_ROWS), .TILE_COLS(TILE_COLS), .TAPS(TAPS))
      bench (.clk(clk), .reset(reset), .done(done), .row(row));
  always #5 clk = ~clk;
  initial #42 reset = 0;
  always @(posedge clk) if (done) $finish;
endmodule
