"""ReadoutSeq at functional level: the golden scan at the ports, one row after the other, without overlap."""

from collections import deque

from pymtl3 import Component, update, update_ff

from talbot.models.parameters import MODES, ParameterError
from talbot.rtl.messages import END, FRAME, ROW
from talbot.rtl.readout_seq.golden import configured_scan, lead, mark, row_steps, tile_of
from talbot.rtl.readout_seq.ports import declare_ports, edges


class ReadoutSeqFL(Component):
    """The ports of ReadoutSeq (README.md), and the same messages, queued by row; `overlap` has no effect."""

    def construct(s, rows, cols, lanes, order, tile_rows=4, tile_cols=6):
        edges(rows, cols, lanes, order, tile_rows, tile_cols)
        declare_ports(s, lanes)
        s.size = rows, cols, lanes, tile_of(order, tile_rows, tile_cols)
        s.clear()

        @update
        def up_four_tap():
            s.four_tap @= MODES[int(s.mode)] == "tof"
            s.slot_opens @= s.slot_resets & (lead(s) != 0)

        @update_ff
        def behave():
            s.started = s.ended = False
            if s.reset:
                s.clear()
            elif s.job is not None:
                s.count += 1
                if s.step.val & s.step.rdy:
                    s.queue.popleft()
                next(s.job, None)
            elif s.start:
                s.begin()
            s.busy <<= s.job is not None
            s.done <<= s.ended
            s.cfg_err <<= s.error
            s.amp_start <<= s.started
            s.amp_row <<= s.row
            s.reset_row <<= s.opened
            s.slot_resets <<= s.resetting
            s.slot_reads <<= s.reading
            s.hold_free <<= s.free
            s.step.val <<= bool(s.queue)
            if s.queue:
                s.step.msg <<= s.queue[0]
            s.cycles <<= s.count

    def clear(s):
        """Set the state after a reset."""
        s.job, s.queue = None, deque()  # the frame's generator, and messages to be sent
        s.row = s.opened = s.count = 0
        s.resetting, s.reading = False, True
        s.started = s.ended = False
        s.error, s.free = False, True

    def begin(s):
        """Accept or refuse `start` in idle."""
        try:
            s.job, s.error, s.count = s.frame(configured_scan(s, *s.size)), False, 0
            next(s.job)
        except ParameterError:
            s.job, s.error = None, True

    def frame(s, scan):
        """Generate a frame; every yield is one clock cycle."""
        opening = [mark(FRAME, scan.lanes)]  # not before AmpCtrl has accepted its durations
        rows, ahead = [int(row) for row in scan.row_list], lead(s)
        for slot in range(len(rows) + ahead):
            s.resetting, s.reading, s.started = slot < len(rows), slot >= ahead, True
            if s.resetting:
                s.opened = rows[slot]
            if s.reading:
                s.row = rows[slot - ahead]
            yield  # `amp_start`
            yield
            while not (s.amp_done or s.amp_err):
                s.queue.extend(opening)
                opening = []
                yield
            if s.amp_err:
                while s.queue:
                    yield
                s.job, s.error = None, True
                return
            if not s.reading:
                continue
            s.free = False
            s.queue.extend([*opening, mark(ROW, scan.lanes, s.row), *row_steps(scan, s.row)])
            opening = []
            while s.queue:
                yield
            yield
            while not s.bank_idle:
                yield
            s.free = True
        s.queue.append(mark(END, scan.lanes))
        while s.queue:
            yield
        s.job, s.ended = None, True

    def line_trace(s):
        return f"amp {s.row} {s.step} {len(s.queue)}"
