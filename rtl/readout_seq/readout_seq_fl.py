"""ReadoutSeq at functional level: the golden scan behind the ports, one row after the other, nothing ahead of time."""

from collections import deque

from pymtl3 import Component, update, update_ff

from models.parameters import MODES, ParameterError
from rtl.messages import END, FRAME, ROW

from .golden import configured_scan, mark, row_steps, tile_of
from .ports import declare_ports, edges


class ReadoutSeqFL(Component):
    """Same ports and same messages as ReadoutSeq (README.md). A row's messages queue up; `overlap` changes nothing."""

    def construct(s, rows, cols, lanes, order, tile_rows=4, tile_cols=6):
        edges(rows, cols, lanes, order, tile_rows, tile_cols)
        declare_ports(s, lanes)
        s.size = rows, cols, lanes, tile_of(order, tile_rows, tile_cols)
        s.clear()

        @update
        def up_four_tap():
            s.four_tap @= MODES[int(s.mode)] == "tof"

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
            s.hold_free <<= s.free
            s.step.val <<= bool(s.queue)
            if s.queue:
                s.step.msg <<= s.queue[0]
            s.cycles <<= s.count

    def clear(s):
        """The state behind a reset."""
        s.job, s.queue = None, deque()  # the frame's generator, and messages on their way
        s.row = s.count = 0
        s.started = s.ended = False
        s.error, s.free = False, True

    def begin(s):
        """`start` in idle."""
        try:
            s.job, s.error, s.count = s.frame(configured_scan(s, *s.size)), False, 0
            next(s.job)
        except ParameterError:
            s.job, s.error = None, True

    def frame(s, scan):
        """The walk; every yield is one clock cycle."""
        opening = [mark(FRAME, scan.lanes)]  # not before the amplifiers' control has taken its durations
        for row in scan.row_list:
            s.row, s.started = int(row), True
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
