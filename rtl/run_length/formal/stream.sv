// RunLength puts the bytes of docs/stream.md into its queue, frame after frame of any length, with any stalls: header,
// each segment's payload from the packer and its mark, trailer. `tokens` and `payload` prove the packer, `byte_queue` the
// queue; their assumptions about the control are asserted here (p_packer, p_queue).

module StreamProof (
  input clk, input reset, input [11:0] recv__msg, input recv__val, input send__rdy,
  input [2:0] mode, input phase, input [7:0] row0, input [7:0] row1, input [7:0] col0, input [7:0] col1,
  input [1:0] decimation, input [23:0] mask, input [6:0] threshold, input [15:0] frame_number,
  input [1:0] resync, input [9:0] exposure, input [7:0] n_cm, input [15:0] t_int, input [7:0] calibration,
  input [31:0] made, input [31:0] left_out
);
  wire recv__rdy, send__val, frame_sync;
  wire [2:0] state;
  wire [7:0] send__msg;
  RunLength dut (.*);
  localparam FRAME = 0, ROW = 1, SAMPLE = 2, END = 3;
  localparam [47:0] CHIP = ((`LANES << 4 | `TILE_ROWS) << 4 | `TILE_COLS) * 48'd4294967296 + `ROWS * 65536 + `COLS;
  localparam IDLE = 0, HEADER = 1, ROWS = 2, MARK = 3, TRAILER = 4, DRAIN = 5;

  (* hierconn *) wire \dut.queue.put ;
  (* hierconn *) wire [7:0] \dut.queue.octet ;
  (* hierconn *) wire [1:0] \dut.queue.count ;
  (* hierconn *) wire \dut.queue.ready ;
  (* hierconn *) wire \dut.packer.push ;
  (* hierconn *) wire \dut.packer.flush ;
  (* hierconn *) wire \dut.packer.restart ;
  (* hierconn *) wire \dut.packer.ready ;
  (* hierconn *) wire \dut.packer.val ;
  (* hierconn *) wire \dut.packer.coded ;
  (* hierconn *) wire \dut.packer.signs ;
  (* hierconn *) wire [7:0] \dut.packer.octet ;
  (* hierconn *) wire [7:0] \dut.packer.code ;
  (* hierconn *) wire [6:0] \dut.packer.threshold ;
  (* hierconn *) wire [5:0] \dut.packer.count ;
  (* hierconn *) wire [10:0] \dut.packer.coder.run ;
  (* hierconn *) wire [2:0] \dut.control.state ;
  (* hierconn *) wire [4:0] \dut.control.index ;
  (* hierconn *) wire \dut.control.open ;
  (* hierconn *) wire [7:0] \dut.control.size ;
  (* hierconn *) wire \dut.control.ending ;
  (* hierconn *) wire [9:0] \dut.row ;
  (* hierconn *) wire [9:0] \dut.following ;
  (* hierconn *) wire [15:0] \dut.crc16.crc ;
  (* hierconn *) wire [31:0] \dut.crc32.state ;
  wire put = \dut.queue.put ;
  wire [7:0] octet = \dut.queue.octet ;
  wire due = \dut.packer.val ;
  wire push = \dut.packer.push , flush = \dut.packer.flush , restart = \dut.packer.restart ;

  // The document: CRC-16/IBM-3740 and CRC-32 of IEEE 802.3, after one more byte
  function [15:0] crc16(input [15:0] crc, input [7:0] octet);
    integer i;
    begin
      crc16 = crc ^ {octet, 8'b0};
      for (i = 0; i < 8; i = i + 1) crc16 = crc16[15] ? {crc16[14:0], 1'b0} ^ 16'h1021 : {crc16[14:0], 1'b0};
    end
  endfunction
  function [31:0] crc32(input [31:0] crc, input [7:0] octet);
    integer i;
    begin
      crc32 = crc ^ octet;
      for (i = 0; i < 8; i = i + 1) crc32 = crc32[0] ? crc32 >> 1 ^ 32'hEDB88320 : crc32 >> 1;
    end
  endfunction

  // The frame: the current part, the byte in it, the checks so far
  reg [2:0] part;
  reg [4:0] n;
  reg open, ending;
  reg [9:0] row, following;
  reg [10:0] size;  // bytes of the segment's payload that are in the queue, up to 1024
  wire [10:0] grown = size + (put && payload && size < 1024);
  wire closes = grown >= 64 * resync;
  reg [15:0] short_crc;
  reg [31:0] long_crc;
  wire taken = recv__val && recv__rdy;
  wire [1:0] kind = recv__msg[11:10];
  wire in_rows = taken && part == ROWS;
  wire [223:0] header = {"TLBT", 8'd3, resync, decimation, mode == 3'd4, phase, mode[1:0], 1'b0, threshold, CHIP, row0, row1, col0,
                         col1, mask, frame_number, 6'b0, exposure, n_cm, t_int, calibration};
  wire [31:0] long_value = ~long_crc;
  wire [255:0] header_bytes = {header, long_value};
  wire [111:0] trailer_bytes = {made, left_out, short_crc ^ 16'hFFFF, long_value};
  wire [15:0] mark = short_crc ^ {6'b0, row};
  wire payload = due && (part == ROWS || part == MARK);
  wire [7:0] wanted = payload ? \dut.packer.octet
                      : part == HEADER ? header_bytes[8 * (31 - n) +: 8]
                      : part == MARK ? (n == 0 ? mark[15:8] : mark[7:0]) : trailer_bytes[8 * (13 - n) +: 8];
  always @(posedge clk) begin
    if (reset) begin
      part <= IDLE; n <= 0; open <= 0; ending <= 0;
    end else begin
      if (taken && part == IDLE && kind == FRAME) begin
        part <= HEADER; long_crc <= 32'hFFFFFFFF; ending <= 0;
      end
      if (in_rows && kind == ROW) begin
        open <= 1;
        if (!open) begin
          row <= recv__msg[9:0]; short_crc <= 16'hFFFF; size <= 0;
        end else if (closes) begin
          part <= MARK; following <= recv__msg[9:0];
        end
      end
      if (in_rows && kind == END) begin
        open <= 0; ending <= 1; part <= open ? MARK : TRAILER;
        if (!open) short_crc <= 16'hFFFF;
      end
      if (open && !(in_rows && kind == ROW && !open)) size <= grown;
      if (put) begin
        // The header's CRC-32 and the last one are in no check; the marks are not in the CRC-16
        if (!(part == HEADER && n >= 28) && !(part == TRAILER && n >= 10)) long_crc <= crc32(long_crc, octet);
        if (payload || part == TRAILER && n < 8) short_crc <= crc16(short_crc, octet);
        if (!payload) begin
          n <= n + 1;
          if (part == HEADER && n == 31) begin
            part <= ROWS; n <= 0;
          end
          if (part == MARK && n == 1) begin
            part <= ending ? TRAILER : ROWS; n <= 0; short_crc <= 16'hFFFF; row <= following; size <= 0;
          end
          if (part == TRAILER && n == 13) begin
            part <= DRAIN; n <= 0;
          end
        end
      end
      if (part == DRAIN && (\dut.queue.count == 0 || \dut.queue.count == 1 && send__rdy)) part <= IDLE;
    end
  end

  reg first = 1, was_reset, was_val, was_rdy;
  reg [7:0] was_msg;
  reg [4:0] quiet;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= send__val; was_rdy <= send__rdy; was_msg <= send__msg;
    quiet <= reset || put || recv__rdy || !send__rdy || part == DRAIN ? 0 : quiet + !(&quiet);
  end

  always @* begin
    if (first) a_reset: assume (reset);
    if (!first && !was_reset) begin
      p_octet: assert (!put || (part == HEADER || part == TRAILER || part == MARK || payload) && octet == wanted);
      p_whole: assert (!(put && part == MARK && !payload) || \dut.packer.count == 0);
      p_push: assert (push == (in_rows && open && kind == SAMPLE) && flush == (in_rows && open && (kind == ROW
              && closes || kind == END)));
      p_restart: assert (restart == (in_rows && !open && (kind == ROW || kind == END)
              || put && !payload && part == MARK && n == 1));
      p_code: assert (\dut.packer.code == recv__msg[7:0] && \dut.packer.threshold == threshold
                      && \dut.packer.coded == (mode[1:0] == 0) && \dut.packer.signs == (mode == 4));
      p_sync_low: assert (!frame_sync || part != IDLE);
      p_time: assert (quiet < 4);
    end
    if (!first) begin
      p_packer: assert (push + flush <= 1 && (\dut.packer.ready || !push && !flush));
      p_queue: assert (!put || \dut.queue.ready );
      p_sync: assert (!send__val || frame_sync);
      p_quiet: assert (!was_reset || !frame_sync);
      p_stable: assert (was_reset || !was_val || was_rdy || send__val && send__msg == was_msg);
      inv_part: assert (\dut.control.state == part && part <= DRAIN && \dut.control.index == n
              && \dut.control.open == open);
      inv_index: assert (part == HEADER ? n < 32 : part == MARK ? n < 2 : part == TRAILER ? n < 14 : n == 0);
      inv_ending: assert (part != MARK && part != TRAILER || \dut.control.ending == ending && ending == !open);
      inv_rows: assert (part != HEADER && part != ROWS || !\dut.control.ending && !ending);
      inv_trailing: assert (part != TRAILER || ending && !open);
      inv_open: assert (part == ROWS || part == MARK || !open);
      inv_row: assert (!(open || part == MARK) || \dut.row == row);
      inv_following: assert (part != MARK || ending || \dut.following == following);
      inv_size: assert (!(part == ROWS && open) || \dut.control.size == (size < 192 ? size : 192) && size <= 1024);
      inv_short: assert (!(open || part == MARK || part == TRAILER) || \dut.crc16.crc == short_crc);
      inv_long: assert (part == IDLE || \dut.crc32.state == long_crc);
      inv_packer: assert (part == ROWS && open || part == MARK || \dut.packer.count == 0);
      inv_flushed: assert (part != MARK || \dut.packer.count [2:0] == 0);
      inv_marked: assert (!(part == MARK && n == 1) || \dut.packer.count == 0);
      inv_queue: assert (\dut.queue.count <= 2 && (part != IDLE && !(part == HEADER && n == 0)
              || \dut.queue.count == 0));
      inv_sync: assert (frame_sync == !(part == IDLE || part == HEADER && n == 0));
    end
  end

  always @* if (!first && !was_reset) begin
    c_header: cover (put && part == HEADER && n == 31);
    c_row: cover (put && payload);
    c_frame: cover (part == DRAIN && !open && send__val);
  end
endmodule
