"""The register `state`: states of the machines and which handshakes wait, for a frame that does not end."""

from pymtl3 import Bits2, Bits3, Component, InPort, OutPort, concat, update

from talbot.rtl.amp_ctrl.amp_ctrl_rtl import CM_RESET, GUARD, IDLE, INTEGRATE, REFERENCE, RESET, SIGNAL
from talbot.rtl.reg_file import chip_state


class State(Component):
    """`state` is the register `state` of the map. The amplifier control's state is decoded from its outputs."""

    def construct(s):
        s.amp_busy = InPort()
        s.pixel_reset, s.integrate, s.cm_reset = InPort(), InPort(), InPort()
        s.ref_ctl, s.read = InPort(), InPort()
        s.step_val, s.step_rdy = InPort(), InPort()
        s.step_kind = InPort(Bits2)
        s.encoder_state = InPort(Bits3)
        s.hold_free = InPort()
        s.bank_idle = InPort()
        s.scan_val, s.scan_rdy = InPort(), InPort()
        s.link_val, s.link_rdy = InPort(), InPort()
        s.loop_val = InPort()
        s.state = OutPort(chip_state())

        @update
        def up_amp():
            s.state.amp_state @= IDLE
            if s.pixel_reset:
                s.state.amp_state @= RESET
            elif s.integrate:
                s.state.amp_state @= INTEGRATE
            elif s.cm_reset:
                s.state.amp_state @= CM_RESET
            elif s.ref_ctl:
                s.state.amp_state @= REFERENCE
            elif s.read:
                s.state.amp_state @= SIGNAL
            elif s.amp_busy:
                s.state.amp_state @= GUARD

        @update
        def up_state():
            s.state.seq_state @= concat(s.step_val, s.step_kind)  # as ReadoutSeq encodes it
            s.state.encoder_state @= s.encoder_state

        @update
        def up_waits():
            s.state.hold_taken @= ~s.hold_free
            s.state.converting @= ~s.bank_idle
            s.state.step_waits @= s.step_val & ~s.step_rdy
            s.state.scan_waits @= s.scan_val & ~s.scan_rdy
            s.state.link_waits @= s.link_val & ~s.link_rdy
            s.state.loop_waits @= s.loop_val

    def line_trace(s):
        return f"{s.state}"
