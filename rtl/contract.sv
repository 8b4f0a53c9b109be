// The interface contract of docs/chip.md in every cycle of a simulation in Verilator, which stops where a line is broken.
// Without a PhasePath the ports phase_... are low.

module Contract #(parameter LANES = 1) (
  input clk, input reset,
  input [2:0] bank_mode, input [6:0] bank_threshold, input bank_idle, input scan_val, input step_val, input step_rdy,
  input phase_on, input [11:0] phase_msg, input phase_val, input phase_rdy,
  input amp_start, input amp_done, input amp_err, input hold_free,
  input frame_sync, input seq_busy
);
  localparam SAMPLE = 2, END = 3;
  wire [1:0] kind = phase_msg[11:10];
  wire last = phase_msg[9], taken = phase_val && phase_rdy;

  reg was_reset = 1, converts, was_on, open, exposing, was_sync, was_busy;
  reg [2:0] was_mode;
  reg [6:0] was_threshold;
  reg [1:0] tap;
  reg [5:0] index, samples;

  task broken(input [8 * 32 - 1:0] line);
    begin
      $display("%%Error: interface contract = %0s: is broken", line);
      $stop;
    end
  endtask

  always @(posedge clk) begin
    was_reset <= reset; was_mode <= bank_mode; was_threshold <= bank_threshold; was_on <= phase_on;
    was_sync <= frame_sync; was_busy <= seq_busy;
    converts <= !bank_idle || scan_val || step_val && step_rdy;
    exposing <= !reset && (amp_start || exposing && !amp_done && !amp_err);
    if (reset) begin
      open <= 0; tap <= 0; index <= 0;
    end else if (taken) begin
      open <= kind != END;
      if (phase_on && kind == SAMPLE) begin
        index <= last ? 0 : index + 1;
        if (last) tap <= tap + 1;
        if (last && tap == 0) samples <= index;
      end
    end
    if (!reset && !was_reset) begin
      if (converts && (bank_mode != was_mode || bank_threshold != was_threshold)) broken("configuration_of_the_bank");
      if (phase_on && phase_val && kind != SAMPLE && (tap != 0 || index != 0)) broken("steps_are_whole");
      if (phase_on && phase_val && kind == SAMPLE &&
          !(tap == 0 ? index < LANES - 1 || last : last == (index == samples))) broken("steps_are_equal");
      if (open && phase_on != was_on) broken("phase_is_constant");
      if (exposing && amp_done && !hold_free) broken("rows_are_free");
      if (frame_sync && !was_sync && !was_busy) broken("bytes_begin_while_busy");
    end
  end
endmodule
