"""AmpCtrl at RTL: one state machine, one counter, every output a register."""

from pymtl3 import Component, Wire, update, update_ff

from talbot.rtl.amp_ctrl.ports import declare_ports

IDLE, GUARD, RESET, INTEGRATE, CM_RESET, REFERENCE, SIGNAL = range(7)


class AmpCtrl(Component):
    """The pixel amplifier's control FSM (README.md)."""

    def construct(s):
        # Interface
        declare_ports(s)

        # Components: what `start` captures, and the state
        s.d_reset, s.d_int, s.d_cm = Wire(16), Wire(16), Wire(16)
        s.d_settle, s.d_read, s.d_guard = Wire(16), Wire(16), Wire(16)
        s.d_n_cm, s.d_four = Wire(8), Wire()
        s.d_resets, s.d_reads = Wire(), Wire()
        s.d_opens = Wire()  # until `expose`
        s.state, s.after = Wire(3), Wire(3)  # after: the phase after the guard
        s.count = Wire(16)  # cycles left in the current phase after this one
        s.resets = Wire(8)  # common-mode resets left
        s.next_state, s.next_after = Wire(3), Wire(3)
        s.next_count = Wire(16)
        s.length = Wire(16)
        s.zero, s.accept, s.last, s.blocked = Wire(), Wire(), Wire(), Wire()
        s.sub_frame_done, s.next_tap, s.reading = Wire(), Wire(), Wire()

        # Logic
        @update
        def up_control():
            s.zero @= 0
            if s.start:  # the condition only spares simulators the work
                s.zero @= (
                    (s.t_reset == 0)
                    | (s.t_int == 0)
                    | (s.t_cm == 0)
                    | (s.t_settle == 0)
                    | (s.t_read == 0)
                    | (s.t_guard == 0)
                )
            s.accept @= s.start & (s.state == IDLE)
            s.last @= (s.state != IDLE) & (s.count == 0)
            s.blocked @= (s.state == GUARD) & (s.after == REFERENCE) & ~s.hold_free
            s.sub_frame_done @= s.last & (s.state == GUARD) & (s.after == IDLE)
            s.next_tap @= s.d_four & (s.tap != 3)

        @update
        def up_length():
            if s.after == RESET:
                s.length @= s.d_reset
            elif s.after == INTEGRATE:
                s.length @= s.d_int
            elif s.after == CM_RESET:
                s.length @= s.d_cm
            else:
                s.length @= s.d_settle

        @update
        def up_next():
            s.next_state @= s.state
            s.next_after @= s.after
            s.next_count @= s.count - 1
            if s.state == IDLE:
                s.next_count @= s.t_guard - 1
                if s.start & ~s.zero:
                    s.next_state @= GUARD
                    s.next_after @= RESET
            elif s.last:
                s.next_count @= s.d_guard - 1
                s.next_state @= GUARD
                if s.state == GUARD:
                    if s.blocked:
                        s.next_count @= 0
                    elif s.after != IDLE:
                        s.next_state @= s.after
                        s.next_count @= s.length - 1
                    elif s.next_tap:
                        # The guard behind `read` is the guard before the next tap's reset.
                        s.next_state @= RESET
                        s.next_count @= s.d_reset - 1
                    else:
                        s.next_state @= IDLE
                elif s.state == RESET:
                    s.next_after @= INTEGRATE
                elif s.state == INTEGRATE:
                    if s.resets != 0:
                        s.next_after @= CM_RESET
                    else:
                        s.next_after @= REFERENCE
                elif s.state == CM_RESET:
                    s.next_after @= INTEGRATE
                elif s.state == REFERENCE:
                    s.next_state @= SIGNAL
                    s.next_count @= s.d_read - 1
                else:
                    s.next_after @= IDLE

        @update
        def up_reading():
            s.reading @= s.d_reads & ((s.next_state == REFERENCE) | (s.next_state == SIGNAL))

        @update_ff
        def up_state():
            if s.reset:
                s.state <<= IDLE
                s.after <<= IDLE
                s.count <<= 0
                s.resets <<= 0
                s.tap <<= 0
                s.done <<= 0
                s.cfg_err <<= 0
                s.busy <<= 0
            else:
                s.state <<= s.next_state
                s.after <<= s.next_after
                s.count <<= s.next_count
                s.busy <<= s.next_state != IDLE
                s.done <<= s.sub_frame_done & ~s.next_tap
                if s.accept:
                    s.cfg_err <<= s.zero
                if s.sub_frame_done & s.d_four:
                    s.tap <<= s.tap + 1  # behind the last one it is 0 again
                if s.last & (s.state == RESET):
                    s.resets <<= s.d_n_cm
                elif s.last & (s.state == CM_RESET):
                    s.resets <<= s.resets - 1

        @update_ff
        def up_capture():
            if s.reset:
                s.d_reset <<= 0
                s.d_int <<= 0
                s.d_cm <<= 0
                s.d_settle <<= 0
                s.d_read <<= 0
                s.d_guard <<= 0
                s.d_n_cm <<= 0
                s.d_four <<= 0
                s.d_resets <<= 0
                s.d_reads <<= 0
                s.d_opens <<= 0
            elif s.accept:
                s.d_reset <<= s.t_reset
                s.d_int <<= s.t_int
                s.d_cm <<= s.t_cm
                s.d_settle <<= s.t_settle
                s.d_read <<= s.t_read
                s.d_guard <<= s.t_guard
                s.d_n_cm <<= s.n_cm
                s.d_four <<= s.four_tap
                s.d_resets <<= s.slot_resets
                s.d_reads <<= s.slot_reads
                s.d_opens <<= s.slot_opens
            elif s.next_state == INTEGRATE:
                s.d_opens <<= 0

        @update_ff
        def up_pins():
            if s.reset:
                s.pixel_reset <<= 0
                s.shutter <<= 0
                s.ref_ctl <<= 0
                s.integrate <<= 0
                s.expose <<= 0
                s.cm_reset <<= 0
                s.read <<= 0
                s.sample <<= 0
            else:
                s.pixel_reset <<= s.d_resets & (s.next_state == RESET)
                s.integrate <<= s.d_reads & (s.next_state == INTEGRATE)
                s.expose <<= s.d_opens & (s.next_state == INTEGRATE)
                s.cm_reset <<= s.d_reads & (s.next_state == CM_RESET)
                s.ref_ctl <<= s.d_reads & (s.next_state == REFERENCE)
                s.read <<= s.reading
                s.sample <<= s.reading & (s.next_count == 0)
                if s.next_state == INTEGRATE:
                    s.shutter <<= s.d_reads
                elif (s.next_state == IDLE) | ((s.next_state == GUARD) & (s.next_after == REFERENCE)):
                    s.shutter <<= 0

    def line_trace(s):
        return f"{s.state} {s.count}"
