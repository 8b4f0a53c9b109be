// ReadoutSeq sends exactly the steps of docs/chip.md (Scan order), each once and in that order, for every window,
// mask, decimation, mode and overlap, and for any behaviour of the amplifiers, the bank and `rdy`.
//
// Order: the steps of a frame ascend strictly in (row, k, group, sub), and the document requires each.
// Completeness: (p_row, p_k, p_group, p_sub) is any step, fixed within a frame; if it is required, it has been
// sent when END is offered. Only scan_order.sv and `lanes_of` state the document's rules. Rows are compared by
// their place, {tile, row in the tile}, which ascends with their `index`.
// Which rows are reset when: reset_pointer.sv.
// Progress: a rank, which never falls in a frame, rises in every cycle but those that wait for the link (an offer), the
// amplifiers (a row that they expose, with the sample-and-holds free) or the bank (a row whose steps are taken). So
// a frame ends after finitely many cycles in which these three answer.

module ReadoutSeqProof (
  input clk, input reset, input start, input amp_done, input amp_err, input bank_idle, input step__rdy,
  input [1:0] mode, input [23:0] mask, input [7:0] row0, input [7:0] row1, input [7:0] col0, input [7:0] col1,
  input [1:0] decimation, input overlap, input [9:0] exposure,
  input [9:0] p_row, input [2:0] p_k, input [7:0] p_group, input [1:0] p_sub
);
  wire [9:0] amp_row, reset_row;
  wire slot_resets, slot_reads, slot_opens, amp_start, busy, cfg_err, done, four_tap, hold_free, step__val;
  wire [63:0] cycles;
  wire [24 + `LANES:0] step__msg;
  ReadoutSeq dut (.*);

  wire [1:0] kind = step__msg[24 + `LANES -: 2];
  wire [9:0] row = step__msg[22 + `LANES -: 10];
  wire [7:0] group = step__msg[12 + `LANES -: 8];
  wire [2:0] k = step__msg[4 + `LANES -: 3];
  wire [1:0] sub = step__msg[1 + `LANES -: 2];
  wire [`LANES - 1:0] en = step__msg[`LANES - 1:0];
  localparam FRAME = 0, ROW = 1, SAMPLE = 2, END = 3, SHIFT = $clog2(`LANES);

  // The document
  `SCAN_ORDER
  wire [1:0] subs = mode == 3 ? 3 : mode == 2 ? 1 : 0;
  function [`LANES - 1:0] lanes_of(input [7:0] group, input [2:0] k);
    integer lane;
    reg [12:0] tile;
    for (lane = 0; lane < `LANES; lane = lane + 1) begin
      tile = `LANES * {5'b0, group} + lane;
      lanes_of[lane] = tile >= col0 && tile <= col1 && ((tile[7:0] - col0) & stride_mask) == 0
                       && `TILE_COLS * tile + k < `COLS;
    end
  endfunction
  wire row_wanted = row_ok(p_row);
  wire wanted = row_wanted && column_ok(p_row[1:0], p_k) && lanes_of(p_group, p_k) != 0 && p_sub <= subs;

  // Inside
  (* hierconn *) wire [2:0] \dut.state ;
  (* hierconn *) wire \dut.integrating ;
  (* hierconn *) wire \dut.failing ;
  (* hierconn *) wire [9:0] \dut.row ;
  (* hierconn *) wire [7:0] \dut.rows.tile ;
  (* hierconn *) wire [1:0] \dut.rows.in_tile ;
  (* hierconn *) wire [9:0] \dut.wait_slots ;
  (* hierconn *) wire [7:0] \dut.steps.last_tile ;
  (* hierconn *) wire [5:0] \dut.steps.left ;
  localparam CHECK = 1, WAIT = 2, DRAIN = 3;
  wire [2:0] state = \dut.state ;
  wire integrating = \dut.integrating ;
  wire [9:0] amp_place = {\dut.rows.tile , \dut.rows.in_tile };
  wire [7:0] last_tile = \dut.steps.last_tile ;
  wire [5:0] left = \dut.steps.left ;

  // The frame so far: the amplifiers, what has been sent, whether the fixed step is among it, the last message
  reg exposing, refused;                  // they work on a slot; have refused one of this frame
  reg [9:0] current;                      // place of the last row that they have finished
  wire overlaps = overlap || lead != 0;
  wire starts = start && !busy, over = exposing && amp_done && !amp_err,
       lands = over && slot_reads, fails = exposing && amp_err || refused;
  reg seen, framed, rows_sent, sampled;
  reg [22:0] last;
  wire [22:0] here = {current, k, group, sub}, there = {p_row, p_k, p_group, p_sub};
  wire taken = step__val && step__rdy;
  wire sampling = step__val && kind == SAMPLE;
  wire [103:0] choice = {mode, mask, row0, row1, col0, col1, decimation, overlap, exposure, there};
  wire waits_link = step__val && !step__rdy;
  wire waits_amplifiers = !step__val && exposing && hold_free && !amp_done && !amp_err;
  wire waits_bank = !step__val && sampled && !hold_free && !bank_idle;
  wire [2:0] part = state == 5 ? 0 : state == 6 ? 1 : state == DRAIN ? 2 : amp_start ? 3 : 4;  // of a row
  wire [27:0] rank = kind == END && step__val ? -28'd1
                     : state == CHECK || kind == FRAME && step__val || state == WAIT && !rows_sent
                     ? {15'd0, lead - \dut.wait_slots , 3'd0} + (state == CHECK ? 28'd0 : state == WAIT ? 28'd2 : 28'd1)
                       + (landed ? 28'd4 : !amp_start)
                     : {2'd1, current, part, state == 6 ? here[12:0] : 13'd0};
  reg first = 1, was_busy, was_reset, was_val, was_rdy, was_starts, was_start_ok, was_start_bad, was_lands, was_free,
      was_bank_idle, was_last, was_given_up, was_cfg_err, was_waits, was_row_left,
      was_passes, was_start;
  reg [24 + `LANES:0] was_msg;
  reg [103:0] was_choice;
  reg [9:0] was_amp_row, held_row;
  reg [27:0] was_rank;
  reg [63:0] was_cycles;
  always @(posedge clk) begin
    first <= 0; was_busy <= busy; was_reset <= reset; was_val <= step__val; was_rdy <= step__rdy; was_msg <= step__msg;
    was_choice <= choice; was_free <= hold_free; was_bank_idle <= bank_idle; was_cfg_err <= cfg_err;
    was_amp_row <= amp_row; was_rank <= rank; was_cycles <= cycles;
    was_start <= start; was_starts <= starts && !reset;
    was_start_ok <= starts && window_ok && wanted;
    was_start_bad <= starts && !window_ok;
    was_lands <= lands; was_passes <= over && !slot_reads;
    was_last <= taken && kind == END;
    was_given_up <= fails && (!step__val || step__rdy);
    was_waits <= waits_link || waits_amplifiers || waits_bank;
    was_row_left <= busy && row_wanted && p_row > amp_place;
    exposing <= !reset && (amp_start || exposing && !amp_done && !amp_err);
    refused <= !reset && fails && step__val && !step__rdy;
    if (lands) held_row <= amp_row;
    current <= reset ? 0 : lands ? amp_place : current;
    if (reset || !busy) begin
      seen <= 0; framed <= 0; rows_sent <= 0; sampled <= 0; last <= 0;
    end else if (taken) begin
      framed <= framed || kind == FRAME;
      rows_sent <= rows_sent || kind == ROW;
      sampled <= kind == SAMPLE;
      seen <= seen || (kind == SAMPLE && here == there);
      if (kind == ROW) last <= {current, 13'b0};
      else if (kind == SAMPLE) last <= here;
    end
  end

  wire [5:0] columns = columns_of(current[1:0]);
  wire landed = rows_sent || !hold_free;      // a row of this frame is in the sample-and-holds, or was
  wire [7:0] bound = `TILE_COLS * {4'b0, col1} + k < `COLS ? col1 : col1 - 8'd1;
  wire loaded = busy && !hold_free && state != 6 && state != DRAIN, walking = loaded || state == 6;
  wire [7:0] group_mask = stride_mask >> SHIFT;

  wire [24 + `LANES:0] used = {2'b11, {10{kind == ROW || kind == SAMPLE}}, {13 + `LANES{kind == SAMPLE}}};

  always @* begin
    if (first) a_reset: assume (reset);
    else begin
      // RegFile locks the configuration while a frame runs
      a_config: assume (!busy || choice == was_choice);
      // AmpCtrl reads a row only while the sample-and-holds are free (p_hold there), which they are until it is done
      a_amp: assume (!(exposing && amp_done) || hold_free);
    end
    if (!first) begin
      p_reset: assert (!was_reset || {busy, done, cfg_err, amp_start, step__val, amp_row, reset_row, slot_resets,
                        slot_opens, cycles} == 0 && hold_free && slot_reads);
      p_four_tap: assert (four_tap == (mode == 3));
      // What the chip's status is about
      p_quiet: assert (!was_reset || !busy && !cfg_err);
      p_begins: assert (!busy || was_busy || was_start);
      p_level: assert (!was_cfg_err || cfg_err || was_start || was_reset);
      p_cycles: assert (cycles == (was_reset || busy && !was_busy ? 64'd0 : was_cycles + was_busy));
    end
    if (!first && !was_reset) begin
      p_wanted: assert (!sampling || row_ok(current) && row == index(current) && column_ok(current[1:0], k)
                        && sub <= subs);
      p_lanes: assert (!sampling || en != 0 && en == lanes_of(group, k));
      p_ascending: assert (!(sampling && sampled) || here > last);
      p_complete: assert (!(step__val && kind == END && wanted) || seen);
      p_rows: assert (!(step__val && kind == ROW) || row_ok(current) && row == index(current) && framed
                      && (!rows_sent || current > last[22:13]));
      p_row_first: assert (!sampling || rows_sent && current == last[22:13]);
      p_frame: assert (!(step__val && kind == FRAME) || !framed);
      p_end: assert (!(step__val && kind == END) || rows_sent && sampled);
      // An offer is stable: its kind, a ROW's row, all of a SAMPLE
      p_stable: assert (!was_val || was_rdy || step__val && ((step__msg ^ was_msg) & used) == 0);
      // Every start is answered: accepted if there is a step to send, else refused
      p_start: assert (!was_start_ok || busy);
      p_refuse: assert (!was_start_bad || !busy && cfg_err);
      p_answer: assert (!was_starts || busy != cfg_err && busy == amp_start);
      p_cfg_err: assert (cfg_err == was_cfg_err || was_starts || was_given_up);
      // A frame ends, once
      p_progress: assert (!(was_busy && busy) || rank >= was_rank && (was_waits || rank != was_rank));
      p_done: assert (done == was_last && !(done && busy));
      p_given_up: assert (!was_given_up || !busy && cfg_err && hold_free);
      p_busy: assert (busy == was_busy || (busy ? was_starts : done != was_given_up));
      // The amplifiers: a slot is started when the one before is finished, if a row is left; a row is sent from the
      // sample-and-holds, which are not free until the bank has converted it
      p_amp_start: assert (!amp_start || !exposing && (overlaps || hold_free) && (!slot_reads
                           || row_ok(amp_place) && amp_row == index(amp_place) && (!landed || amp_place > current)));
      p_early: assert (!was_passes || amp_start);
      p_launch: assert (!(was_row_left && (overlaps ? was_lands : hold_free && !was_free && busy)) || amp_start);
      p_amp_row: assert (amp_row == was_amp_row || amp_start);
      p_held: assert (!(step__val && (kind == ROW || kind == SAMPLE)) || !hold_free && row == held_row);
      p_hold: assert (hold_free == was_free
                      || (hold_free ? was_given_up || was_bank_idle && !was_val : was_lands));
    end
    if (!first) begin
      inv_busy: assert (busy == (state != 0) && step__val == state[2] && (!state[2] || kind == state[1:0]));
      inv_idle: assert (busy || !integrating && hold_free && !amp_start);
      inv_amp_start: assert (!amp_start || integrating);
      inv_exposing: assert (exposing == (integrating && !amp_start) && refused == \dut.failing );
      inv_failing: assert (!\dut.failing || step__val && !integrating);
      inv_amp_row: assert (amp_row == index(amp_place) && amp_place[1:0] < `TILE_ROWS);
      inv_current: assert (\dut.row == index(current));
      inv_held: assert (hold_free || held_row == \dut.row );
      inv_window: assert (!busy || window_ok);
      inv_exposed: assert (!busy || !slot_reads || row_ok(amp_place));
      inv_wait: assert (!busy || \dut.wait_slots <= lead && slot_reads == (\dut.wait_slots == 0));
      inv_some_row: assert (!busy || row_ok({row0, 2'd0}) || row_ok({row0, 2'd1}) || row_ok({row0, 2'd2})
                            || row_ok({row0, 2'd3}));
      inv_reads: assert (!(busy && landed) || slot_reads);
      inv_landed: assert (!(busy && landed) || row_ok(current) && current <= amp_place);
      inv_stages: assert (!busy || (state == CHECK || state == 4 ? !framed && !rows_sent
                                    : framed && (state == WAIT || state == 5 || rows_sent)));
      inv_hold: assert (!busy || (state == CHECK || state == 4 || state == WAIT || state == 7 ? 1 : !hold_free));
      inv_free: assert (state != 7 || hold_free && !integrating && !\dut.failing );
      inv_launch: assert (!busy || \dut.failing || (landed ? integrating == (amp_place != current) : integrating));
      inv_waiting: assert (state != WAIT || \dut.failing || integrating || !hold_free);
      inv_early: assert (!(state == CHECK && amp_start) || hold_free);
      inv_overlap: assert (!(busy && !overlaps && integrating) || hold_free);
      inv_row: assert (!rows_sent || !busy || (state == WAIT || state == 5 ? last[22:13] <= current
              : last[22:13] == current)
                       && (!hold_free || last[22:13] == current));
      inv_row_next: assert (!(state == 5 && rows_sent) || last[22:13] < current);
      inv_row_wait: assert (!(state == WAIT && rows_sent && !hold_free) || last[22:13] < current);
      inv_sampled: assert (!busy || sampled == (rows_sent && (state == WAIT || state == DRAIN || state == 7
              || state == 5
                                                || state == 6 && last[12:0] != 0) ) || state == 6);
      // The position of the steps in their row
      inv_column: assert (!walking || column_ok(current[1:0], k) && left == (columns & ~((6'd2 << k) - 6'd1)));
      inv_last_tile: assert (!walking || last_tile == bound - ((bound - col0) & stride_mask));
      inv_group: assert (!walking || group >= (col0 >> SHIFT) && group <= (last_tile >> SHIFT)
                         && ((group - (col0 >> SHIFT)) & group_mask) == 0);
      inv_sub: assert (!walking || sub <= subs);
      inv_lanes: assert (!walking || en != 0 && en == lanes_of(group, k));
      inv_first_step: assert (!loaded || (columns & ((6'd1 << k) - 6'd1)) == 0 && group == (col0 >> SHIFT)
              && sub == 0);
      inv_last: assert (state != 6 || !sampled || last < here);
      // What has been sent, of the fixed step
      inv_seen: assert (!(busy && wanted) || seen == (state == 6 ? there < here
                                                      : state == DRAIN || state == 7 ? p_row <= current
                                                      : !rows_sent ? 1'b0
                                                      : state == 5 || !hold_free ? p_row < current : p_row <= current));
      // No wanted row is between two consecutive ones
      inv_first_row: assert (!(busy && row_wanted && !landed && slot_reads) || p_row >= amp_place);
      inv_first_landed: assert (!(busy && row_wanted && landed && !rows_sent) || p_row >= current);
      inv_next_landed: assert (!(busy && row_wanted && rows_sent && !hold_free && (state == WAIT || state == 5))
                               || p_row <= last[22:13] || p_row >= current);
      inv_next_row: assert (!(busy && row_wanted && landed && integrating) || p_row <= current || p_row >= amp_place);
      inv_no_row: assert (!(row_wanted && landed && !integrating && !\dut.failing
                            && (state == 7 || overlaps && busy)) || p_row <= current);
    end
  end

  always @* if (!first && !was_reset) begin
    c_frame: cover (done && seen);
    c_rows: cover (step__val && kind == ROW && rows_sent);
    c_groups: cover (sampling && sampled && row == index(last[22:13]) && group > last[9:2]);
    c_given_up: cover (cfg_err && was_busy);
    c_waits: cover (waits_bank && was_val);
    c_overlap: cover (amp_start && !hold_free);
    c_lead: cover (done && seen && lead == 2);
  end
endmodule
