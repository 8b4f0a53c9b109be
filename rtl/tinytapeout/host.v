// A microcontroller at a Tiny Tapeout project's pins, with a clock of its own. Its program, in hexadecimal words:
// 0xx write the byte xx, 1xx write the address xx, 2xx set uio_in[7:2] to xx, 300 wait for uio_out[7], 400 show the
// outputs, 5xx show them in xx00 cycles to come as well, 600 end.

`timescale 1ns / 1ps
`default_nettype none

module host;
  reg clk = 0, rst_n = 0;
  reg [7:0] ui_in = 0, uio_in = 0;
  wire [7:0] uo_out, uio_out, uio_oe;
  reg [11:0] words [0:65535];
  reg [8*256-1:0] file;
  integer at, left = 0, waited;

  `TOP dut(.ui_in(ui_in), .uo_out(uo_out), .uio_in(uio_in), .uio_out(uio_out), .uio_oe(uio_oe), .ena(1'b1), .clk(clk),
           .rst_n(rst_n));

  always #10 clk = ~clk;

  always @(negedge clk) if (left > 0) begin
    left = left - 1;
    $display("%b %b", uio_out, uo_out);
  end

  task send(input is_address, input [7:0] data);
    begin
      ui_in = data;
      uio_in[1] = is_address;
      #7.3 uio_in[0] = 1;
      #93.1 uio_in[0] = 0;
      #92.7;
    end
  endtask

  initial begin
    if (!$value$plusargs("program=%s", file)) $finish;
    $readmemh(file, words);
    #205.05 rst_n = 1;  // all other delays are multiples of 0.1: never at an edge of clk, which would be a race
    #100;
    for (at = 0; words[at] !== 12'h600; at = at + 1) case (words[at][11:8])
      4'h0: send(0, words[at][7:0]);
      4'h1: send(1, words[at][7:0]);
      4'h2: uio_in[7:2] = words[at][5:0];
      4'h3: begin
        waited = 0;
        while (uio_out[7] !== 1 && waited < 100000) begin
          #13.7 waited = waited + 1;
        end
        if (uio_out[7] !== 1) $display("timeout");
      end
      4'h4: $display("%b %b", uio_out, uo_out);
      default: left = 256 * words[at][7:0];
    endcase
    wait (left == 0);
    $display("enabled %b", uio_oe);
    $finish;
  end
endmodule
