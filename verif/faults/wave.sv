// The chip alone under a waveform in an event-driven, 4-state simulator: as main.cpp, cycle for cycle.
`timescale 1ns/1ps
module Wave;
  parameter integer LANES = 2;
  reg clk = 0, sclk, csn, mosi, link_rdy, reset;
  wire miso, link_val, frame_sync, busy, hold;
  wire pixel_reset, shutter, ref_ctl, integrate, cm_reset, read, sample;
  wire [1:0] tap;
  wire [7:0] link_data;

  AspChip chip (
      .clk(clk), .reset(reset), .sclk(sclk), .csn(csn), .mosi(mosi), .miso(miso), .link_data(link_data),
      .link_val(link_val), .link_rdy(link_rdy), .frame_sync(frame_sync), .busy(busy), .hold(hold),
      .comparator({LANES{1'b0}}), .pixel_reset(pixel_reset), .shutter(shutter), .ref_ctl(ref_ctl),
      .integrate(integrate), .cm_reset(cm_reset), .read(read), .sample(sample), .tap(tap),
      .dac(), .wake(), .convert(), .unsigned_(), .mode(), .row(), .group(), .k(), .sub(), .en(), .balance(), .amp_row(), .expose(),
      .reset_row());

  integer wave, trace, pins;
  reg [8*512-1:0] name;
  initial begin
    if (!$value$plusargs("wave=%s", name)) $fatal(1, "+wave=FILE is missing");
    wave = $fopen(name, "rb");
    if (!$value$plusargs("trace=%s", name)) $fatal(1, "+trace=FILE is missing");
    trace = $fopen(name, "w");
    for (pins = $fgetc(wave); pins >= 0; pins = $fgetc(wave)) begin
      {reset, link_rdy, mosi, csn, sclk} = pins[4:0];
      #10 if (pins[5]) begin      // the other level, and back, between the edges
        reset = ~reset;
        #5 reset = ~reset;
      end
      #10 $fdisplay(trace, "%b%b%b", link_data, {3'b0, hold, miso, busy, frame_sync, link_val},
                    {tap != 0, sample, read, cm_reset, integrate, ref_ctl, shutter, pixel_reset});
      clk = 1;
      #10 if (pins[6]) begin
        reset = ~reset;
        #5 reset = ~reset;
      end
      #10 clk = 0;
    end
    $fclose(trace);
    $finish;
  end
endmodule
