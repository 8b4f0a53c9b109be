// RegFile from its pins: SPI transfers write the bits that they address, and no other bit changes.
//
// `bit_of` is any bit of the configuration, fixed; `bit_address`, `bit_place`, `bit_writable` and `bit_reset` come
// from the register map (verif/formal/tables.py). Bytes are assembled here from the pins, two flip-flops later (README,
// oversampled SPI), for any behaviour of the pins: transfers that are cut short too.

module RegFileProof (
  input clk, input reset, input sclk, input csn, input mosi, input [3:0] status, input [14:0] state,
  input loop__rdy,
  input [63:0] cycles, input [63:0] conversions_made, input [63:0] conversions_left_out
);
  wire miso, start, abort_, loop__val;
  wire [7:0] loop__msg;
  wire [`CFG_BITS - 1:0] cfg;
  RegFile dut (.*);
  wire busy = status[3], loop_enable = cfg[`CFG_BITS - 4], locked = busy || loop__val;

  (* hierconn *) wire [4:0] \dut.sticky ;
  (* hierconn *) wire [8 * (`LAST - `FIRST + 1) - 1:0] \dut.image , \dut.writable ;
  (* hierconn *) wire [63:0] \dut.snapshot ;
  (* hierconn *) wire [1:0] \dut.spi.sclk_sync.stages ;
  (* hierconn *) wire [1:0] \dut.spi.csn_sync.stages ;
  (* hierconn *) wire [1:0] \dut.spi.mosi_sync.stages ;
  (* hierconn *) wire \dut.spi.sclk_was ;
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
    sclk_late <= {!reset && sclk_late[1], sclk_late[0], sclk};
    csn_late <= {csn_late[0], csn}; mosi_late <= {mosi_late[0], mosi};
    free_since <= !reset && (free_since || csn_late[1]);
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
  reg [1:0] edges = 2;  // the first ones, in which the synchronizers fill
  wire first = edges != 0;
  reg was, was_reset, was_write, was_busy, was_loop, was_loop_rdy;
  reg [6:0] was_address;
  reg [7:0] was_octet, was_loop_msg;
  reg [4:0] was_sticky, was_events;
  reg was_locked, was_enable;
  always @(posedge clk) begin
    edges <= edges - first; was <= now; was_reset <= reset; was_write <= write; was_busy <= busy; was_address <= address;
    was_octet <= octet; was_loop <= loop__val; was_loop_rdy <= loop__rdy; was_loop_msg <= loop__msg;
    was_sticky <= \dut.sticky ;
    was_events <= {aborting, refused, status[0], status[1], status[2]};
    was_locked <= locked; was_enable <= loop_enable;
  end
  wire aborting = write && address == `START && octet[`ABORT_BIT];
  wire refused = write && (locked && address >= `FIRST && address <= `LAST
                           || address == `START && octet[0] && (octet[`ABORT_BIT] || locked || loop_enable)
                           || address == `LOOP && (loop__val || !loop_enable));
  wire aborted = was_write && was_address == `START && was_octet[`ABORT_BIT];
  wire started = was_write && was_address == `START && was_octet[0] && !aborted && !was_locked && !was_enable;
  wire looped = was_write && was_address == `LOOP && !was_loop && was_enable;
  wire [4:0] cleared = started ? 5'b10111 : was_write && was_address == `STATUS ? was_octet[5:1] : 5'b0;

  // The data of a read, and how they leave: everything outside the configuration, the shift register, the pin
  reg was_fetch, was_selected, was_rise, was_fall;
  reg [2:0] was_bits;
  reg [7:0] was_shift;
  reg [31:0] was_state;
  reg [63:0] was_snapshot;
  reg [191:0] was_counters;
  always @(posedge clk) begin
    was_fetch <= fetch && !reset; was_selected <= selected && !reset; was_rise <= rise; was_fall <= fall;
    was_bits <= bits; was_shift <= \dut.spi.shift_out ; was_state <= `STATE_WORD; was_snapshot <= \dut.snapshot ;
    was_counters <= {conversions_left_out, conversions_made, cycles};
  end
  wire [7:0] fetched = \dut.spi.shift_out ;
  wire in_image = was_address >= `FIRST && was_address <= `LAST;
  wire in_counters = was_address >= `CYCLES && was_address < `CYCLES + 24;
  wire in_state = was_address >= `STATE && was_address < `STATE + 4;
  wire [4:0] counter_byte = was_address - `CYCLES;
  wire [63:0] counter = was_counters[64 * counter_byte[4:3] +: 64];
  wire [7:0] other = in_counters ? (counter_byte[2:0] == 0 ? counter[7:0] : was_snapshot[8 * counter_byte[2:0] +: 8])
                     : in_state ? was_state[8 * (was_address - `STATE) +: 8]
                     : was_address == `STATUS ? {2'b0, was_sticky, was_busy} : constant_at(was_address);

  always @* begin
    if (first) a_reset: assume (reset);
    if (!first && was_reset) begin
      p_reset: assert (now == bit_reset(bit_of));
      p_quiet: assert (!start && !abort_ && !loop__val && \dut.sticky == 0 && !miso);
    end
    if (!first && !was_reset) begin
      // A bit changes only by a write of its own byte outside a frame, and then to what was written
      p_write: assert (now == (was_write && !was_locked && was_address == bit_address(bit_of)
                               ? was_octet[bit_place(bit_of)] && bit_writable(bit_of) : was));
      p_start: assert (start == started);
      p_abort: assert (abort_ == aborted);
      p_loop: assert (loop__val == (looped || was_loop && !was_loop_rdy && !aborted)
                      && (!loop__val || loop__msg == (looped ? was_octet : was_loop_msg)));
      p_sticky: assert (\dut.sticky == (was_sticky & ~cleared | was_events));
      p_read: assert (!(was_fetch && was_address == bit_address(bit_of)) || fetched[bit_place(bit_of)] == was);
      p_read_gaps: assert (!(was_fetch && in_image) || (fetched & ~writable_at(was_address)) == 0);
      p_read_other: assert (!was_fetch || in_image || fetched == other);
      p_snapshot: assert (\dut.snapshot == (was_fetch && in_counters && counter_byte[2:0] == 0 ? counter : was_snapshot));
      // MSB first: a byte is loaded at the falling edge after its command or the byte before, then shifted
      p_shift: assert (\dut.spi.shift_out == (!was_selected ? 8'd0 : !was_fall ? was_shift
                                              : was_bits != 0 ? {was_shift[6:0], 1'b0} : was_fetch ? fetched : 8'd0));
      p_miso: assert (miso == fetched[7]);
      // A loop-back byte waits only with loop_enable, which stays; no start with it
      p_loop_alone: assert ((!loop__val || loop_enable) && (!start || !loop_enable && !loop__val));
    end
    if (!first) begin
      inv_pins: assert ({\dut.spi.sclk_was , \dut.spi.sclk_sync.stages } == sclk_late
                        && \dut.spi.csn_sync.stages == csn_late && \dut.spi.mosi_sync.stages == mosi_late
                        && \dut.spi.was_free == free_since);
      inv_bits: assert (\dut.spi.count == bits && \dut.spi.shift_in == received);
      inv_transfer: assert (\dut.have_command == commanded && \dut.writing == writing && \dut.address == address);
      inv_writable: assert ((\dut.image & ~\dut.writable ) == 0);
    end
  end

  always @* if (!first && !was_reset) begin
    c_read: cover (was_fetch && in_counters);
    c_write: cover (was_write && was_address == bit_address(bit_of) && now != was);
  end
endmodule
