"""ReadoutSeq at RTL: rolling shutter, row by row; the walks decide what comes next, this decides when."""

from pymtl3 import Bits4, Component, InPort, OutPort, Wire, update, update_ff, zext
from pymtl3.stdlib.stream.ifcs import SendIfcRTL

from rtl.messages import END, FRAME, ROW, SAMPLE, step_msg

from .row_walk_rtl import RowWalk
from .step_walk_rtl import StepWalk

IDLE, START, CHECK, SEND_FRAME, WAIT, SEND_ROW, STEPS, DRAIN, SEND_END = range(9)
EDGE, IMAGE, RAW, TOF = range(4)


class ReadoutSeq(Component):
    """ASP readout sequencing (README.md)."""

    def construct(s, rows, cols, lanes, order, tile_rows=4, tile_cols=6):
        last_row, last_col = -(-rows // tile_rows) - 1, -(-cols // tile_cols) - 1
        last_rows, last_cols = rows - last_row * tile_rows, cols - last_col * tile_cols

        # Interface
        s.start = InPort()
        s.mode = InPort(2)
        s.mask = InPort(24)
        s.row0, s.row1, s.col0, s.col1 = InPort(8), InPort(8), InPort(8), InPort(8)
        s.decimation = InPort(2)
        s.overlap = InPort()
        s.amp_done, s.amp_err, s.bank_idle = InPort(), InPort(), InPort()
        s.busy, s.done, s.cfg_err = OutPort(), OutPort(), OutPort()
        s.amp_start = OutPort()
        s.amp_row = OutPort(10)
        s.four_tap, s.hold_free = OutPort(), OutPort()
        s.step = SendIfcRTL(step_msg(lanes))
        s.cycles = OutPort(64)

        # Components
        s.row_walk = RowWalk(last_row, last_rows)
        s.steps = StepWalk(lanes, last_col, last_cols)
        s.state = Wire(4)
        s.amp_tile, s.amp_r = Wire(8), Wire(2)      # row that the amplifiers work on
        s.tile, s.r = Wire(8), Wire(2)              # row that converts
        s.sampled = Wire()      # the amplifiers' row lies in the sample-and-holds, not taken up yet
        s.holding = Wire()      # the sample-and-holds are in use
        s.ahead = Wire()        # the next row is under way while this one converts
        s.wanted = Wire(4)
        s.masked = Wire(24)     # the mask by position, six to a row of the tile
        s.columns = Wire(24)    # of these, what exists in tile col0
        s.row_columns = Wire(6)
        s.valid_window, s.searching = Wire(), Wire()
        s.take, s.restart, s.sent = Wire(), Wire(), Wire()
        s.row = Wire(10)
        s.restarted = Wire()        # amp_start for the next row, a cycle after it is known

        # Connections
        s.row_walk.row1 //= s.row1
        s.row_walk.first //= s.searching
        s.row_walk.wanted //= s.wanted
        s.steps.columns //= s.row_columns
        s.steps.col0 //= s.col0
        s.steps.col1 //= s.col1
        s.steps.decimation //= s.decimation

        for p in range(24):
            r, k = p // 6, p % 6
            if r < tile_rows and k < tile_cols:
                s.masked[p] //= s.mask[order[r * tile_cols + k]]
            else:
                s.masked[p] //= 0
        in_partial = sum(1 << p for p in range(24) if p % 6 < last_cols)

        # Logic: what there is to read
        @update
        def up_columns():
            s.columns @= s.masked
            if s.col0 == last_col:
                s.columns @= s.masked & in_partial
            for i in range(4):
                s.wanted[i] @= s.columns[6 * i:6 * i + 6] != 0
            s.valid_window @= ((s.row0 <= s.row1) & (s.row1 <= last_row)
                               & (s.col0 <= s.col1) & (s.col1 <= last_col))

        @update
        def up_search():
            s.searching @= s.state == IDLE
            s.row_walk.stride @= Bits4(1) << zext(s.decimation, 4)
            s.row_walk.tile @= s.amp_tile
            s.row_walk.r @= s.amp_r
            if s.searching:
                s.row_walk.tile @= s.row0
                s.row_walk.r @= 0

        @update
        def up_row():
            s.row @= zext(s.tile, 10) * tile_rows + zext(s.r, 10)
            s.amp_row @= zext(s.amp_tile, 10) * tile_rows + zext(s.amp_r, 10)
            s.row_columns @= s.columns[0:6]
            if s.r == 1:
                s.row_columns @= s.columns[6:12]
            elif s.r == 2:
                s.row_columns @= s.columns[12:18]
            elif s.r == 3:
                s.row_columns @= s.columns[18:24]

        # Logic: messages
        @update
        def up_step():
            s.step.val @= ((s.state == SEND_FRAME) | (s.state == SEND_ROW) | (s.state == SEND_END)
                           | ((s.state == STEPS) & (s.steps.en != 0)))
            s.step.msg.kind @= SAMPLE
            if s.state == SEND_FRAME:
                s.step.msg.kind @= FRAME
            elif s.state == SEND_ROW:
                s.step.msg.kind @= ROW
            elif s.state == SEND_END:
                s.step.msg.kind @= END
            s.step.msg.row @= s.row
            s.step.msg.group @= s.steps.group
            s.step.msg.k @= s.steps.k
            s.step.msg.sub @= s.steps.sub
            s.step.msg.en @= s.steps.en

        # Logic: when
        @update
        def up_moves():
            s.sent @= s.step.val & s.step.rdy
            s.take @= (s.state == WAIT) & s.sampled
            s.restart @= ((s.take & s.overlap)
                          | ((s.state == DRAIN) & s.bank_idle & ~s.overlap)) & s.row_walk.valid
            s.amp_start @= (s.state == START) | s.restarted
            s.steps.load @= (s.state == SEND_ROW) & s.sent
            s.steps.advance @= (s.state == STEPS) & (s.sent | (s.steps.en == 0))
            s.steps.subs @= 0
            if s.mode == RAW:
                s.steps.subs @= 1
            elif s.mode == TOF:
                s.steps.subs @= 3
            s.four_tap @= s.mode == TOF
            s.hold_free @= ~s.holding
            s.busy @= s.state != IDLE

        @update_ff
        def up_state():
            if s.reset:
                s.state <<= IDLE
                s.cfg_err <<= 0
                s.done <<= 0
            else:
                s.done <<= (s.state == SEND_END) & s.sent
                if s.state == IDLE:
                    if s.start:
                        s.cfg_err <<= ~(s.valid_window & s.row_walk.valid)
                        if s.valid_window & s.row_walk.valid:
                            s.state <<= START
                elif s.state == START:
                    s.state <<= CHECK
                elif s.state == CHECK:
                    # The amplifiers' control has seen its durations; nothing of the frame has left yet.
                    s.state <<= SEND_FRAME
                    if s.amp_err:
                        s.cfg_err <<= 1
                        s.state <<= IDLE
                elif s.state == SEND_FRAME:
                    if s.sent:
                        s.state <<= WAIT
                elif s.state == WAIT:
                    if s.sampled:
                        s.state <<= SEND_ROW
                elif s.state == SEND_ROW:
                    if s.sent:
                        s.state <<= STEPS
                elif s.state == STEPS:
                    if s.steps.advance & s.steps.last:
                        s.state <<= DRAIN
                elif s.state == DRAIN:
                    if s.bank_idle:
                        s.state <<= SEND_END
                        if s.ahead | s.restart:
                            s.state <<= WAIT
                elif s.sent:
                    s.state <<= IDLE

        @update_ff
        def up_rows():
            if s.reset:
                s.amp_tile <<= 0
                s.amp_r <<= 0
                s.tile <<= 0
                s.r <<= 0
                s.restarted <<= 0
                s.ahead <<= 0
            else:
                s.restarted <<= s.restart
                if s.restart | ((s.state == IDLE) & s.start):
                    s.amp_tile <<= s.row_walk.next_tile
                    s.amp_r <<= s.row_walk.next_r
                if s.take:
                    s.tile <<= s.amp_tile
                    s.r <<= s.amp_r
                    s.ahead <<= s.restart

        @update_ff
        def up_holds():
            if s.reset:
                s.sampled <<= 0
                s.holding <<= 0
            else:
                if s.amp_done:
                    s.sampled <<= 1
                elif s.take:
                    s.sampled <<= 0
                if s.amp_done:
                    s.holding <<= 1
                elif (s.state == IDLE) | ((s.state == DRAIN) & s.bank_idle):
                    s.holding <<= 0

        @update_ff
        def up_cycles():
            if s.reset:
                s.cycles <<= 0
            elif (s.state == IDLE) & s.start:
                s.cycles <<= 0
            elif s.busy:
                s.cycles <<= s.cycles + 1

    def line_trace(s):
        return f"{s.state} row {s.row} {s.step}"
