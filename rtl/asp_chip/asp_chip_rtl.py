"""AspChip: the whole digital chip. It connects the blocks, which have their own folders."""

from pymtl3 import Component, Wire, connect, update, update_ff

from models.parameters.registers import register_map
from rtl.adc_bank import AdcBank
from rtl.amp_ctrl import AmpCtrl
from rtl.phase_path import PhasePath
from rtl.readout_seq import ReadoutSeq
from rtl.reg_file import RegFile
from rtl.run_length import RunLength

from .balance_rtl import Balance
from .pattern_rtl import Pattern
from .pins import declare_pins

TIMING = ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard", "n_cm")
PHASES = ("pixel_reset", "shutter", "ref_ctl", "integrate", "cm_reset", "read", "sample", "tap")
ADDRESS = ("row", "group", "k", "sub", "en")
WINDOW = ("mode", "mask", "row0", "row1", "col0", "col1", "decimation")
TOF = 3


class AspChip(Component):
    """The chip (README.md). rows, cols: pixels of the array. lanes: converters, a power of two.
    order: pixel type of each position in a tile of tile_rows x tile_cols, row by row.
    divider, n_frac, iterations: variant of the phase path and its width (rtl/quad_divider).
    """

    def construct(s, rows, cols, lanes, order, tile_rows=4, tile_cols=6, divider="radix4", n_frac=8, iterations=10):
        trims = register_map().trims[0]

        # Interface
        declare_pins(s, lanes)

        # Components
        s.regs = RegFile(-(-rows // tile_rows) - 1, -(-cols // tile_cols) - 1)
        s.amp = AmpCtrl()
        s.seq = ReadoutSeq(rows, cols, lanes, order, tile_rows, tile_cols)
        s.bank = AdcBank(lanes)
        s.phase = PhasePath(lanes, divider, n_frac, iterations)
        s.encoder = RunLength(rows, cols, lanes, tile_rows, tile_cols)
        s.generator = Pattern(lanes)
        s.balancer = Balance(order, tile_rows, tile_cols, trims.width, 8 * trims.size)
        s.phase_on = Wire()
        s.was_sync = Wire()
        s.cfg_told = Wire()  # cfg_err and amp_err are levels: report each once per start
        s.amp_told = Wire()

        # Connections
        cfg = s.regs.cfg
        for name in ("sclk", "csn", "mosi", "miso"):
            connect(getattr(s, name), getattr(s.regs, name))
        s.regs.cycles //= s.seq.cycles
        s.regs.conversions_made[0:32] //= s.bank.made
        s.regs.conversions_made[32:64] //= 0
        s.regs.conversions_left_out[0:32] //= s.bank.left_out
        s.regs.conversions_left_out[32:64] //= 0

        s.seq.start //= s.regs.start
        s.seq.overlap //= cfg.overlap
        s.seq.amp_done //= s.amp.done
        s.seq.amp_err //= s.amp.cfg_err
        s.seq.bank_idle //= s.bank.idle
        for name in WINDOW:
            connect(getattr(s.seq, name), getattr(cfg, name))

        s.amp.start //= s.seq.amp_start
        s.amp.four_tap //= s.seq.four_tap
        s.amp.hold_free //= s.seq.hold_free
        s.amp_row //= s.seq.amp_row
        for name in TIMING:
            connect(getattr(s.amp, name), getattr(cfg, name))
        for name in PHASES:
            connect(getattr(s, name), getattr(s.amp, name))

        s.bank.step //= s.seq.step
        s.bank.mode //= cfg.mode
        s.bank.threshold //= cfg.threshold
        s.bank.comparator //= s.generator.comparator
        for name in (*ADDRESS, "dac", "hold", "unsigned_"):
            connect(getattr(s, name), getattr(s.bank, name))
        s.mode //= cfg.mode

        s.generator.on //= cfg.test_pattern
        s.generator.row //= s.bank.row[0:8]
        for name in ("group", "k", "sub", "hold", "dac"):
            connect(getattr(s.generator, name), getattr(s.bank, name))
        s.generator.analog //= s.comparator

        s.balancer.row //= s.bank.row
        s.balancer.k //= s.bank.k
        s.balancer.trims //= cfg.trims
        s.balancer.balance //= s.balance

        s.phase.recv //= s.bank.scan
        s.phase.on //= s.phase_on
        s.phase.noise_floor //= cfg.noise_floor
        s.phase.send //= s.encoder.recv

        s.encoder.phase //= s.phase_on
        s.encoder.made //= s.bank.made
        s.encoder.left_out //= s.bank.left_out
        s.encoder.frame_sync //= s.frame_sync
        for name in (*WINDOW, "threshold", "frame_number"):
            connect(getattr(s.encoder, name), getattr(cfg, name))

        # Logic
        @update
        def up_phase():
            s.phase_on @= s.regs.cfg.phase & (s.regs.cfg.mode == TOF)

        @update
        def up_link():
            s.link_data @= s.encoder.send.msg
            s.link_val @= s.encoder.send.val
            s.encoder.send.rdy @= s.link_rdy
            s.regs.loop.rdy @= 0
            if s.regs.cfg.loop_enable:
                s.link_data @= s.regs.loop.msg
                s.link_val @= s.regs.loop.val
                s.encoder.send.rdy @= 0
                s.regs.loop.rdy @= s.link_rdy

        @update
        def up_status():
            # until `done` is set, so that no start comes between the frame's end and its `done`
            s.busy @= s.seq.busy | s.encoder.frame_sync | s.was_sync
            s.regs.status.busy @= s.busy
            s.regs.status.done @= s.was_sync & ~s.encoder.frame_sync
            s.regs.status.cfg_err @= s.seq.cfg_err & ~s.cfg_told
            s.regs.status.amp_err @= s.amp.cfg_err & ~s.amp_told

        @update_ff
        def up_told():
            if s.reset:
                s.was_sync <<= 0
                s.cfg_told <<= 0
                s.amp_told <<= 0
            else:
                s.was_sync <<= s.encoder.frame_sync
                s.cfg_told <<= s.seq.cfg_err & ~s.regs.start
                s.amp_told <<= s.amp.cfg_err & ~s.seq.amp_start

    def line_trace(s):
        return f"{s.seq.line_trace()} {s.bank.line_trace()} {s.encoder.line_trace()}"
