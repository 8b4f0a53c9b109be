// Assumptions about PhasePath's neighbours: a frame begins with FRAME and ends with END; `on` and `noise_floor` are
// constant from FRAME until END has left (the register file refuses writes while the chip is busy); a step is four taps
// of as many samples each, at most one a lane, and no other message is within it.

module PhasePathPromises #(parameter LANES = 8) (
  input clk, input reset, input on, input [7:0] noise_floor, input recv__val, input recv__rdy,
  input [11:0] recv__msg, input send__val, input send__rdy, input [11:0] send__msg, output promised
);
  localparam FRAME = 0, SAMPLE = 2, END = 3;
  wire [1:0] kind = recv__msg[11:10];
  wire sample = kind == SAMPLE, last = recv__msg[9], taken = recv__val & recv__rdy;
  reg [1:0] tap;
  reg [2:0] index, samples;         // number of the next sample in its tap; of the last one in tap 0
  reg between = 1, was_on, kept = 1;
  reg [7:0] was_floor;
  wire shape = sample ? (tap == 0 ? index < LANES - 1 || last : last == (index == samples)) : tap == 0 && index == 0;
  assign promised = kept & (between ? ~recv__val | kind == FRAME : on == was_on & noise_floor == was_floor)
                    & (~(on & recv__val) | shape);
  always @(posedge clk) begin
    kept <= promised; was_on <= on; was_floor <= noise_floor;
    if (reset) begin
      between <= 1; tap <= 0; index <= 0;
    end else begin
      if (taken) between <= 0;
      else if (send__val & send__rdy & send__msg[11:10] == END) between <= 1;
      if (on & taken & sample) begin
        index <= last ? 0 : index + 1;
        if (last) tap <= tap + 1;
        if (last && tap == 0) samples <= index;
      end
    end
  end
endmodule
