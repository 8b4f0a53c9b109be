// The counters of AdcBank with all its lanes: `made` and `left_out` count the results that are sent, converted and not,
// from one FRAME to the next, in all 32 bits.

module AdcBankCounters (
  input clk, input reset, input [`STEP_BITS - 1:0] step__msg, input step__val, input scan__rdy, input [1:0] mode,
  input [6:0] threshold, input [`LANES - 1:0] comparator
);
  wire [8 * `LANES - 1:0] dac;
  wire hold, unsigned_, idle, step__rdy, scan__val;
  wire [9:0] row; wire [7:0] group; wire [2:0] k; wire [1:0] sub; wire [`LANES - 1:0] en;
  wire [31:0] made, left_out;
  wire [11:0] scan__msg;
  AdcBank dut (.*);
  localparam FRAME = 0, SAMPLE = 2;
  (* hierconn *) wire [9:0] \dut.result ;
  (* hierconn *) wire \dut.mark ;

  wire [1:0] kind = scan__msg[11:10];
  wire sent = scan__val && scan__rdy;
  reg [31:0] conversions, zeros;
  reg first = 1;
  always @(posedge clk) begin
    first <= 0;
    if (reset || sent && \dut.mark && kind == FRAME) begin
      conversions <= 0; zeros <= 0;
    end else if (sent && !\dut.mark ) begin
      conversions <= conversions + \dut.result [8];
      zeros <= zeros + !\dut.result [8];
    end
  end

  always @* begin
    if (first) assume (reset);
    else begin
      p_made: assert (made == conversions);
      p_left_out: assert (left_out == zeros);
    end
    c_made: cover (!first && made == 2 && scan__val && kind == SAMPLE);
    c_left_out: cover (!first && left_out == 2 && scan__val && kind == SAMPLE);
  end
endmodule
