// A minimal controller in place of the chip: converts every position of the frame on all lanes at once and prints
// row, column, sub, code and converted, one sample a line. For Icarus it makes its own clock.
//   +mode=N +threshold=T +trim=FILE (24 values, $readmemh)
`default_nettype none
module Lanes #(
    parameter int ROWS = 9, COLS = 20, LANES = 2
) (
    input  wire clk,
    output reg  done
);
  integer mode, threshold, row, group, k, sub, step, l, col, code;
  reg [9:0] trim[0:23];
  reg [8*512-1:0] name;
  reg hold;
  reg [LANES-1:0] en, above, zero;
  reg [8*LANES-1:0] dac, kept;
  wire [LANES-1:0] comparator;
  wire unsigned_ = mode != 0;
  wire window = mode == 0 && threshold != 0;
  localparam int GROUPS = (COLS + 6 * LANES - 1) / (6 * LANES);

  Afe #(.ROWS(ROWS), .COLS(COLS), .LANES(LANES)) afe (
      .clk(clk), .mode(mode[1:0]), .row(row[9:0]), .group(group[7:0]), .k(k[2:0]), .sub(sub[1:0]), .en(en),
      .balance(trim[(row % 4) * 6 + k]), .hold(hold), .dac(dac), .unsigned_(unsigned_), .comparator(comparator));

  initial begin
    done = 0; hold = 0; row = 0; group = 0; k = 0; sub = 0; step = 0; dac = 0; en = 0;
    if (!$value$plusargs("mode=%d", mode) || !$value$plusargs("threshold=%d", threshold)
        || !$value$plusargs("trim=%s", name)) $fatal(1, "+mode, +threshold and +trim");
    $readmemh(name, trim);
  end

  // step 0: hold; 1, 2: window; 3..10: bits 7..0
  always @(posedge clk) if (!done) begin
    if (step == 0 && !hold) begin
      for (l = 0; l < LANES; l = l + 1) en[l] <= (LANES * group + l) * 6 + k < COLS;
      hold <= 1;
    end else if (step == 0) begin
      hold <= 0;
      for (l = 0; l < LANES; l = l + 1) dac[8*l+:8] <= window ? 128 + threshold : 8'h80;
      zero <= 0;
      kept = 0;
      step <= window ? 1 : 3;
    end else if (step == 1) begin
      above <= comparator;
      for (l = 0; l < LANES; l = l + 1) dac[8*l+:8] <= 129 - threshold;
      step <= 2;
    end else if (step == 2) begin
      zero <= ~above & comparator;
      for (l = 0; l < LANES; l = l + 1) dac[8*l+:8] <= 8'h80;
      step <= 3;
    end else begin
      for (l = 0; l < LANES; l = l + 1) begin
        if (comparator[l]) kept[8*l+:8] = dac[8*l+:8];
        dac[8*l+:8] <= kept[8*l+:8] | (8'h80 >> (step - 2));
      end
      step <= step + 1;
      if (step == 10) begin
        for (l = 0; l < LANES; l = l + 1) begin
          col = (LANES * group + l) * 6 + k;
          code = kept[8*l+:8];
          if (!unsigned_) code = code - 128;
          if (window && code > -threshold && code < threshold) code = 0;
          if (zero[l]) code = 0;
          if (en[l]) $display("%0d %0d %0d %0d %0d", row, col, sub, code, !zero[l]);
        end
        step <= 0;
        sub <= sub + 1;
        if (sub == (mode == 3 ? 3 : mode == 2 ? 1 : 0)) begin
          sub <= 0;
          group <= group + 1;
          if (group == GROUPS - 1) begin
            group <= 0;
            k <= k + 1;
            if (k == 5) begin
              k <= 0;
              row <= row + 1;
              if (row == ROWS - 1) done <= 1;
            end
          end
        end
      end
    end
  end
endmodule

`ifndef VERILATOR
module Clock;
  reg clk = 0;
  wire done;
  Lanes lanes (.clk(clk), .done(done));
  always #5 clk = ~clk;
  always @(posedge clk) if (done) $finish;
endmodule
`endif
`default_nettype wire
