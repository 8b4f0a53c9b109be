"""ReadoutSeq at cycle level: the RTL's cycles and stalls, data from the golden scan."""

from pymtl3 import Component, update, update_ff

from talbot.models.parameters import MODES, ParameterError
from talbot.rtl.messages import END, FRAME, ROW
from talbot.rtl.readout_seq.golden import configured_scan, lead, mark, row_steps, tile_of
from talbot.rtl.readout_seq.ports import declare_ports, edges


class ReadoutSeqCL(Component):
    """The ports of ReadoutSeq (README.md), and the same values in every cycle."""

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
            if s.reset:
                s.clear()
            else:
                s.tick()
            s.busy <<= s.frame is not None
            s.done <<= s.ended
            s.cfg_err <<= s.error
            s.amp_start <<= s.started
            s.amp_row <<= s.amplified
            s.reset_row <<= s.opened
            s.slot_resets <<= s.resetting
            s.slot_reads <<= s.waiting == 0
            s.hold_free <<= s.held is None
            s.step.val <<= s.offer is not None
            if s.offer is not None:
                s.step.msg <<= s.offer
            s.cycles <<= s.count

    def clear(s):
        """Set the state after a reset."""
        s.frame = None  # generator of the frame, a cycle a step
        s.to_reset = s.to_read = None  # rows of the slots to come
        s.waiting = 0  # slots from the current one to the first that reads
        s.amplified = s.opened = 0  # the rows that they read and reset last
        s.resetting = False
        s.integrating = s.started = s.failing = s.ended = s.error = False
        s.held = None  # row in the sample-and-holds
        s.offer = None  # message at the port
        s.count = 0

    def tick(s):
        """Update the state at the clock edge."""
        was_started, s.started, s.ended = s.started, False, False
        if s.frame is None:
            if s.start:
                s.begin()
            return
        s.count += 1
        if s.integrating and not was_started:
            if s.amp_err:
                s.integrating, s.failing = False, True
            elif s.amp_done:
                s.integrating = False
                if s.waiting:
                    s.launch()
                else:
                    s.held = s.amplified
                    if s.overlap or lead(s):
                        s.launch()
        if s.failing and (s.offer is None or s.step.rdy):
            slot = s.count, s.amplified, s.opened, s.resetting, s.waiting
            s.clear()
            s.count, s.amplified, s.opened, s.resetting, s.waiting = slot
            s.error = True
        else:
            next(s.frame, None)

    def begin(s):
        """Accept or refuse `start` in idle."""
        try:
            scan = configured_scan(s, *s.size)
        except ParameterError:
            s.error = True
            return
        s.error, s.count = False, 0
        s.to_reset, s.to_read = ([int(row) for row in scan.row_list] for _ in range(2))
        s.waiting = lead(s) + 1
        s.frame = s.walk(scan)
        next(s.frame)

    def launch(s):
        """Start the amplifiers' next slot, if a row is left to read."""
        if s.to_read:
            s.waiting = max(s.waiting - 1, 0)
            s.resetting = bool(s.to_reset)
            if s.to_reset:
                s.opened = s.to_reset.pop(0)
            if not s.waiting:
                s.amplified = s.to_read.pop(0)
            s.integrating = s.started = True

    def walk(s, scan):
        """Generate a frame; every yield is one clock cycle."""
        s.launch()
        yield  # `amp_start`
        yield  # and the cycle of a possible `amp_err`
        yield from s.send(mark(FRAME, scan.lanes))
        while s.integrating or s.held is not None:
            yield
            while s.held is None:
                yield
            yield from s.send(mark(ROW, scan.lanes, s.held))
            for step in row_steps(scan, s.held):
                yield from s.send(step)
            yield
            while not s.bank_idle:
                yield
            s.held = None
            if not s.integrating:
                s.launch()
        yield from s.send(mark(END, scan.lanes))
        s.frame, s.ended = None, True

    def send(s, msg):
        """Offer ``msg`` until it is taken."""
        s.offer = msg
        yield
        while not s.step.rdy:
            yield
        s.offer = None

    def line_trace(s):
        return f"amp {s.amplified} {s.step}"
