// Tiny Tapeout: the pixel amplifier's control behind a byte bus; its waveforms come out on the pins.
//
// Bytes to write, durations low byte first: 0,1 t_reset, 2,3 t_int, 4,5 t_cm, 6,7 t_settle, 8,9 t_read, 10,11 t_guard,
// 12 n_cm, 13 {four_tap in bit 0}: starts a row.

`default_nettype none

module tt_um_talbot_amp_ctrl
(
  input  wire [7:0] ui_in,      // data
  output wire [7:0] uo_out,     // pixel_reset, shutter, ref_ctl, integrate, cm_reset, read, sample, busy, from bit 0
  input  wire [7:0] uio_in,     // 0 strobe, 1 is_address, 2 hold_free
  output wire [7:0] uio_out,    // 7 done, 6 cfg_err, 5:4 tap
  output wire [7:0] uio_oe,
  input  wire       ena,
  input  wire       clk,
  input  wire       rst_n
);
  wire reset = ~rst_n;
  wire [3:0] address;
  wire [7:0] value;
  wire write;

  tt_bytes bytes(.clk(clk), .reset(reset), .data(ui_in), .strobe(uio_in[0]), .is_address(uio_in[1]),
                 .address(address), .write(write), .value(value));

  reg [103:0] durations;        // byte k at 8 k
  reg four_tap, start;
  reg [1:0] free;               // hold_free comes from outside this clock

  always @(posedge clk) begin
    if (reset) begin
      durations <= 104'b0;
      four_tap <= 1'b0;
      start <= 1'b0;
      free <= 2'b0;
    end else begin
      if (write & (address < 4'd13)) durations[8 * address +: 8] <= value;
      if (write & (address == 4'd13)) four_tap <= value[0];
      start <= write & (address == 4'd13);
      free <= {free[0], uio_in[2]};
    end
  end

  AmpCtrl ctrl(.clk(clk), .reset(reset), .start(start), .four_tap(four_tap), .hold_free(free[1]),
               .slot_resets(1'b1), .slot_reads(1'b1), .slot_opens(1'b0), .expose(),
               .t_reset(durations[15:0]), .t_int(durations[31:16]), .t_cm(durations[47:32]),
               .t_settle(durations[63:48]), .t_read(durations[79:64]), .t_guard(durations[95:80]),
               .n_cm(durations[103:96]), .pixel_reset(uo_out[0]), .shutter(uo_out[1]), .ref_ctl(uo_out[2]),
               .integrate(uo_out[3]), .cm_reset(uo_out[4]), .read(uo_out[5]), .sample(uo_out[6]), .busy(uo_out[7]),
               .done(uio_out[7]), .cfg_err(uio_out[6]), .tap(uio_out[5:4]));

  assign uio_out[3:0] = 4'b0;
  assign uio_oe = 8'b1111_0000;

  wire unused = &{ena, uio_in[7:3], 1'b0};
endmodule

`default_nettype wire
