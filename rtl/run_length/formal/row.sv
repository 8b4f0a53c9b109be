// RunLength and the model decoder: a frame of one short row is decoded to its samples, for all codes, thresholds and
// row indices. The row has `SAMPLES samples; the decoder keeps the bytes after the header and decodes a token a cycle.
//
// Messages and bytes do not wait here: the unbounded proofs (payload, byte_queue, stream) cover stalls.

module RowProof (input clk);
  (* anyconst *) wire [8 * `SAMPLES - 1:0] codes;
  (* anyconst *) wire [6:0] threshold;
  (* anyconst *) wire [9:0] index;
  reg first = 1;  // one reset, to begin with: the proof is bounded from there
  always @(posedge clk) first <= 0;
  wire reset = first;
  localparam FRAME = 0, ROW = 1, SAMPLE = 2, END = 3, HEADER = 32, TAKEN = 3 * `SAMPLES + 4;

  // The messages in order: FRAME, ROW, the samples, END
  reg [3:0] turn = 0;
  wire recv__rdy, send__val, frame_sync;
  wire [7:0] send__msg;
  wire recv__val = turn < `SAMPLES + 3;
  wire [3:0] number = turn - 2;
  wire [11:0] recv__msg = turn == 0 ? {2'd0, 10'd0} : turn == 1 ? {2'd1, index}
                          : turn == `SAMPLES + 2 ? {2'd3, 10'd0} : {2'd2, 2'd0, codes[8 * number +: 8]};
  RunLength dut (.clk(clk), .reset(reset), .recv__val(recv__val), .recv__rdy(recv__rdy), .recv__msg(recv__msg),
                 .send__val(send__val), .send__rdy(1'b1), .send__msg(send__msg), .frame_sync(frame_sync),
                 .threshold(threshold), .mode(3'd0), .phase(1'b0), .row0(8'd0), .row1(8'd0), .col0(8'd0), .col1(8'd0),
                 .decimation(2'd0), .mask(24'd1), .frame_number(16'd0), .resync(2'd0), .exposure(10'd0), .n_cm(8'd0),
                 .t_int(16'd0), .calibration(8'd0), .made(32'd0), .left_out(32'd0));

  // The bytes after the header, the first on top
  reg [5:0] came = 0;
  reg [8 * TAKEN - 1:0] bytes;
  wire [5:0] place = came - HEADER;
  wire kept = send__val && came >= HEADER && place < TAKEN;
  always @(posedge clk) begin
    if (reset) begin
      turn <= 0; came <= 0;
    end else begin
      turn <= turn + (recv__val && recv__rdy);
      came <= came + (send__val && came != 63);
      if (kept) bytes[8 * (TAKEN - 1 - place) +: 8] <= send__msg;
    end
  end

  // The decoder: `at` bits are read, `have` samples are known
  reg [7:0] at;
  reg [3:0] have;
  reg [5:0] k;
  reg [2:0] r2;
  reg [7:0] credit;
  wire [8 * TAKEN - 1:0] rest = bytes << at;
  wire literal, zeros_only, valid;
  wire [11:0] zeros;
  wire [7:0] value, credit_next;
  wire [4:0] length;
  wire [5:0] k_next;
  wire [2:0] r2_next;
  TokenDecoder decoder (.window(rest[8 * TAKEN - 1 -: 27]), .k(k), .r2(r2), .credit(credit), .threshold(threshold), .signs(1'b0),
                        .literal(literal), .zeros_only(zeros_only), .zeros(zeros), .value(value), .length(length),
                        .k_next(k_next), .r2_next(r2_next), .credit_next(credit_next), .valid(valid));
  wire decodes = have < `SAMPLES && came >= HEADER + 4 && 8 * (came - HEADER) >= at + 27;
  wire [12:0] reaches = have + zeros + !zeros_only;
  always @(posedge clk) begin
    if (reset) begin
      at <= 0; have <= 0; k <= threshold < 4 ? 8 : 16; r2 <= 2; credit <= 128;
    end else if (decodes) begin
      at <= at + length; have <= reaches > `SAMPLES ? `SAMPLES : reaches[3:0];
      k <= k_next; r2 <= r2_next; credit <= credit_next;
    end
  end

  // The expected samples: a code inside the threshold is a zero
  reg [8 * `SAMPLES - 1:0] sent;
  integer i;
  reg signed [8:0] code;
  always @* for (i = 0; i < `SAMPLES; i = i + 1) begin
    code = {codes[8 * i + 7], codes[8 * i +: 8]};
    sent[8 * i +: 8] = (code < 0 ? -code : code) < (threshold == 0 ? 9'sd1 : {2'b0, threshold}) ? 8'd0 : code[7:0];
  end
  reg zeros_there;
  always @* begin
    zeros_there = 1;
    for (i = 0; i < `SAMPLES; i = i + 1)
      if (i >= have && i < have + zeros && sent[8 * i +: 8] != 0) zeros_there = 0;
  end
  wire [3:0] of_value = have + zeros;

  // The mark: CRC-16 of the payload's bytes, a byte a cycle, xor the index
  wire [4:0] payload = (at + 7) >> 3;
  reg [4:0] checked;
  reg [15:0] crc, step;
  wire [8 * TAKEN - 1:0] unchecked = bytes << 8 * checked;
  wire checks = have == `SAMPLES && checked < payload;
  wire done = have == `SAMPLES && checked == payload && came >= HEADER + payload + 2;
  always @* begin
    step = crc ^ {unchecked[8 * TAKEN - 1 -: 8], 8'b0};
    for (i = 0; i < 8; i = i + 1) step = step[15] ? {step[14:0], 1'b0} ^ 16'h1021 : {step[14:0], 1'b0};
  end
  always @(posedge clk) begin
    if (reset) begin
      checked <= 0; crc <= 16'hFFFF;
    end else if (checks) begin
      checked <= checked + 1; crc <= step;
    end
  end
  wire [7:0] padding = bytes >> (8 * (TAKEN - payload)) ;

  always @* begin
    if (!first) begin
      p_valid: assert (!decodes || valid);
      p_zeros: assert (!decodes || zeros_there);
      p_value: assert (!(decodes && !zeros_only) || of_value < `SAMPLES && value == sent[8 * of_value +: 8]);
      p_mark: assert (!done || unchecked[8 * TAKEN - 1 -: 16] == crc ^ index);
      c_decoded: cover (done && have == `SAMPLES);
      c_zeros: cover (decodes && zeros_only);
      c_end: cover (came == HEADER + payload + 16 && !frame_sync && done);
    end
  end
endmodule
