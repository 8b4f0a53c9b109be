// AmpCtrl for every configuration and every pattern of start, reset and hold_free; the inputs are free in every cycle.
//
// The return to idle is proven by a rank: a number that is 0 in idle, never increases during a row, and decreases in
// every cycle except those of the guard before `read` in which hold_free is low. So a row ends after finitely many
// cycles in which hold_free is high, for every configuration, whatever the slot leaves out.

module AmpCtrlProof (
  input clk, input reset, input start, input four_tap, input hold_free,
  input slot_resets, input slot_reads, input slot_opens,
  input [15:0] t_reset, input [15:0] t_int, input [15:0] t_cm, input [15:0] t_settle, input [15:0] t_read,
  input [15:0] t_guard, input [7:0] n_cm
);
  wire pixel_reset, shutter, ref_ctl, integrate, expose, cm_reset, read, sample, busy, done, cfg_err;
  wire [1:0] tap;
  AmpCtrl dut (.*);

  localparam IDLE = 0, GUARD = 1, RESET = 2, INTEGRATE = 3, CM_RESET = 4, REFERENCE = 5, SIGNAL = 6;
  (* hierconn *) wire [2:0] \dut.state ;
  (* hierconn *) wire [2:0] \dut.after ;
  (* hierconn *) wire [15:0] \dut.count ;
  (* hierconn *) wire [7:0] \dut.resets ;
  (* hierconn *) wire [15:0] \dut.d_reset ;
  (* hierconn *) wire [15:0] \dut.d_int ;
  (* hierconn *) wire [15:0] \dut.d_cm ;
  (* hierconn *) wire [15:0] \dut.d_settle ;
  (* hierconn *) wire [15:0] \dut.d_read ;
  (* hierconn *) wire [15:0] \dut.d_guard ;
  (* hierconn *) wire [7:0] \dut.d_n_cm ;
  (* hierconn *) wire [0:0] \dut.d_four , \dut.d_resets , \dut.d_reads , \dut.d_opens ;
  wire [2:0] state = \dut.state ;
  wire [2:0] after = \dut.after ;
  wire [15:0] count = \dut.count ;
  wire [7:0] resets = \dut.resets ;

  // The configuration at the last accepted start
  reg four, resets_row, reads_row, opens_row;
  reg [15:0] d_reset, d_int, d_cm, d_settle, d_read, d_guard;
  reg [7:0] d_n_cm;
  wire zero = t_reset == 0 || t_int == 0 || t_cm == 0 || t_settle == 0 || t_read == 0 || t_guard == 0;
  wire accept = start && !busy && !reset;
  always @(posedge clk) begin
    if (accept) begin
      four <= four_tap; d_n_cm <= n_cm;
      resets_row <= slot_resets; reads_row <= slot_reads; opens_row <= slot_opens;
      d_reset <= t_reset; d_int <= t_int; d_cm <= t_cm;
      d_settle <= t_settle; d_read <= t_read; d_guard <= t_guard;
    end
  end

  // The previous cycle
  reg first = 1;
  reg was_reset, was_start, was_accept, was_zero, was_free, was_busy, was_ref, was_err;
  reg [1:0] was_tap;
  reg [3:0] was;
  wire [3:0] phases = {pixel_reset, integrate, cm_reset, read};
  reg [30:0] was_rank;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_start <= start; was_accept <= accept; was_zero <= zero; was_free <= hold_free;
    was_busy <= busy; was <= phases; was_rank <= rank; was_ref <= ref_ctl;
    was_err <= cfg_err; was_tap <= tap;
  end

  // `expose` has been, in this row
  reg opened;
  always @(posedge clk) opened <= !(reset || accept) && (opened || expose);

  // Cycles of the current phase or pause so far, and integrations and common-mode resets of this tap
  reg [17:0] length;
  reg [8:0] integrations, cm_resets;
  wire begins = phases != was || (ref_ctl != was_ref);
  wire [17:0] so_far = begins ? 1 : length[17] ? length : length + 1;
  wire [8:0] integrations_now = integrations + (integrate && !was[2]);
  wire [8:0] cm_resets_now = cm_resets + (cm_reset && !was[1]);
  always @(posedge clk) begin
    length <= reset ? 0 : so_far;
    integrations <= reset || accept || state == RESET ? 0 : integrations_now;
    cm_resets <= reset || accept || state == RESET ? 0 : cm_resets_now;
  end

  // The rank: taps, common-mode resets, phases and cycles left, the most significant first
  reg [3:0] place;
  always @* begin
    case (state)
      RESET: place = 8;
      INTEGRATE: place = 6;
      CM_RESET: place = 4;
      REFERENCE: place = 2;
      SIGNAL: place = 1;
      default: place = after == RESET ? 9 : after == INTEGRATE ? 7 : after == CM_RESET ? 5 : after == REFERENCE ? 3 : 0;
    endcase
  end
  wire [7:0] still = place >= 8 ? d_n_cm : resets;      // loaded at the end of the pixel reset
  wire [30:0] rank = busy ? {1'b1, four ? ~tap : 2'b0, still, place, count} : 0;

  wire shown = state == RESET ? resets_row : reads_row;  // the current phase is
  reg [15:0] duration;
  always @* begin
    case (state)
      RESET: duration = d_reset;
      INTEGRATE: duration = d_int;
      CM_RESET: duration = d_cm;
      REFERENCE: duration = d_settle;
      default: duration = d_read;
    endcase
  end

  always @* begin
    if (first) a_reset: assume (reset);
    if (!first && was_reset)
      p_reset: assert ({phases, shutter, ref_ctl, expose, sample, tap, busy, done, cfg_err} == 0);
    if (!first && !was_reset) begin
      // Phases never overlap: of two, one has ended and a cycle with none is between
      p_exclusive: assert ((phases & (phases - 1)) == 0);
      p_apart: assert (was == 0 || phases == 0 || phases == was);
      // All outputs are low when no row is in progress
      p_rest: assert (busy || {phases, shutter, ref_ctl, expose, sample, tap} == 0);
      // A slot leaves out what it is not asked for
      p_left_out: assert (!busy || (resets_row || !pixel_reset)
                          && (reads_row || {integrate, cm_reset, read, shutter, ref_ctl, sample} == 0));
      // The row that is reset opens once, a guard after its reset: with the first cycle of the shutter where one is read
      p_expose: assert (expose == (busy && opens_row && !opened && state == INTEGRATE));
      p_expose_time: assert (!expose || !resets_row || was == 0 && length == d_guard);
      p_expose_first: assert (!expose || !reads_row || integrate && !was[2] && integrations_now == 1);
      p_expose_done: assert (!done || opened == opens_row);
      // It returns to idle
      p_progress: assert (!was_busy || (was_free ? rank < was_rank : rank <= was_rank));
      p_done: assert (done == (was_busy && !busy));
      // A start begins a row, unless a duration is zero
      p_start: assert (!was_accept || (was_zero ? !busy && cfg_err : busy && !cfg_err));
      p_error: assert (cfg_err == (was_accept ? was_zero : was_err));
      p_still: assert (was_busy || was_accept || !busy);
      // The sample-and-hold is overwritten only when it is free
      p_hold: assert (!(read && !was[0]) || was_free);
      // Every phase lasts as long as configured, every pause at least as long
      p_reset_length: assert (!(was[3] && !pixel_reset) || length == d_reset);
      p_int_length: assert (!(was[2] && !integrate) || length == d_int);
      p_cm_length: assert (!(was[1] && !cm_reset) || length == d_cm);
      p_settle_length: assert (!(was_ref && !ref_ctl) || length == d_settle && read);
      p_read_length: assert (!(was[0] && !was_ref && !read) || length == d_read);
      p_guard_length: assert (!(was == 0 && phases != 0) || length >= d_guard);
      p_cm_count: assert (!(read && !was[0]) || cm_resets == d_n_cm && integrations == d_n_cm + 1);
      // The shutter is open from the first integration to the end of the last
      p_shutter: assert (shutter == (integrate || integrations_now != 0 && integrations_now <= d_n_cm));
      // A tap ends where the next one's reset begins, the last one with the row
      p_tap: assert (tap == was_tap || (done ? tap == 0 : tap == was_tap + 2'd1 && (pixel_reset && !was[3] || !resets_row)));
      p_taps: assert (!done || was_tap == (four ? 3 : 0));
      // The reference level is sampled in its last cycle, the signal in its last
      p_sample: assert (sample == (ref_ctl ? so_far == d_settle : read && so_far == d_read));
    end
    if (!first) begin
      // An error lasts until the next start
      p_quiet: assert (!was_reset || !cfg_err);
      p_level: assert (!was_err || cfg_err || was_start || was_reset);
      inv_state: assert (state != 7 && busy == (state != IDLE));
      inv_after: assert (state == IDLE || (after != CM_RESET || resets != 0) && after != GUARD && after < SIGNAL);
      inv_pins: assert (phases == ({state == RESET, state == INTEGRATE, state == CM_RESET, state >= REFERENCE}
                                   & {resets_row, {3{reads_row}}})
                        && ref_ctl == (reads_row && state == REFERENCE)
                        && sample == (reads_row && state >= REFERENCE && count == 0));
      inv_opens: assert (!busy || \dut.d_opens == (opens_row && !opened && !expose)
                         && (place >= 7 || opened || expose || !opens_row) && (place < 8 || !opened || tap != 0)
                         && (!opened || opens_row) && (!\dut.d_opens || integrations_now == 0));
      inv_captured: assert (!busy || {\dut.d_reset , \dut.d_int , \dut.d_cm , \dut.d_settle , \dut.d_read ,
                                      \dut.d_guard , \dut.d_n_cm , \dut.d_four , \dut.d_resets , \dut.d_reads }
                                     == {d_reset, d_int, d_cm, d_settle, d_read, d_guard, d_n_cm, four, resets_row,
                                         reads_row});
      inv_saturated: assert (length <= 18'h20000);
      inv_positive: assert (!busy || d_reset && d_int && d_cm && d_settle && d_read && d_guard);
      inv_length: assert (!busy || (state == GUARD ? so_far + count >= d_guard && count < d_guard
                                    : !shown || so_far + count == duration));
      inv_after_reset: assert (!(busy && state == GUARD && after == INTEGRATE && resets_row && !opened && opens_row)
                               || so_far + count == d_guard);
      inv_resets: assert (!(busy && place < 8 && place > 0)
                          || (!reads_row || cm_resets_now + resets == d_n_cm + (place == 4)
                             && integrations_now == cm_resets_now + (place != 7 && place != 4))
                             && resets <= d_n_cm && (place > 3 || resets == 0)
                             && (place < 4 || place > 5 || resets != 0));
      inv_nothing: assert (!busy || reads_row || {integrations_now, cm_resets_now} == 0);
      inv_shutter: assert (busy && place > 0 && place < 8 || integrations_now == 0
                           || integrations_now == d_n_cm + 1 && !(busy && place == 9));
      inv_tap: assert (busy ? four || tap == 0 : tap == 0);
    end
  end

  always @* if (!first && !was_reset) begin
    c_row: cover (done && d_n_cm == 1);
    c_taps: cover (tap == 1 && read);
    c_refused: cover (cfg_err);
    c_opens: cover (done && opened && !reads_row);
    c_ends: cover (done && reads_row && !resets_row);
    c_waits: cover (read && !was[0] && length > 8);
  end
endmodule
