"""The status of the frame engine, as RegFile keeps it."""

from pymtl3 import Component, InPort, OutPort, Wire, update, update_ff

from talbot.rtl.reg_file import chip_status


class Status(Component):
    """`status`: busy, and one-cycle strobes.

    busy: from the start until `done`, so that no start comes between the frame's end and its `done`. done: the frame's
    last byte has left. cfg_err, amp_err: once for a start that is refused (`seq_err` and `amp_err` are levels). A reset
    ends the frame without a strobe.
    """

    def construct(s):
        s.start = InPort()
        s.seq_busy = InPort()
        s.seq_err = InPort()
        s.amp_start = InPort()
        s.amp_err = InPort()
        s.frame_sync = InPort()
        s.status = OutPort(chip_status())

        s.was_sync = Wire()
        s.seq_told = Wire()
        s.amp_told = Wire()

        @update
        def up_status():
            s.status.busy @= s.seq_busy | s.frame_sync | s.was_sync
            s.status.done @= s.was_sync & ~s.frame_sync & ~s.reset
            s.status.cfg_err @= s.seq_err & ~s.seq_told & ~s.reset
            s.status.amp_err @= s.amp_err & ~s.amp_told & ~s.reset

        @update_ff
        def up_told():
            if s.reset:
                s.was_sync <<= 0
                s.seq_told <<= 0
                s.amp_told <<= 0
            else:
                s.was_sync <<= s.frame_sync
                s.seq_told <<= s.seq_err & ~s.start
                s.amp_told <<= s.amp_err & ~s.amp_start

    def line_trace(s):
        return f"{s.status}"
