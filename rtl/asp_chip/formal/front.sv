// What the host and the link see of the chip: RegFile, Link, Status and Resets, connected as in AspChip (p_... of
// wires.sv), around any frame engine that keeps what is proven of ReadoutSeq and RunLength.

module FrontProof (
  input clk, input reset, input sclk, input csn, input mosi, input link_rdy, input [7:0] frame_msg, input frame_val,
  input frame_sync, input seq_busy, input seq_err, input amp_start, input amp_err
);
  wire chip, engine, start, abort_, loop_val, loop_rdy, frame_rdy, link_val, miso;
  wire [7:0] loop_msg, link_data;
  wire [3:0] status;
  wire [`CFG_BITS - 1:0] cfg;
  wire loop_enable = cfg[`CFG_BITS - 4];
  wire busy = status[3], done = status[2], cfg_strobe = status[1], amp_strobe = status[0];
  Resets resets (.clk(clk), .reset(reset), .abort_(abort_), .chip(chip), .engine(engine));
  RegFile regs (
    .clk(clk), .reset(chip), .sclk(sclk), .csn(csn), .mosi(mosi), .miso(miso), .status(status), .cfg(cfg),
    .start(start), .abort_(abort_), .loop__val(loop_val), .loop__msg(loop_msg), .loop__rdy(loop_rdy)
  );
  Link link (
    .clk(clk), .reset(engine), .loop_enable(loop_enable), .frame__msg(frame_msg), .frame__val(frame_val),
    .frame__rdy(frame_rdy), .loop__msg(loop_msg), .loop__val(loop_val), .loop__rdy(loop_rdy), .send__msg(link_data),
    .send__val(link_val), .send__rdy(link_rdy)
  );
  Status state (
    .clk(clk), .reset(engine), .start(start), .seq_busy(seq_busy), .seq_err(seq_err), .amp_start(amp_start),
    .amp_err(amp_err), .frame_sync(frame_sync), .status(status)
  );

  (* hierconn *) wire [2:0] \regs.spi.count ;
  (* hierconn *) wire [1:0] \resets.released.stages ;
  (* hierconn *) wire \state.was_sync , \state.seq_told , \state.amp_told ;

  (* anyconst *) wire [9:0] bit_of;
  wire choice = cfg[bit_of];
  reg was_choice;

  // The cycle before, and what has been reported since the start
  reg [1:0] edges = 2;
  wire first = edges != 0;
  reg [1:0] late;
  reg was_engine, was_start, was_amp_start, was_seq_busy, was_seq_err, was_amp_err, was_sync, was_val, was_rdy;
  reg was_frame_val, was_frame_rdy, cfg_told, amp_told;
  reg [7:0] was_data, was_frame_msg;
  always @(posedge clk) begin
    was_choice <= choice; edges <= edges - first; late <= {late[0], reset}; was_engine <= engine; was_start <= start;
    was_amp_start <= amp_start; was_seq_busy <= seq_busy; was_seq_err <= seq_err; was_amp_err <= amp_err;
    was_sync <= frame_sync; was_val <= link_val; was_rdy <= link_rdy; was_data <= link_data;
    was_frame_val <= frame_val; was_frame_rdy <= frame_rdy; was_frame_msg <= frame_msg;
    cfg_told <= !engine && !start && (cfg_told || cfg_strobe);
    amp_told <= !engine && !amp_start && (amp_told || amp_strobe);
  end

  always @* begin
    if (first) a_reset: assume (reset);
    else begin
      a_sync_quiet: assume (!was_engine || !frame_sync);
      a_seq_quiet: assume (!was_engine || !seq_busy && !seq_err);
      a_amp_quiet: assume (!was_engine || !amp_err);
      a_frame: assume (was_engine || !was_frame_val || was_frame_rdy || frame_val && frame_msg == was_frame_msg);
      a_sync: assume (!frame_val || frame_sync);
      a_seq: assume (!seq_busy || was_seq_busy || was_start);
      a_begin: assume (!frame_sync || was_sync || was_seq_busy);
      a_seq_err: assume (!was_seq_err || seq_err || was_start || was_engine);
      a_amp_err: assume (!was_amp_err || amp_err || was_amp_start || was_engine);
    end
    if (!first) begin
      p_resets: assert (chip == (reset || late[1]) && engine == (chip || abort_));
      // An offered byte stays until it is taken, but by a reset or an abort
      p_link: assert (was_engine || abort_ || !was_val || was_rdy || link_val && link_data == was_data);
      // Bytes are the frame's or the loop-back's, and the other stream waits
      p_source: assert (link_val == (loop_enable ? loop_val : frame_val) && (!link_val || link_data == (loop_enable
                        ? loop_msg : frame_msg)) && loop_rdy == (loop_enable && link_rdy)
                        && frame_rdy == (!loop_enable && link_rdy));
      // ... which never holds a frame up: they exclude one another
      p_apart: assert (!(busy && (loop_enable || loop_val)) && (!loop_val || loop_enable));
      p_start: assert (!start || !busy && !loop_enable && !loop_val);
      // RegFile locks the configuration, of which this is any bit, while a frame runs
      p_config: assert (!busy || choice == was_choice);
      p_busy: assert (busy == (seq_busy || frame_sync || was_sync && !was_engine));
      p_done: assert (done == (was_sync && !was_engine && !frame_sync && !engine));
      p_once: assert (cfg_strobe == (seq_err && !cfg_told && !engine)
                      && amp_strobe == (amp_err && !amp_told && !engine));
      p_abort: assert (!was_engine || !link_val && !busy && !done && !cfg_strobe && !amp_strobe);
      inv_count: assert (!start && !abort_ || \regs.spi.count == 0);
      inv_late: assert (\resets.released.stages == late);
      inv_sync: assert (\state.was_sync == (was_sync && !was_engine));
      inv_told: assert ((cfg_told == (\state.seq_told && !was_start)) && (amp_told == (\state.amp_told && !was_amp_start)));
    end
  end
  always @* if (!first && !was_engine) begin
    c_start: cover (start);
    c_abort: cover (abort_);
    c_byte: cover (link_val && !link_rdy);
  end
endmodule
