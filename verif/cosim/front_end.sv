// The place of the analog front end in the bench, for a circuit: what the switches of the circuit are told, as one vector
// that the lock-step (lockstep.cpp) turns into voltages, and what the comparators answer, from there. Beside it the
// real-number front end is asked the same questions.
//
//   controls   LANES                  lane l samples (hold and en)
//              8 LANES                its DAC's code
//              LANES                  lane l decides in this cycle: its comparator is strobed
//              SUBS x COLS            column c, sub-sample s at the lane's input while it samples (bit SUBS c + s)
//              1, 1, 1                the row's reset line, its read line, the columns' amplifiers cleared
//              SUBS                   the amplifiers' outputs are sampled, of each tap
//              1                      the row's read, both halves
//              1                      the row's read or a lane's sample
//              4 SUBS                 the row's read, its signal half or a lane's sample, of each tap; each sub-sample at
//                                     the pins; the row's read or a lane's sample, of each tap
//              COLS                   column c is selected while its lane samples
//              1                      the second sub-sample is at the pins
//              1, 1, 1                of the first diode's tap 0: the row's read; its signal half or a lane's sample; either
`default_nettype none
`ifndef BALANCE_BITS
`define BALANCE_BITS 10
`endif

module Afe #(
    parameter int ROWS = 384, COLS = 384, LANES = 8, TILE_ROWS = 4, TILE_COLS = 6
) (
    input  wire                            clk,
    input  wire        [1:0]               mode,
    input  wire        [9:0]               row,
    input  wire        [7:0]               group,
    input  wire        [2:0]               k,
    input  wire        [1:0]               sub,
    input  wire        [LANES-1:0]         en,
    input  wire signed [`BALANCE_BITS-1:0] balance,
    input  wire                            hold,
    input  wire        [8*LANES-1:0]       dac,
    input  wire                            unsigned_,
    output wire        [LANES-1:0]         comparator
);
  localparam int SUBS = 4, LAST = 10;                   // decisions of a conversion, with those of the window
  localparam int ROW = 10 * LANES + SUBS * COLS, MORE = ROW + 3 + SUBS, OWN = MORE + 2 + 4 * SUBS;
  localparam int BITS = OWN + COLS + 4;

  reg [LANES-1:0] answers  /*verilator public_flat_rw*/;
  wire [BITS-1:0] controls  /*verilator public_flat_rd*/;
  wire [LANES-1:0] expected  /*verilator public_flat_rd*/;      // what the real-number front end answers
  wire [64*LANES-1:0] held  /*verilator public_flat_rd*/;       // and the value that it holds, in LSB
  wire [8*LANES-1:0] question  /*verilator public_flat_rd*/;
  wire [LANES-1:0] deciding  /*verilator public_flat_rd*/;
  wire running  /*verilator public_flat_rd*/;
  wire converting  /*verilator public_flat_rd*/;
  wire phases  /*verilator public_flat_rd*/;                    // of the row, this cycle or the one before
  wire integrating  /*verilator public_flat_rd*/;
  wire [1:0] tap  /*verilator public_flat_rd*/;
  wire [31:0] place  /*verilator public_flat_rd*/;
  initial answers = 0;
  assign comparator = answers;
  assign question = dac;
  assign running = Bench.busy;
  assign converting = |(hold ? en : {LANES{1'b0}}) || |deciding;

  wire reads = Bench.read & ~Bench.chip.ref_ctl;
  wire raw = mode == 2'd2;                              // its first diode is in tap 1: each diode has a turn alone
  wire [1:0] tap_a = raw ? 2'd1 : tap;
  wire [1:0] held_tap = raw ? {1'b0, ~sub[0]} : sub;
  wire phase = Bench.pixel_reset | Bench.read;
  reg was_phase;
  initial was_phase = 0;
  always @(posedge clk) was_phase <= phase;
  assign phases = phase | was_phase;
  assign integrating = Bench.integrate;
  assign tap = Bench.chip.tap;
  assign controls[ROW+:3] = {Bench.read & Bench.chip.ref_ctl, reads, Bench.pixel_reset};
  assign controls[MORE] = Bench.read;
  assign controls[MORE+1] = Bench.read | hold;
  for (genvar t = 0; t < SUBS; t++) begin : of_tap
    wire [1:0] now = t == 0 ? tap : tap_a;
    assign controls[MORE+2+t] = Bench.read && int'(now) == t;
    assign controls[MORE+2+SUBS+t] = (reads && int'(now) == t) || (hold && int'(held_tap) == t);
    assign controls[MORE+2+2*SUBS+t] = int'(held_tap) == t;
    assign controls[MORE+2+3*SUBS+t] = controls[MORE+2+t] | controls[MORE+2+SUBS+t];
  end
  for (genvar t = 0; t < SUBS; t++) begin : sampling
    assign controls[ROW+3+t] = reads && Bench.chip.sample && int'(tap) == t;
  end
  assign controls[OWN+COLS] = sub[0];
  assign controls[OWN+COLS+1] = Bench.read && tap_a == 0;
  assign controls[OWN+COLS+2] = (reads && tap_a == 0) || (hold && held_tap == 0);
  assign controls[OWN+COLS+3] = controls[OWN+COLS+1] | controls[OWN+COLS+2];
  assign place = {6'd0, hold, unsigned_, 1'b0, row, sub, k, group};

  RealAfe #(.ROWS(ROWS), .COLS(COLS), .LANES(LANES), .TILE_ROWS(TILE_ROWS), .TILE_COLS(TILE_COLS)) twin (
      .clk(clk), .mode(mode), .row(row), .group(group), .k(k), .sub(sub), .en(en), .balance(balance),
      .hold(hold), .dac(dac), .unsigned_(unsigned_), .comparator(expected)
  );

  task next_exposure;
    twin.next_exposure;
  endtask

  for (genvar l = 0; l < LANES; l++) begin : lane
    reg [3:0] left;                                     // decisions that may follow
    initial left = 0;
    always @(posedge clk)
      if (hold & en[l]) left <= LAST;
      else if (left != 0) left <= left - 1;
    assign controls[l] = hold & en[l];
    assign controls[LANES+8*l+:8] = dac[8*l+:8];
    assign deciding[l] = left != 0;
    assign controls[9*LANES+l] = deciding[l];
    assign held[64*l+:64] = $realtobits(twin.lane[l].held);
  end

  for (genvar c = 0; c < COLS; c++) begin : column      // column c is at position k of the tile column of its lane
    wire selected = hold && en[c/TILE_COLS%LANES] && int'(k) == c % TILE_COLS && int'(group) == c / TILE_COLS / LANES;
    assign controls[OWN+c] = selected;
    for (genvar s = 0; s < SUBS; s++) begin : sub_sample
      assign controls[10*LANES+SUBS*c+s] = selected && int'(sub) == s;
    end
  end
endmodule
`default_nettype wire
