"""ReadoutSeq at RTL: RowWalk and StepWalk find the next row and step, the control here decides when."""

from pymtl3 import Component, Wire, concat, update, update_ff, zext

from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.rtl.readout_seq.ports import declare_ports, edges
from talbot.rtl.readout_seq.row_walk_rtl import RowWalk
from talbot.rtl.readout_seq.step_walk_rtl import StepWalk

IDLE, CHECK, WAIT, DRAIN = range(4)
OFFER = 4  # and the message's kind in the lower bits
RAW, TOF = 2, 3


class ReadoutSeq(Component):
    """ASP readout sequencing (README.md).

    rows, cols: pixels of the array. lanes: converters, a power of two. order: pixel type of each position in a
    tile of tile_rows x tile_cols, row by row.
    """

    def construct(s, rows, cols, lanes, order, tile_rows=4, tile_cols=6):
        last_row, rows_there, last_col, cols_there = edges(rows, cols, lanes, order, tile_rows, tile_cols)
        THERE = sum(1 << p for p in range(24) if p % 6 < cols_there)

        # Interface
        declare_ports(s, lanes)

        # Components
        s.rows = RowWalk(tile_rows, last_row, rows_there)  # that are read
        s.ahead = RowWalk(tile_rows, last_row, rows_there)  # that are reset
        s.unused_columns = Wire(6)
        s.steps = StepWalk(lanes, last_col, cols_there)
        s.state = Wire(3)
        s.integrating = Wire()  # the amplifiers work on a slot: they reset, expose or read a row
        s.lead = Wire(10)  # slots from a row's reset to its read
        s.wait_slots = Wire(10)  # from the current slot to the first one that reads
        s.wait_over = Wire()  # the next slot reads
        s.overlaps = Wire()
        s.failing = Wire()  # aborted as soon as the offered message is taken
        s.row = Wire(10)  # the row that converts
        s.count_low, s.count_high = Wire(8), Wire(56)  # of `cycles`, the higher bits clocked at a carry alone
        s.unmasked = Wire(24)  # by position, six to a row of the tile
        s.columns = Wire(24)  # of these, those in tile column col0 that exist
        s.window_ok = Wire()
        s.idle, s.taken, s.listening, s.failed, s.landed, s.drained = Wire(), Wire(), Wire(), Wire(), Wire(), Wire()
        s.over, s.next_slot = Wire(), Wire()
        s.accept, s.launch, s.abort = Wire(), Wire(), Wire()

        # Connections
        for row in range(4):
            for k in range(6):
                there = row < tile_rows and k < tile_cols
                s.unmasked[6 * row + k] //= s.mask[order[tile_cols * row + k]] if there else 0
        s.rows.columns //= s.columns
        s.rows.row0 //= s.row0
        s.rows.row1 //= s.row1
        s.rows.decimation //= s.decimation
        s.rows.row //= s.amp_row
        s.ahead.columns //= s.columns
        s.ahead.row0 //= s.row0
        s.ahead.row1 //= s.row1
        s.ahead.decimation //= s.decimation
        s.ahead.first //= s.idle
        s.ahead.look //= s.next_slot
        s.ahead.row //= s.reset_row
        s.ahead.row_columns //= s.unused_columns
        s.steps.columns //= s.rows.row_columns
        s.steps.load //= s.landed
        s.steps.col0 //= s.col0
        s.steps.col1 //= s.col1
        s.steps.decimation //= s.decimation
        s.steps.group //= s.step.msg.group
        s.steps.k //= s.step.msg.k
        s.steps.sub //= s.step.msg.sub
        s.steps.en //= s.step.msg.en
        s.step.val //= s.state[2]
        s.step.msg.row //= s.row
        s.step.msg.kind //= s.state[0:2]
        s.cycles[0:8] //= s.count_low
        s.cycles[8:64] //= s.count_high

        # Logic: configuration
        @update
        def up_configuration():
            s.window_ok @= (
                (s.row0 <= s.row1)
                & (zext(s.row1, 9) <= last_row)  # nine bits: 255 may be the last
                & (s.col0 <= s.col1)
                & (zext(s.col1, 9) <= last_col)
            )
            s.four_tap @= s.mode == TOF
            s.lead @= s.exposure
            if s.mode == TOF:  # each tap resets the row itself
                s.lead @= 0
            s.overlaps @= s.overlap | (s.lead != 0)  # else a slot's time would follow the conversions
            s.steps.subs @= concat(s.mode == TOF, (s.mode == TOF) | (s.mode == RAW))

        # Logic: events of this cycle
        @update
        def up_events():
            s.idle @= s.state == IDLE
            s.busy @= s.state != IDLE
            s.taken @= s.step.val & s.step.rdy
            s.steps.advance @= s.taken & (s.state == OFFER + SAMPLE)
            s.listening @= s.integrating & ~s.amp_start  # amp_err may be of the start before
            s.failed @= s.listening & s.amp_err
            s.over @= s.listening & s.amp_done & ~s.amp_err
            s.landed @= s.over & s.slot_reads
            s.drained @= (s.state == DRAIN) & s.bank_idle
            s.next_slot @= (
                (s.idle & s.start) | (s.over & ~s.slot_reads) | (s.overlaps & s.landed) | (~s.overlaps & s.drained)
            )

        @update
        def up_slot():
            s.slot_reads @= s.wait_slots == 0
            s.slot_opens @= s.slot_resets & (s.lead != 0)
            s.wait_over @= s.wait_slots[1:10] == 0
            if s.idle:
                s.wait_over @= s.lead == 0
            s.rows.look @= s.next_slot & s.wait_over
            s.rows.first @= s.idle | ~s.slot_reads

        @update
        def up_columns():
            s.columns @= 0
            if s.next_slot | s.landed:  # the condition only spares simulators the work
                s.columns @= s.unmasked
                if s.col0 == last_col:
                    s.columns @= s.columns & THERE

        @update
        def up_decisions():
            s.accept @= s.idle & s.start & s.window_ok & s.ahead.found  # found only when looked for
            s.launch @= s.accept | (~s.idle & s.next_slot & (s.rows.found | ~s.wait_over))
            s.ahead.move @= s.launch & s.ahead.found
            s.rows.move @= s.launch & s.rows.found
            s.abort @= (s.failed | s.failing) & (~s.step.val | s.step.rdy)

        # Logic: state
        @update_ff
        def up_state():
            if s.reset:
                s.state <<= IDLE
            elif s.abort:
                s.state <<= IDLE
            elif s.state == IDLE:
                if s.accept:
                    s.state <<= CHECK
            elif s.state == CHECK:
                if ~s.amp_start:  # by now the amplifiers' control would have refused its durations
                    s.state <<= OFFER + FRAME
            elif s.state == WAIT:
                if s.landed | ~s.hold_free:
                    s.state <<= OFFER + ROW
            elif s.state == DRAIN:
                if s.bank_idle:
                    s.state <<= WAIT if s.integrating | s.launch else OFFER + END
            elif s.step.rdy:
                if s.state == OFFER + FRAME:
                    s.state <<= WAIT
                elif s.state == OFFER + ROW:
                    s.state <<= OFFER + SAMPLE
                elif s.state == OFFER + END:
                    s.state <<= IDLE
                elif s.steps.last:
                    s.state <<= DRAIN

        @update_ff
        def up_rows():
            if s.reset:
                s.amp_start <<= 0
                s.slot_resets <<= 0
                s.wait_slots <<= 0
                s.integrating <<= 0
                s.failing <<= 0
                s.hold_free <<= 1
                s.row <<= 0
            else:
                s.amp_start <<= s.launch
                if s.launch:
                    s.slot_resets <<= s.ahead.found
                    if s.idle:
                        s.wait_slots <<= s.lead
                    elif ~s.slot_reads:
                        s.wait_slots <<= s.wait_slots - 1
                s.integrating <<= s.launch | (s.integrating & ~s.over & ~s.failed)
                s.failing <<= (s.failed | s.failing) & ~s.abort
                if s.landed:
                    s.hold_free <<= 0
                    s.row <<= s.amp_row
                elif s.drained | s.abort:
                    s.hold_free <<= 1

        @update_ff
        def up_status():
            if s.reset:
                s.done <<= 0
                s.cfg_err <<= 0
                s.count_low <<= 0
                s.count_high <<= 0
            else:
                s.done <<= s.taken & (s.state == OFFER + END)
                if s.abort | (s.idle & s.start):
                    s.cfg_err <<= ~s.accept
                if s.accept:
                    s.count_low <<= 0
                    s.count_high <<= 0
                elif s.busy:
                    s.count_low <<= s.count_low + 1
                    if s.count_low == 255:
                        s.count_high <<= s.count_high + 1

    def line_trace(s):
        states = ("idle", "check", "wait", "drain", "frame", "row", "steps", "end")
        amp = f"amp {s.rows.line_trace()}{'*' if s.integrating else ' '}"
        return f"{states[int(s.state)]:5} {amp} {s.steps.line_trace()}"
