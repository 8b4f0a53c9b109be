// Frames in the simulator: the chip, the analog front end and a host that plays SPI transfers
// and takes the byte stream. Everything is synchronous to `clk`, so that the same file runs clocked
// by main.cpp in Verilator and by clock.sv in Icarus.
//
//   +script=FILE   what the host does, bytes:  01          wait for the end of a frame
//                                              02 n b...   an SPI transfer of n bytes
//                                              03          the next exposure of +samples
//                                              04          a line of activity; all that was written can be read
//                                              00          stop
//   +miso=FILE     every byte that came back over SPI
//   +stream=FILE   every byte that left the chip
//   +activity=FILE how many cycles each pin of the front end was high, and in all: since the line before, at 04 and 00;
//                  how many each row integrated
//   +stall=P       the link is not ready in P of 256 cycles, pseudo-random
//   +samples=FILE, +taps=N, +converter=FILE   see pixels/afe.sv
`default_nettype none

module Bench #(
    parameter int ROWS = 384, COLS = 384, LANES = 8, TILE_ROWS = 4, TILE_COLS = 6
) (
    input  wire        clk,
    input  wire        reset,
    output reg         done,
    output wire [9:0]  row,
    output wire [31:0] cycles         // since the reset or the last line of activity
);
  localparam int HALF_BIT = 8;          // cycles of half an SPI clock

  // ---- chip and front end ----
  reg sclk, csn, mosi;
  wire miso;
  wire [7:0] link_data;
  wire link_val, frame_sync;
  reg  link_rdy;
  wire pixel_reset, integrate, expose, cm_reset, read, busy;
  wire [9:0] amp_row, reset_row;
  wire [8*LANES-1:0] dac;
  wire [LANES-1:0] comparator, en;
  wire hold, wake, convert, unsigned_;
  wire [1:0] mode, sub;
  wire [7:0] group;
  wire [2:0] k;
  wire [`BALANCE_BITS-1:0] balance;

  AspChip chip (
      .clk(clk), .reset(reset), .sclk(sclk), .csn(csn), .mosi(mosi), .miso(miso),
      .link_data(link_data), .link_val(link_val), .link_rdy(link_rdy), .frame_sync(frame_sync),
      .dac(dac), .hold(hold), .wake(wake), .convert(convert), .unsigned_(unsigned_), .mode(mode), .row(row), .group(group), .k(k), .sub(sub),
      .en(en), .balance(balance), .comparator(comparator),
      .pixel_reset(pixel_reset), .integrate(integrate), .expose(expose), .cm_reset(cm_reset), .read(read),
      .amp_row(amp_row), .reset_row(reset_row), .busy(busy),
      /* verilator lint_off PINCONNECTEMPTY */
      .shutter(), .ref_ctl(), .sample(), .tap()
      /* verilator lint_on PINCONNECTEMPTY */
  );

  Afe #(.ROWS(ROWS), .COLS(COLS), .LANES(LANES), .TILE_ROWS(TILE_ROWS), .TILE_COLS(TILE_COLS)) afe (
      .clk(clk), .mode(mode), .row(row), .group(group), .k(k), .sub(sub), .en(en), .balance(balance),
      .hold(hold), .dac(dac), .unsigned_(unsigned_), .comparator(comparator)
  );

  // ---- files ----
  integer script, miso_file, stream_file, activity;
  integer stall;
  reg [8*512-1:0] name;
  initial begin
    if (!$value$plusargs("script=%s", name)) $fatal(1, "+script=FILE is missing");
    script = $fopen(name, "rb");
    if (script == 0) $fatal(1, "+script: cannot be read");
    if (!$value$plusargs("miso=%s", name)) $fatal(1, "+miso=FILE is missing");
    miso_file = $fopen(name, "wb");
    if (miso_file == 0) $fatal(1, "+miso: cannot be written");
    if (!$value$plusargs("stream=%s", name)) $fatal(1, "+stream=FILE is missing");
    stream_file = $fopen(name, "wb");
    if (stream_file == 0) $fatal(1, "+stream: cannot be written");
    activity = 0;
    if ($value$plusargs("activity=%s", name)) begin
      activity = $fopen(name, "w");
      if (activity == 0) $fatal(1, "+activity: cannot be written");
    end
    if (!$value$plusargs("stall=%d", stall)) stall = 0;
  end

  // ---- activity ----
  reg [31:0] n_cycles, n_busy, n_reset, n_integrate, n_cm, n_read, n_dark, n_hold, n_bytes;
  reg  reported;
  assign cycles = n_cycles;
  always @(posedge clk) begin
    n_cycles <= reset || reported ? 0 : n_cycles + 1;
    if (reset || reported) begin
      n_busy <= 0; n_reset <= 0; n_integrate <= 0; n_cm <= 0; n_read <= 0; n_dark <= 0; n_hold <= 0; n_bytes <= 0;
    end else if (busy) begin
      n_busy <= n_busy + 1;
      if (pixel_reset) n_reset <= n_reset + 1;
      else if (integrate) n_integrate <= n_integrate + 1;
      else if (cm_reset) n_cm <= n_cm + 1;
      else if (read) n_read <= n_read + 1;
      else n_dark <= n_dark + 1;
      if (hold) n_hold <= n_hold + 1;
      if (link_val & link_rdy) n_bytes <= n_bytes + 1;
    end
  end

  // ---- integration of every row, as the row driver sees the pins (pixels/README.md) ----
  reg open[0:ROWS-1];
  reg [31:0] opened[0:ROWS-1], integrated[0:ROWS-1];
  reg [31:0] since, sum;
  reg was_integrate;
  integer at;
  initial for (at = 0; at < ROWS; at = at + 1) begin
    open[at] = 1'b0;
    integrated[at] = 0;
  end
  always @(posedge clk) begin
    was_integrate <= integrate & ~reset;
    if (~reset & (pixel_reset | expose | read | (integrate ^ was_integrate))) begin
      if (pixel_reset) begin
        open[reset_row] <= 1'b0;
        if (reset_row == amp_row) sum <= 0;
      end
      if (expose) begin
        open[reset_row] <= 1'b1;
        opened[reset_row] <= n_cycles;
      end
      if (integrate & ~was_integrate) begin
        since <= open[amp_row] ? opened[amp_row] : n_cycles;
        if (open[amp_row]) sum <= 0;
        open[amp_row] <= 1'b0;
      end
      if (~integrate & was_integrate) sum <= sum + n_cycles - since;
      if (read) integrated[amp_row] <= sum;
    end
  end

  task automatic write_activity;
    if (activity != 0) begin
      $fwrite(activity, "{\"cycles\": %0d, \"busy\": %0d, \"pixel_reset\": %0d, \"integrate\": %0d, \"cm_reset\": %0d, ",
              n_cycles, n_busy, n_reset, n_integrate, n_cm);
      $fwrite(activity, "\"read\": %0d, \"waiting\": %0d, \"steps\": %0d, \"bytes\": %0d, \"integrated\": [",
              n_read, n_dark, n_hold, n_bytes);
      for (at = 0; at < ROWS; at = at + 1) $fwrite(activity, "%0d%s", integrated[at], at == ROWS - 1 ? "]}\n" : ", ");
      $fflush(activity);
    end
  endtask

  // ---- state of the host, below, which waits at the link for the frame's end ----
  localparam [1:0] FETCH = 0, SHIFT = 1, WAIT = 2, GAP = 3;
  reg [1:0] state;
  reg [7:0] left, divider;
  reg [7:0] out, in;
  reg [3:0] bits;
  integer code;
  wire waiting = state == WAIT;

  // ---- link ----
  reg [31:0] lfsr;
  reg was_sync, ended;
  always @(posedge clk) begin
    if (reset) begin
      lfsr <= 32'h1;
      link_rdy <= 1'b0;
      was_sync <= 1'b0;
      ended <= 1'b0;
    end else begin
      lfsr <= {lfsr[30:0], lfsr[31] ^ lfsr[21] ^ lfsr[1] ^ lfsr[0]};
      link_rdy <= {24'b0, lfsr[7:0]} >= stall;
      was_sync <= frame_sync;
      ended <= waiting & (ended | (was_sync & ~frame_sync));
      if (link_val & link_rdy) $fwrite(stream_file, "%c", link_data);
    end
  end

  // ---- host ----
  always @(posedge clk) begin
    if (reset) begin
      state <= FETCH;
      sclk <= 1'b0;
      csn <= 1'b1;
      mosi <= 1'b0;
      done <= 1'b0;
      reported <= 1'b0;
      left <= 8'd0;
      divider <= 8'd0;
      bits <= 4'd0;
      out <= 8'd0;
      in <= 8'd0;
    end else case (state)
      FETCH: if (reported) reported <= 1'b0;
      else if (!done) begin
        code = $fgetc(script);
        if (code == 1) state <= WAIT;
        else if (code == 3) afe.next_exposure;
        else if (code == 4) begin
          $fflush(stream_file);
          $fflush(miso_file);
          write_activity;
          reported <= 1'b1;
        end
        else if (code == 2) begin
          code = $fgetc(script);
          left <= code[7:0] - 8'd1;
          code = $fgetc(script);
          out <= {code[6:0], 1'b0};
          mosi <= code[7];
          csn <= 1'b0;
          bits <= 4'd0;
          divider <= 8'd0;
          state <= SHIFT;
        end else begin
          done <= 1'b1;
          $fclose(stream_file);
          $fclose(miso_file);
          write_activity;
        end
      end
      WAIT: if (ended) state <= FETCH;
      SHIFT: begin      // mode 0: the slave samples on the rising edge, both shift on the falling
        divider <= divider == HALF_BIT - 1 ? 8'd0 : divider + 8'd1;
        if (divider == HALF_BIT - 1) begin
          sclk <= ~sclk;
          if (!sclk) begin
            in <= {in[6:0], miso};
            bits <= bits + 4'd1;
          end else if (bits == 4'd8) begin
            $fwrite(miso_file, "%c", in);
            bits <= 4'd0;
            if (left == 8'd0) state <= GAP;
            else begin
              code = $fgetc(script);
              left <= left - 8'd1;
              out <= {code[6:0], 1'b0};
              mosi <= code[7];
            end
          end else begin
            mosi <= out[7];
            out <= {out[6:0], 1'b0};
          end
        end
      end
      GAP: begin
        divider <= divider + 8'd1;
        csn <= divider >= HALF_BIT;
        if (divider == 4 * HALF_BIT) state <= FETCH;
      end
    endcase
  end
endmodule
`default_nettype wire
