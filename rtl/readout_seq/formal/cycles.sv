// `cycles` counts the cycles in which `busy` is high, from 0 in a frame's first one, and is stable after its end: all
// 64 bits, which no simulation reaches. The tests cover amplifiers that refuse: an aborted frame needs the invariants
// of readout_seq.sv.

module ReadoutSeqCycles (
  input clk, input reset, input start, input amp_done, input amp_err, input bank_idle, input step__rdy,
  input [1:0] mode, input [23:0] mask, input [7:0] row0, input [7:0] row1, input [7:0] col0, input [7:0] col1,
  input [1:0] decimation, input overlap
);
  wire [9:0] amp_row;
  wire amp_start, busy, cfg_err, done, four_tap, hold_free, step__val;
  wire [63:0] cycles;
  wire [24 + `LANES:0] step__msg;
  ReadoutSeq dut (.*);

  reg first = 1, was_busy, was_reset;
  reg [63:0] was_cycles;
  always @(posedge clk) begin
    first <= 0;
    was_busy <= busy;
    was_reset <= reset;
    was_cycles <= cycles;
  end

  always @* begin
    assume (!amp_err);
    if (first) assume (reset);
    else p_cycles: assert (cycles == (was_reset || busy && !was_busy ? 64'd0 : was_cycles + was_busy));
    c_frame: cover (!first && cycles == 3);
  end
endmodule
