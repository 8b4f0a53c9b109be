// RegFile from its pins: SPI transfers write the bits that they address, and no other bit changes.
//
// `bit_of` is any bit of the configuration, fixed; `bit_address`, `bit_place`, `bit_writable` and `bit_reset` come
// from the register map (verif/formal/tables.py). Bytes are assembled here from the pins, two flip-flops later (README,
// oversampled SPI), for any behaviour of the pins: transfers that are cut short too.

module RegFileProof (
  input clk, input reset, input sclk, input csn, input mosi, input [3:0] status, input loop__rdy,
  input [63:0] cycles, input [63:0] conversions_made, input [63:0] conversions_left_out
);
  wire miso, start, loop__val;
  wire [7:0] loop__msg;
  wire [`CFG_BITS - 1:0] cfg;
  RegFile dut (.*);
  wire busy = status[3];

  (* hierconn *) wire [3:0] \dut.sticky ;
  (* hierconn *) wire [63:0] \dut.snapshot ;
  (* hierconn *) wire [2:0] \dut.spi.sclk_sync ;
  (* hierconn *) wire [1:0] \dut.spi.csn_sync ;
  (* hierconn *) wire [1:0] \dut.spi.mosi_sync ;
  (* hierconn *) wire \dut.spi.was_free ;
  (* hierconn *) wire [2:0] \dut.spi.count ;
  (* hierconn *) wire [6:0] \dut.spi.shift_in ;
  (* hierconn *) wire [7:0] \dut.spi.shift_out ;
  (* hierconn *) wire \dut.have_command ;
  (* hierconn *) wire \dut.writing ;
  (* hierconn *) wire [6:0] \dut.address ;

  // SPI, mode 0
  reg [2:0] sclk_late;
  reg [1:0] csn_late, mosi_late;
  reg [2:0] bits;
  reg [6:0] received;
  reg commanded, writing, free_since;      // free_since: csn has been high since the reset
  reg [6:0] address;
  wire selected = !csn_late[1] && free_since;
  wire rise = selected && sclk_late[1] && !sclk_late[2], fall = selected && !sclk_late[1] && sclk_late[2];
  wire [7:0] octet = {received, mosi_late[1]};
  wire whole = rise && bits == 7;
  wire write = whole && commanded && writing, fetch = fall && bits == 0 && commanded && !writing;
  always @(posedge clk) begin
    if (reset) begin
      sclk_late <= 0; csn_late <= 0; mosi_late <= 0; free_since <= 0;
    end else begin
      sclk_late <= {sclk_late[1:0], sclk}; csn_late <= {csn_late[0], csn}; mosi_late <= {mosi_late[0], mosi};
      free_since <= free_since || csn_late[1];
    end
    if (reset || !selected) begin
      bits <= 0; received <= 0; commanded <= 0; writing <= 0; address <= 0;
    end else if (rise) begin
      bits <= bits + 1; received <= octet[6:0];
      if (whole) begin
        commanded <= 1;
        if (!commanded) {writing, address} <= octet;
        else if (address != 127) address <= address + 1;
      end
    end
  end

  (* anyconst *) wire [9:0] bit_of;
  wire now = cfg[bit_of];

  // The cycle before
  reg first = 1, was, was_reset, was_write, was_busy, was_loop, was_loop_rdy;
  reg [6:0] was_address;
  reg [7:0] was_octet, was_loop_msg;
  reg [3:0] was_sticky, was_events;
  always @(posedge clk) begin
    first <= 0; was <= now; was_reset <= reset; was_write <= write; was_busy <= busy; was_address <= address;
    was_octet <= octet; was_loop <= loop__val; was_loop_rdy <= loop__rdy; was_loop_msg <= loop__msg;
    was_sticky <= \dut.sticky ;
    was_events <= {refused, status[0], status[1], status[2]};
  end
  wire refused = write && (busy && (address >= `FIRST && address <= `LAST || address == `START && octet[0])
                           || loop__val && address == `LOOP);
  wire started = was_write && was_address == `START && was_octet[0] && !was_busy;
  wire looped = was_write && was_address == `LOOP && !was_loop;
  wire [3:0] cleared = started ? 4'b0111 : was_write && was_address == `STATUS ? was_octet[4:1] : 4'b0;

  // The data of a read: the fixed bit, the status, a byte of a counter
  reg was_fetch;
  reg [63:0] was_snapshot, was_cycles;
  always @(posedge clk) begin
    was_fetch <= fetch && !reset; was_snapshot <= \dut.snapshot ; was_cycles <= cycles;
  end
  wire [7:0] fetched = \dut.spi.shift_out ;

  always @* begin
    if (first) assume (reset);
    assume (bit_of < `CFG_BITS);
    if (!first && was_reset) begin
      p_reset: assert (now == bit_reset(bit_of));
      p_quiet: assert (!start && !loop__val && \dut.sticky == 0 && !miso);
    end
    if (!first && !was_reset) begin
      // A bit changes only by a write of its own byte outside a frame, and then to what was written
      p_write: assert (now == (was_write && !was_busy && was_address == bit_address(bit_of)
                               ? was_octet[bit_place(bit_of)] && bit_writable(bit_of) : was));
      p_start: assert (start == started);
      p_loop: assert (loop__val == (looped || was_loop && !was_loop_rdy)
                      && (!loop__val || loop__msg == (looped ? was_octet : was_loop_msg)));
      p_sticky: assert (\dut.sticky == (was_sticky & ~cleared | was_events));
      p_read: assert (!(was_fetch && was_address == bit_address(bit_of)) || fetched[bit_place(bit_of)] == was);
      p_read_status: assert (!(was_fetch && was_address == `STATUS) || fetched == {3'b0, was_sticky, was_busy});
      p_read_counter: assert (!(was_fetch && was_address == `CYCLES + 3) || fetched == was_snapshot[31:24]);
      p_snapshot: assert (!(was_fetch && was_address == `CYCLES) || \dut.snapshot == was_cycles);
      p_keeps: assert (was_fetch && (was_address == `CYCLES || was_address == `CYCLES + 8
              || was_address == `CYCLES + 16)
                       || \dut.snapshot == was_snapshot);
    end
    if (!first) begin
      inv_pins: assert (\dut.spi.sclk_sync == sclk_late && \dut.spi.csn_sync == csn_late
                        && \dut.spi.mosi_sync == mosi_late && \dut.spi.was_free == free_since);
      inv_bits: assert (\dut.spi.count == bits && \dut.spi.shift_in == received);
      inv_transfer: assert (\dut.have_command == commanded && \dut.writing == writing && \dut.address == address);
      inv_writable: assert (bit_writable(bit_of) || !now);
    end
  end

  always @* if (!first && !was_reset) begin
    c_write: cover (was_write && was_address == bit_address(bit_of) && now != was);
  end
endmodule
