// The reset pointer of ReadoutSeq, for every window, mask, decimation, mode and exposure and any behaviour of the
// amplifiers, the bank and `rdy`: slot n of the amplifiers resets the n-th of the rows that docs/chip.md (Scan order)
// requires, until all are reset, and slot n + lead reads it. `nth` counts the required rows before a place {tile, row in
// the tile}. That every required row is read: readout_seq.sv.
//
// p_row is any place, fixed within a frame.

module ResetPointerProof (
  input clk, input reset, input start, input amp_done, input amp_err, input bank_idle, input step__rdy,
  input [1:0] mode, input [23:0] mask, input [7:0] row0, input [7:0] row1, input [7:0] col0, input [7:0] col1,
  input [1:0] decimation, input overlap, input [9:0] exposure, input [9:0] p_row
);
  wire [9:0] amp_row, reset_row;
  wire slot_resets, slot_reads, slot_opens, amp_start, busy, cfg_err, done, four_tap, hold_free, step__val;
  wire [63:0] cycles;
  wire [24 + `LANES:0] step__msg;
  ReadoutSeq dut (.*);

  // The document
  wire [7:0] stride_mask = (8'd1 << decimation) - 8'd1;
  wire window_ok = row0 <= row1 && row1 <= (`ROWS - 1) / `TILE_ROWS && col0 <= col1
                   && col1 <= (`COLS - 1) / `TILE_COLS;
  function column_ok(input [1:0] row_in_tile, input [2:0] k);
    column_ok = k < `TILE_COLS && mask[type_at(`TILE_COLS * row_in_tile + k)] && `TILE_COLS * {4'b0, col0} + k < `COLS;
  endfunction
  function [5:0] columns_of(input [1:0] row_in_tile);
    integer i;
    for (i = 0; i < 6; i = i + 1) columns_of[i] = column_ok(row_in_tile, i);
  endfunction
  function [9:0] index(input [9:0] place);
    index = `TILE_ROWS * place[9:2] + place[1:0];
  endfunction
  function row_ok(input [9:0] place);
    row_ok = place[9:2] >= row0 && place[9:2] <= row1 && ((place[9:2] - row0) & stride_mask) == 0
             && place[1:0] < `TILE_ROWS && `TILE_ROWS * {2'b0, place[9:2]} + place[1:0] < `ROWS
             && columns_of(place[1:0]) != 0;
  endfunction
  wire [9:0] lead = mode == 3 ? 10'd0 : exposure;
  wire [1:0] r0 = 0, r1 = 1, r2 = 2, r3 = 3;   // names: Yosys takes a function of numbers for a constant
  wire [3:0] rows_of_tile = {columns_of(r3) != 0, columns_of(r2) != 0, columns_of(r1) != 0, columns_of(r0) != 0}
                            & ((1 << `TILE_ROWS) - 1);
  function [2:0] count(input [3:0] rows);
    count = {2'b0, rows[0]} + {2'b0, rows[1]} + {2'b0, rows[2]} + {2'b0, rows[3]};
  endfunction
  wire [2:0] rows_a_tile = count(rows_of_tile);
  function [10:0] nth(input [9:0] place);      // rows that are read before this one
    reg [10:0] tiles;
    begin
      tiles = (place[9:2] - row0) >> decimation;
      nth = (rows_a_tile[0] ? tiles : 11'd0) + (rows_a_tile[1] ? tiles << 1 : 11'd0)
            + (rows_a_tile[2] ? tiles << 2 : 11'd0) + {8'd0, count(rows_of_tile & ~(4'hF << place[1:0]))};
    end
  endfunction
  function more(input [9:0] place);            // a row is read behind this one
    reg [8:0] tile;
    integer i;
    begin
      tile = place[9:2] + (9'd1 << decimation);
      more = 0;
      for (i = 0; i < 4; i = i + 1)
        more = more || i > place[1:0] && row_ok({place[9:2], i[1:0]}) || !tile[8] && row_ok({tile[7:0], i[1:0]});
    end
  endfunction

  // Inside
  (* hierconn *) wire [7:0] \dut.rows.tile , \dut.ahead.tile ;
  (* hierconn *) wire [1:0] \dut.rows.in_tile , \dut.ahead.in_tile ;
  (* hierconn *) wire [9:0] \dut.wait_slots ;
  wire [9:0] amp_place = {\dut.rows.tile , \dut.rows.in_tile };
  wire [9:0] reset_place = {\dut.ahead.tile , \dut.ahead.in_tile };

  reg [10:0] slots;                       // of this frame that have begun, before this cycle
  wire [10:0] slot = amp_start ? slots : slots - 11'd1;
  wire [80:0] choice = {mode, mask, row0, row1, col0, col1, decimation, overlap, exposure, p_row};
  reg first = 1, was_reset, was_slot_resets, was_slot_reads;
  reg [9:0] was_reset_row;
  reg [80:0] was_choice;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_choice <= choice;
    was_reset_row <= reset_row; was_slot_resets <= slot_resets; was_slot_reads <= slot_reads;
    slots <= reset || !busy ? 0 : slots + amp_start;
  end

  always @* begin
    if (first) a_reset: assume (reset);
    else begin
      // RegFile locks the configuration while a frame runs
      a_config: assume (!busy || choice == was_choice);
      p_slot: assert (!busy || slot_reads == (slot >= lead) && slot_opens == (slot_resets && lead != 0));
      p_slot_stable: assert (was_reset || amp_start || {reset_row, slot_resets, slot_reads}
                             == {was_reset_row, was_slot_resets, was_slot_reads});
      p_lead: assert (!(amp_start && busy && slot_reads) || row_ok(amp_place) && amp_row == index(amp_place)
                      && nth(amp_place) + lead == slot);
      p_reset_row: assert (!(amp_start && busy && slot_resets) || row_ok(reset_place) && reset_row == index(reset_place)
                           && nth(reset_place) == slot);
      // No row is left when a slot resets none
      p_all: assert (!(busy && !slot_resets && row_ok(p_row)) || p_row <= reset_place);
      inv_rows: assert (amp_row == index(amp_place) && amp_place[1:0] < `TILE_ROWS
                        && reset_row == index(reset_place) && reset_place[1:0] < `TILE_ROWS);
      inv_window: assert (!busy || window_ok);
      inv_slots: assert (!busy || (slots != 0 || amp_start) && slot <= 2 * 1023 && slots <= 2 * 1023 + 1);
      inv_wait: assert (!busy || \dut.wait_slots == (slot < lead ? lead - slot : 11'd0));
      inv_read: assert (!busy || !slot_reads || row_ok(amp_place) && nth(amp_place) + lead == slot);
      inv_reset: assert (!busy || row_ok(reset_place) && (!slot_resets || nth(reset_place) == slot));
      inv_last_reset: assert (!busy || slot_resets || !more(reset_place));
      inv_first_slot: assert (!busy || slot != 0 || slot_resets);
    end
  end

  always @* if (!first && !reset) begin
    c_reset: cover (amp_start && slot_resets && !slot_reads && slot == 2);
    c_lead: cover (amp_start && slot_resets && slot_reads && lead == 2);
    c_read: cover (amp_start && !slot_resets && slot_reads && slot == 3);
    c_idle: cover (amp_start && !slot_resets && !slot_reads);
  end
endmodule
