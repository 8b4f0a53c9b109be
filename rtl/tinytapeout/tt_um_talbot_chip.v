// Tiny Tapeout: the chip of an angle-sensitive-pixel sensor without its pixels.
//
// Registers are written over SPI (mode 0, most significant bit first; docs/chip.md has the map). With the register
// test_pattern a digital image is in place of pixels and converters; the host's command starts a frame, whose bytes come
// out with link_val, one in every cycle in which link_rdy is high.

`default_nettype none

module tt_um_talbot_chip
(
  input  wire [7:0] ui_in,      // 0 sclk, 1 csn, 2 mosi, 3 link_rdy
  output wire [7:0] uo_out,     // link_data
  input  wire [7:0] uio_in,
  output wire [7:0] uio_out,    // 7 busy, 6 link_val, 5 frame_sync, 4 miso, 3 hold, 2 read, 1 integrate, 0 pixel_reset
  output wire [7:0] uio_oe,
  input  wire       ena,
  input  wire       clk,
  input  wire       rst_n
);
  AspChip chip(.clk(clk), .reset(~rst_n), .sclk(ui_in[0]), .csn(ui_in[1]), .mosi(ui_in[2]), .miso(uio_out[4]),
               .miso_oe(), .link_data(uo_out), .link_val(uio_out[6]), .link_rdy(ui_in[3]), .frame_sync(uio_out[5]),
               .busy(uio_out[7]), .comparator(8'b0), .dac(), .hold(uio_out[3]), .wake(), .convert(), .unsigned_(), .mode(), .row(), .group(),
               .k(), .sub(), .en(), .balance(), .pixel_reset(uio_out[0]), .shutter(), .ref_ctl(),
               .integrate(uio_out[1]), .expose(), .cm_reset(), .read(uio_out[2]), .sample(), .tap(), .amp_row(),
               .reset_row());

  assign uio_oe = 8'b1111_1111;

  wire unused = &{ena, ui_in[7:4], uio_in, 1'b0};
endmodule

`default_nettype wire
