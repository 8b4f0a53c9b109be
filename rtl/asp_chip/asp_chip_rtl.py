"""AspChip: the whole digital chip. It connects the blocks, which have their own folders."""

from pymtl3 import Component, Wire, connect, update
from pymtl3.stdlib.stream.queues import PipeQueue1EntryRTL

from talbot.models.parameters import NO_DIVIDER
from talbot.models.parameters.registers import register_map
from talbot.rtl.adc_bank import AdcBank
from talbot.rtl.amp_ctrl import AmpCtrl
from talbot.rtl.amp_ctrl.ports import SLOT, TIMING
from talbot.rtl.asp_chip.balance_rtl import Balance
from talbot.rtl.asp_chip.gate_rtl import Gate
from talbot.rtl.asp_chip.link_rtl import Link
from talbot.rtl.asp_chip.pattern_rtl import Pattern
from talbot.rtl.asp_chip.pins import declare_pins
from talbot.rtl.asp_chip.resets_rtl import Resets, children_reset_by
from talbot.rtl.asp_chip.state_rtl import State
from talbot.rtl.asp_chip.status_rtl import Status
from talbot.rtl.messages import ScanMsg
from talbot.rtl.phase_path import PhasePath
from talbot.rtl.readout_seq import ReadoutSeq
from talbot.rtl.reg_file import RegFile
from talbot.rtl.run_length import RunLength

PHASES = ("pixel_reset", "shutter", "ref_ctl", "integrate", "expose", "cm_reset", "read", "sample", "tap")
ADDRESS = ("row", "group", "k", "sub", "en")
WINDOW = ("mask", "row0", "row1", "col0", "col1", "decimation")
HEADER = ("mode", "threshold", "frame_number", "resync", "exposure", "n_cm", "t_int", "calibration")
TOF = 3


class AspChip(Component):
    """The chip (README.md). rows, cols: pixels of the array. lanes: converters, a power of two.
    order: pixel type of each position in a tile of tile_rows x tile_cols, row by row.
    divider, n_frac, iterations: variant of the phase path and its width (rtl/quad_divider). divider = "none": no phase
    path, samples go to the encoder as they are and the register `phase` has no effect.
    """

    def construct(s, rows, cols, lanes, order, tile_rows=4, tile_cols=6, divider="radix4", n_frac=8, iterations=10):
        trims = register_map().trims[0]
        has_phase = divider != NO_DIVIDER

        # Interface
        declare_pins(s, lanes)

        # Components
        s.resets = Resets()
        with children_reset_by(s, s.resets.chip):
            s.regs = RegFile(rows, cols, lanes, tile_rows, tile_cols, divider)
        with children_reset_by(s, s.resets.engine):
            s.amp = AmpCtrl()
            s.seq = ReadoutSeq(rows, cols, lanes, order, tile_rows, tile_cols)
            s.bank = AdcBank(lanes)
            if has_phase:
                s.phase = PhasePath(lanes, divider, n_frac, iterations)
            s.scan = PipeQueue1EntryRTL(ScanMsg)  # ends the longest path: divider, phase, token
            s.encoder = RunLength(rows, cols, lanes, tile_rows, tile_cols)
            s.generator = Pattern(lanes)
            s.balancer = Balance(order, tile_rows, tile_cols, trims.width, 8 * trims.size)
            s.link = Link()
            s.frame_status = Status()
            s.states = State()
        s.phase_on = Wire()
        s.selected = Wire()
        s.converting = Wire()
        gated = {name: getattr(s.amp, name) for name in PHASES} | {
            "hold": s.bank.hold,
            "link_val": s.link.send.val,
            "frame_sync": s.encoder.frame_sync,
            "busy": s.frame_status.status.busy,
            "miso_oe": s.selected,
            "wake": s.bank.wake,
            "convert": s.converting,
        }
        s.gate = Gate(sum(levels._dsl.Type.nbits for levels in gated.values()))

        # Connections
        cfg = s.regs.cfg
        for name in ("sclk", "csn", "mosi", "miso"):
            connect(getattr(s, name), getattr(s.regs, name))
        s.regs.cycles //= s.seq.cycles
        s.regs.conversions_made[0:32] //= s.bank.made
        s.regs.conversions_made[32:64] //= 0
        s.regs.conversions_left_out[0:32] //= s.bank.left_out
        s.regs.conversions_left_out[32:64] //= 0
        s.regs.status //= s.frame_status.status
        s.resets.abort_ //= s.regs.abort_

        s.seq.start //= s.regs.start
        s.seq.overlap //= cfg.overlap
        s.seq.exposure //= cfg.exposure
        s.seq.amp_done //= s.amp.done
        s.seq.amp_err //= s.amp.cfg_err
        s.seq.bank_idle //= s.bank.idle
        s.seq.mode //= cfg.mode[0:2]
        for name in WINDOW:
            connect(getattr(s.seq, name), getattr(cfg, name))

        s.amp.start //= s.seq.amp_start
        s.amp.four_tap //= s.seq.four_tap
        s.amp.hold_free //= s.seq.hold_free
        s.amp_row //= s.seq.amp_row
        s.reset_row //= s.seq.reset_row
        for name in SLOT:
            connect(getattr(s.amp, name), getattr(s.seq, name))
        for name in TIMING:
            connect(getattr(s.amp, name), getattr(cfg, name))

        s.bank.step //= s.seq.step
        s.bank.mode //= cfg.mode
        s.bank.threshold //= cfg.threshold
        s.bank.comparator //= s.generator.comparator
        for name in (*ADDRESS, "dac", "unsigned_"):
            connect(getattr(s, name), getattr(s.bank, name))
        s.mode //= cfg.mode[0:2]

        s.generator.on //= cfg.test_pattern
        s.generator.row //= s.bank.row[0:8]
        for name in ("group", "k", "sub", "hold", "dac"):
            connect(getattr(s.generator, name), getattr(s.bank, name))
        s.generator.analog //= s.comparator

        s.balancer.row //= s.bank.row
        s.balancer.k //= s.bank.k
        s.balancer.trims //= cfg.trims
        s.balancer.balance //= s.balance

        if has_phase:
            s.phase.recv //= s.bank.scan
            s.phase.on //= s.phase_on
            s.phase.noise_floor //= cfg.noise_floor
            s.phase.send //= s.scan.recv
            s.states.scan_rdy //= s.phase.recv.rdy
        else:
            s.bank.scan //= s.scan.recv
            s.states.scan_rdy //= s.scan.recv.rdy
            s.phase_on //= 0
        s.scan.send //= s.encoder.recv

        s.encoder.phase //= s.phase_on
        s.encoder.made //= s.bank.made
        s.encoder.left_out //= s.bank.left_out
        for name in (
            *WINDOW,
            "mode",
            "threshold",
            "frame_number",
            "resync",
            "exposure",
            "n_cm",
            "t_int",
            "calibration",
        ):
            connect(getattr(s.encoder, name), getattr(cfg, name))

        s.link.loop_enable //= cfg.loop_enable
        s.link.frame //= s.encoder.send
        s.link.loop //= s.regs.loop
        s.link_data //= s.link.send.msg
        s.link.send.rdy //= s.link_rdy

        s.frame_status.start //= s.regs.start
        s.frame_status.seq_busy //= s.seq.busy
        s.frame_status.seq_err //= s.seq.cfg_err
        s.frame_status.amp_start //= s.seq.amp_start
        s.frame_status.amp_err //= s.amp.cfg_err
        s.frame_status.frame_sync //= s.encoder.frame_sync

        s.regs.state //= s.states.state
        s.states.amp_busy //= s.amp.busy
        for name in ("pixel_reset", "integrate", "cm_reset", "ref_ctl", "read"):
            connect(getattr(s.states, name), getattr(s.amp, name))
        s.states.step_val //= s.seq.step.val
        s.states.step_kind //= s.seq.step.msg.kind
        s.states.step_rdy //= s.bank.step.rdy
        s.states.encoder_state //= s.encoder.state
        s.states.hold_free //= s.seq.hold_free
        s.states.bank_idle //= s.bank.idle
        s.states.scan_val //= s.bank.scan.val
        s.states.link_val //= s.link.send.val
        s.states.link_rdy //= s.link_rdy
        s.states.loop_val //= s.regs.loop.val

        s.gate.low //= s.resets.chip
        place = 0
        for name, levels in gated.items():
            past = place + levels._dsl.Type.nbits
            connect(s.gate.levels[place:past], levels)
            connect(getattr(s, name), s.gate.pins[place:past])
            place = past

        # Logic
        if has_phase:

            @update
            def up_phase():
                s.phase_on @= s.regs.cfg.phase & (s.regs.cfg.mode[0:2] == TOF)

        @update
        def up_selected():
            s.selected @= ~s.csn

        @update
        def up_converting():
            s.converting @= ~s.bank.idle

    def line_trace(s):
        return f"{s.seq.line_trace()} {s.bank.line_trace()} {s.encoder.line_trace()}"
