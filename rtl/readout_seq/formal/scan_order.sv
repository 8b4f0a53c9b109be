// The rows and columns that docs/chip.md (Scan order) requires, of the wrapper's inputs.
`define SCAN_ORDER \
  wire [7:0] stride_mask = (8'd1 << decimation) - 8'd1; \
  wire window_ok = row0 <= row1 && row1 <= (`ROWS - 1) / `TILE_ROWS && col0 <= col1 \
                   && col1 <= (`COLS - 1) / `TILE_COLS; \
  function column_ok(input [1:0] row_in_tile, input [2:0] k); \
    column_ok = k < `TILE_COLS && mask[type_at(`TILE_COLS * row_in_tile + k)] && `TILE_COLS * {4'b0, col0} + k < `COLS; \
  endfunction \
  function [5:0] columns_of(input [1:0] row_in_tile); \
    integer i; \
    for (i = 0; i < 6; i = i + 1) columns_of[i] = column_ok(row_in_tile, i); \
  endfunction \
  function [9:0] index(input [9:0] place); \
    index = `TILE_ROWS * place[9:2] + place[1:0]; \
  endfunction \
  function row_ok(input [9:0] place); \
    row_ok = place[9:2] >= row0 && place[9:2] <= row1 && ((place[9:2] - row0) & stride_mask) == 0 \
             && place[1:0] < `TILE_ROWS && `TILE_ROWS * {2'b0, place[9:2]} + place[1:0] < `ROWS \
             && columns_of(place[1:0]) != 0; \
  endfunction \
  wire [9:0] lead = mode == 3 ? 10'd0 : exposure;
