// Bytes from a microcontroller that knows nothing of this clock: written to one of 16 addresses, which counts up.
//
// strobe may rise when data and is_address have been stable for as long as the host likes, and must stay high, with
// both unchanged, for four cycles of clk; low again for four. is_address: data[3:0] is the address of the next byte.
// write is high for one cycle a byte; address and value are then those of the byte.

`default_nettype none

module tt_bytes
(
  input  wire       clk,
  input  wire       reset,
  input  wire [7:0] data,
  input  wire       strobe,
  input  wire       is_address,
  output reg  [3:0] address,
  output wire       write,
  output wire [7:0] value
);
  reg [2:0] seen;       // two flip-flops against metastability, one to find the edge

  wire rise = seen[1] & ~seen[2];
  assign write = rise & ~is_address;
  assign value = data;

  always @(posedge clk) begin
    if (reset) begin
      seen <= 3'b0;
      address <= 4'b0;
    end else begin
      seen <= {seen[1:0], strobe};
      if (rise) address <= is_address ? data[3:0] : address + 4'd1;
    end
  end
endmodule

`default_nettype wire
