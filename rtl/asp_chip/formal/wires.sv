// The blocks are connected as in docs/chip.md: every bit of every wire between them, including the upper bits of
// counters and addresses, which a frame of a small array never sets.

module AspChipWires (
  input clk, input reset, input sclk, input csn, input mosi, input link_rdy, input [`LANES - 1:0] comparator
);
  wire miso, miso_oe, link_val, frame_sync, busy, hold, wake, convert, unsigned_, pixel_reset, shutter, ref_ctl, integrate, expose,
       cm_reset, read, sample;
  wire [7:0] link_data, group;
  wire [8 * `LANES - 1:0] dac;
  wire [1:0] mode, sub, tap;
  wire [9:0] row, balance, amp_row, reset_row;
  wire [2:0] k;
  wire [`LANES - 1:0] en;
  AspChip dut (.*);

  (* hierconn *) wire \dut.resets.chip , \dut.resets.engine , \dut.resets.abort_ , \dut.regs.abort_ ;
  (* hierconn *) wire \dut.regs.reset , \dut.amp.reset , \dut.seq.reset , \dut.bank.reset , \dut.phase.reset ;
  (* hierconn *) wire \dut.encoder.reset , \dut.generator.reset , \dut.frame_status.reset , \dut.resets.reset ;

  // RegFile's bits: in the order of the register map, trims in the lowest bits
  localparam TRIMS = 384, CONFIGURATION = TRIMS + 220;
  (* hierconn *) wire [CONFIGURATION - 1:0] \dut.regs.cfg ;
  (* hierconn *) wire [63:0] \dut.regs.cycles , \dut.regs.conversions_made , \dut.regs.conversions_left_out ;
  (* hierconn *) wire [63:0] \dut.seq.cycles ;
  (* hierconn *) wire [31:0] \dut.bank.made , \dut.bank.left_out , \dut.encoder.made , \dut.encoder.left_out ;
  (* hierconn *) wire \dut.regs.start , \dut.regs.sclk , \dut.regs.csn , \dut.regs.mosi , \dut.regs.miso ;

  (* hierconn *) wire \dut.seq.overlap , \dut.seq.start , \dut.generator.on ;
  (* hierconn *) wire [1:0] \dut.seq.mode , \dut.seq.decimation , \dut.encoder.decimation ;
  (* hierconn *) wire [2:0] \dut.bank.mode , \dut.encoder.mode ;
  (* hierconn *) wire [6:0] \dut.bank.threshold , \dut.encoder.threshold ;
  (* hierconn *) wire [7:0] \dut.phase.noise_floor , \dut.amp.n_cm ;
  (* hierconn *) wire [23:0] \dut.seq.mask , \dut.encoder.mask ;
  (* hierconn *) wire [7:0] \dut.seq.row0 , \dut.seq.row1 , \dut.seq.col0 , \dut.seq.col1 ;
  (* hierconn *) wire [7:0] \dut.encoder.row0 , \dut.encoder.row1 , \dut.encoder.col0 , \dut.encoder.col1 ;
  (* hierconn *) wire [1:0] \dut.encoder.resync ;
  (* hierconn *) wire [9:0] \dut.encoder.exposure ;
  (* hierconn *) wire [7:0] \dut.encoder.n_cm , \dut.encoder.calibration ;
  (* hierconn *) wire [15:0] \dut.encoder.t_int , \dut.encoder.frame_number , \dut.amp.t_reset , \dut.amp.t_int , \dut.amp.t_cm ;
  (* hierconn *) wire [15:0] \dut.amp.t_settle , \dut.amp.t_read , \dut.amp.t_guard ;
  (* hierconn *) wire [TRIMS - 1:0] \dut.balancer.trims ;
  (* hierconn *) wire \dut.phase.on , \dut.encoder.phase ;

  (* hierconn *) wire [9:0] \dut.bank.row , \dut.balancer.row , \dut.seq.amp_row , \dut.balancer.balance ;
  (* hierconn *) wire [7:0] \dut.generator.row , \dut.generator.group , \dut.bank.group ;
  (* hierconn *) wire [2:0] \dut.bank.k , \dut.generator.k , \dut.balancer.k ;
  (* hierconn *) wire [1:0] \dut.bank.sub , \dut.generator.sub ;
  (* hierconn *) wire [`LANES - 1:0] \dut.bank.en , \dut.bank.comparator , \dut.generator.comparator , \dut.generator.analog ;
  (* hierconn *) wire [8 * `LANES - 1:0] \dut.bank.dac , \dut.generator.dac ;
  (* hierconn *) wire \dut.bank.hold , \dut.bank.wake , \dut.generator.hold , \dut.bank.unsigned_ ;

  (* hierconn *) wire [24 + `LANES:0] \dut.seq.step__msg , \dut.bank.step__msg ;
  (* hierconn *) wire \dut.seq.step__val , \dut.bank.step__val , \dut.seq.step__rdy , \dut.bank.step__rdy ;
  (* hierconn *) wire [11:0] \dut.bank.scan__msg , \dut.phase.recv__msg , \dut.phase.send__msg , \dut.encoder.recv__msg ;
  (* hierconn *) wire \dut.bank.scan__val , \dut.phase.recv__val , \dut.bank.scan__rdy , \dut.phase.recv__rdy ;
  (* hierconn *) wire [11:0] \dut.scan.recv__msg , \dut.scan.send__msg ;
  (* hierconn *) wire \dut.scan.recv__val , \dut.scan.recv__rdy , \dut.scan.send__val , \dut.scan.send__rdy ;
  (* hierconn *) wire \dut.phase.send__val , \dut.encoder.recv__val , \dut.phase.send__rdy , \dut.encoder.recv__rdy ;
  (* hierconn *) wire \dut.encoder.frame_sync , \dut.frame_status.frame_sync , \dut.link.send__val , \dut.gate.low ;
  (* hierconn *) wire [3:0] \dut.regs.status , \dut.frame_status.status ;

  (* hierconn *) wire \dut.amp.start , \dut.seq.amp_start , \dut.amp.four_tap , \dut.seq.four_tap ;
  (* hierconn *) wire \dut.amp.hold_free , \dut.seq.hold_free , \dut.amp.done , \dut.seq.amp_done ;
  (* hierconn *) wire \dut.amp.cfg_err , \dut.seq.amp_err , \dut.bank.idle , \dut.seq.bank_idle ;
  (* hierconn *) wire \dut.amp.pixel_reset , \dut.amp.shutter , \dut.amp.ref_ctl , \dut.amp.integrate ;
  (* hierconn *) wire \dut.amp.cm_reset , \dut.amp.read , \dut.amp.sample ;
  (* hierconn *) wire \dut.amp.expose , \dut.amp.slot_resets , \dut.amp.slot_reads , \dut.amp.slot_opens ;
  (* hierconn *) wire \dut.seq.slot_resets , \dut.seq.slot_reads , \dut.seq.slot_opens ;
  (* hierconn *) wire [9:0] \dut.seq.exposure , \dut.seq.reset_row ;
  (* hierconn *) wire [1:0] \dut.amp.tap ;
  (* hierconn *) wire [14:0] \dut.regs.state ;
  (* hierconn *) wire [2:0] \dut.seq.state , \dut.encoder.state ;
  (* hierconn *) wire \dut.amp.busy , \dut.regs.loop__val ;

  wire [CONFIGURATION - 1:0] cfg = \dut.regs.cfg ;
  wire loop_enable = cfg[CONFIGURATION - 4], phase = cfg[CONFIGURATION - 2];
  reg first = 1;
  always @(posedge clk) first <= 0;

  always @* begin
    p_configuration: assert (cfg == {
        \dut.seq.overlap , phase, \dut.generator.on , loop_enable, \dut.encoder.resync , \dut.bank.mode , \dut.seq.decimation ,
        \dut.bank.threshold , \dut.phase.noise_floor , \dut.seq.mask , \dut.seq.row0 , \dut.seq.row1 , \dut.seq.col0 ,
        \dut.seq.col1 , \dut.encoder.frame_number , \dut.amp.n_cm , \dut.encoder.calibration , \dut.amp.t_reset ,
        \dut.amp.t_int , \dut.amp.t_cm , \dut.amp.t_settle , \dut.amp.t_read , \dut.amp.t_guard , \dut.seq.exposure ,
        \dut.balancer.trims });
    p_header: assert ({\dut.encoder.mode , \dut.encoder.decimation , \dut.encoder.threshold , \dut.encoder.mask ,
                       \dut.encoder.row0 , \dut.encoder.row1 , \dut.encoder.col0 , \dut.encoder.col1 ,
                       \dut.encoder.exposure , \dut.encoder.n_cm , \dut.encoder.t_int } ==
                      {\dut.bank.mode , \dut.seq.decimation , \dut.bank.threshold , \dut.seq.mask ,
                       \dut.seq.row0 , \dut.seq.row1 , \dut.seq.col0 , \dut.seq.col1 ,
                       \dut.seq.exposure , \dut.amp.n_cm , \dut.amp.t_int });
    p_mode: assert (\dut.bank.mode [1:0] == \dut.seq.mode && mode == \dut.seq.mode
                    && \dut.phase.on == (phase && mode == 3) && \dut.encoder.phase == \dut.phase.on );
    p_counts: assert (\dut.regs.cycles == \dut.seq.cycles
                      && \dut.regs.conversions_made == {32'd0, \dut.bank.made }
                      && \dut.regs.conversions_left_out == {32'd0, \dut.bank.left_out }
                      && \dut.encoder.made == \dut.bank.made && \dut.encoder.left_out == \dut.bank.left_out );
    p_address: assert ({row, group, k, sub, en, unsigned_} == {\dut.bank.row , \dut.bank.group , \dut.bank.k ,
                       \dut.bank.sub , \dut.bank.en , \dut.bank.unsigned_ } && dac == \dut.bank.dac
                       && amp_row == \dut.seq.amp_row && reset_row == \dut.seq.reset_row && balance == \dut.balancer.balance );
    p_pattern: assert ({\dut.generator.row , \dut.generator.group , \dut.generator.k , \dut.generator.sub ,
                        \dut.generator.hold , \dut.generator.dac , \dut.generator.analog , \dut.bank.comparator } ==
                       {row[7:0], group, k, sub, \dut.bank.hold , dac, comparator, \dut.generator.comparator });
    p_balance: assert ({\dut.balancer.row , \dut.balancer.k } == {row, k});
    p_streams: assert ({\dut.bank.step__msg , \dut.bank.step__val , \dut.seq.step__rdy } ==
                       {\dut.seq.step__msg , \dut.seq.step__val , \dut.bank.step__rdy } &&
                       {\dut.phase.recv__msg , \dut.phase.recv__val , \dut.bank.scan__rdy } ==
                       {\dut.bank.scan__msg , \dut.bank.scan__val , \dut.phase.recv__rdy } &&
                       {\dut.scan.recv__msg , \dut.scan.recv__val , \dut.phase.send__rdy } ==
                       {\dut.phase.send__msg , \dut.phase.send__val , \dut.scan.recv__rdy } &&
                       {\dut.encoder.recv__msg , \dut.encoder.recv__val , \dut.scan.send__rdy } ==
                       {\dut.scan.send__msg , \dut.scan.send__val , \dut.encoder.recv__rdy });
    p_rows: assert ({\dut.amp.start , \dut.amp.four_tap , \dut.amp.hold_free , \dut.seq.amp_done , \dut.seq.amp_err ,
                     \dut.seq.bank_idle , \dut.seq.start , \dut.amp.slot_resets , \dut.amp.slot_reads ,
                     \dut.amp.slot_opens } ==
                    {\dut.seq.amp_start , \dut.seq.four_tap , \dut.seq.hold_free , \dut.amp.done , \dut.amp.cfg_err ,
                     \dut.bank.idle , \dut.regs.start , \dut.seq.slot_resets , \dut.seq.slot_reads ,
                     \dut.seq.slot_opens });
    p_pins: assert ({pixel_reset, shutter, ref_ctl, integrate, expose, cm_reset, read, sample, tap, hold, link_val, frame_sync,
                     busy, miso_oe, wake, convert} ==
                    (\dut.gate.low ? 17'd0 :
                     {\dut.amp.pixel_reset , \dut.amp.shutter , \dut.amp.ref_ctl , \dut.amp.integrate , \dut.amp.expose ,
                      \dut.amp.cm_reset , \dut.amp.read , \dut.amp.sample , \dut.amp.tap , \dut.bank.hold ,
                      \dut.link.send__val , \dut.encoder.frame_sync , \dut.frame_status.status [3], !csn,
                      \dut.bank.wake , !\dut.bank.idle })
                    && {\dut.regs.sclk , \dut.regs.csn , \dut.regs.mosi , miso} == {sclk, csn, mosi, \dut.regs.miso }
                    && \dut.frame_status.frame_sync == \dut.encoder.frame_sync && \dut.regs.status == \dut.frame_status.status );
    p_states: assert (\dut.regs.state == {
        \dut.amp.pixel_reset ? 3'd2 : \dut.amp.integrate ? 3'd3 : \dut.amp.cm_reset ? 3'd4 :
        \dut.amp.ref_ctl ? 3'd5 : \dut.amp.read ? 3'd6 : {2'd0, \dut.amp.busy },
        \dut.seq.state , \dut.encoder.state , !\dut.seq.hold_free , !\dut.bank.idle ,
        \dut.seq.step__val && !\dut.bank.step__rdy , \dut.bank.scan__val && !\dut.phase.recv__rdy ,
        \dut.link.send__val && !link_rdy, \dut.regs.loop__val });
    p_resets: assert ({\dut.resets.reset , \dut.resets.abort_ , \dut.regs.reset , \dut.gate.low } ==
                      {reset, \dut.regs.abort_ , {2{\dut.resets.chip }}} &&
                      {\dut.amp.reset , \dut.seq.reset , \dut.bank.reset , \dut.phase.reset , \dut.encoder.reset ,
                       \dut.generator.reset , \dut.frame_status.reset } == {7{\dut.resets.engine }});
    c_run: cover (!first && !reset && !csn && \dut.regs.cfg [0] == 0);
  end
endmodule
