// Tiny Tapeout: the quadrature divider behind a byte bus.
//
// Bytes to write: 0 x[7:0], 1 y[7:0], 2 {noise_floor[5:0] in 7:2, y[8], x[8]}, 3 any: start.
// uo_out is the byte of the result that the address selects (modulo 4): 0 phase, 1 ratio, 2 amplitude,
// 3 {octant, zero, amp_valid, 3'b0}. It is valid while uio[7] is high, from the result to the next start.

`default_nettype none

module tt_um_talbot_divider
(
  input  wire [7:0] ui_in,      // data
  output reg  [7:0] uo_out,
  input  wire [7:0] uio_in,     // 0 strobe, 1 is_address
  output wire [7:0] uio_out,    // 7 valid, 6 busy
  output wire [7:0] uio_oe,
  input  wire       ena,
  input  wire       clk,
  input  wire       rst_n
);
  wire reset = ~rst_n;
  wire [3:0] address;
  wire [7:0] value;
  wire write, ready, valid;

  tt_bytes bytes(.clk(clk), .reset(reset), .data(ui_in), .strobe(uio_in[0]), .is_address(uio_in[1]),
                 .address(address), .write(write), .value(value));

  reg [8:0] x, y;
  reg [5:0] noise_floor;
  reg waiting;
  wire start = write & (address == 4'd3);

  always @(posedge clk) begin
    if (reset) begin
      x <= 9'b0;
      y <= 9'b0;
      noise_floor <= 6'b0;
      waiting <= 1'b0;
    end else begin
      if (write & (address == 4'd0)) x[7:0] <= value;
      if (write & (address == 4'd1)) y[7:0] <= value;
      if (write & (address == 4'd2)) {noise_floor, y[8], x[8]} <= value;
      waiting <= start | (waiting & ~ready);
    end
  end

  // The result stays until the next start drops it, be it that of a division still under way
  wire [28:0] result;
  QuadDividerRadix4 divider(.clk(clk), .reset(reset), .noise_floor({2'b0, noise_floor}), .recv__msg({x, y}),
                            .recv__val(waiting), .recv__rdy(ready), .send__msg(result), .send__val(valid),
                            .send__rdy(waiting));

  wire [2:0] octant = result[28:26];
  wire [7:0] ratio = result[25:18];
  wire zero = result[17];
  wire [7:0] phase = result[16:9];
  wire amp_valid = result[8];
  wire [7:0] amp = result[7:0];

  always @* begin
    case (address[1:0])
      2'd0: uo_out = phase;
      2'd1: uo_out = ratio;
      2'd2: uo_out = amp;
      default: uo_out = {octant, zero, amp_valid, 3'b0};
    endcase
  end

  assign uio_out = {valid & ~waiting, waiting | ~(valid | ready), 6'b0};
  assign uio_oe = 8'b1100_0000;

  wire unused = &{ena, uio_in[7:2], 1'b0};
endmodule

`default_nettype wire
