"""EdgeAdc at RTL. The lowest 1 of the trial marks the bit on trial: all bits below it are still 0.

Nested conditions let a simulator skip the logic of an idle lane."""

from pymtl3 import Bits3, Bits8, Component, Wire, update, update_ff, zext

from talbot.rtl.edge_adc.ports import declare_ports

# ABOVE and BELOW: first and second decision of the window; OUTSIDE: the second, after the first found "above".
# WAIT, WAIT_ZERO: a result waits until the previous one is taken; the code of WAIT is in `trial`.
# In ternary mode BELOW and OUTSIDE end the conversion; a 1 waits in OUTSIDE, a 0 in WAIT_ZERO, a -1 in WAIT.
IDLE, ABOVE, BELOW, OUTSIDE, SEARCH, WAIT, WAIT_ZERO = range(7)
MIDDLE = 0x80  # code 0 in offset binary, and the first trial of the search


class EdgeAdc(Component):
    """Control of one successive-approximation lane with a zero window (README.md)."""

    def construct(s):
        # Interface
        declare_ports(s)

        # Components
        s.state = Wire(Bits3)
        s.trial = Wire(Bits8)  # at the DAC
        s.full = Wire()  # `code` waits to be taken
        s.code = Wire(Bits8)
        s.search_made = Wire()  # by a search

        s.kept = Wire(Bits8)  # the trial after the comparator's decision
        s.result = Wire(Bits8)
        s.magnitude = Wire(Bits8)
        s.found = Wire()  # `result` is valid

        # Connections
        s.dac //= s.trial
        s.out.msg //= s.code
        s.out.val //= s.full
        s.converted //= s.search_made

        # Logic: status, from registers only
        @update
        def up_status():
            s.busy @= s.state != IDLE
            s.free @= 1
            if s.state != IDLE:
                s.free @= (s.state == SEARCH) & ((s.trial & 3) != 0) & ~s.full

        # Logic: the result of a conversion
        @update
        def up_result():
            s.found @= 0
            s.kept @= 0
            s.result @= 0
            s.magnitude @= 0
            if s.state >= BELOW:
                s.found @= (s.state >= WAIT) | ((s.state == BELOW) & s.comparator) | s.ternary
                if s.ternary:
                    if s.state == OUTSIDE:
                        s.result @= 1
                    elif (s.state == WAIT) | ((s.state == BELOW) & ~s.comparator):
                        s.result @= 0xFF
                elif (s.state == SEARCH) | (s.state == WAIT):
                    s.found @= (s.state == WAIT) | s.trial[0]
                    s.kept @= s.trial
                    if (s.state == SEARCH) & ~s.comparator:
                        s.kept @= s.trial & (s.trial - 1)
                    s.result @= s.kept
                    if ~s.unsigned_:
                        s.result @= s.kept ^ MIDDLE
                        s.magnitude @= s.result if s.kept[7] else ~s.result + 1
                        if s.magnitude < zext(s.threshold, 8):
                            s.result @= 0

        @update_ff
        def up_state():
            if s.reset:
                s.state <<= IDLE
                s.trial <<= 0
                s.full <<= 0
                s.code <<= 0
                s.search_made <<= 0
            else:
                if s.full & s.out.rdy:
                    s.full <<= 0
                if (s.state != IDLE) | s.go:  # else the lane rests, and its clock may stop
                    if s.state != IDLE:
                        if s.found:
                            if ~s.full | s.out.rdy:
                                s.state <<= IDLE
                                s.full <<= 1
                                s.code <<= s.result
                                s.search_made <<= ((s.state == SEARCH) | (s.state == WAIT)) & ~s.ternary
                            elif s.state == SEARCH:
                                s.trial <<= s.kept
                                s.state <<= WAIT
                            elif s.state == BELOW:
                                s.state <<= WAIT_ZERO if s.comparator else WAIT
                        elif s.state == SEARCH:
                            s.trial <<= s.kept | ((s.trial & (~s.trial + 1)) >> 1)
                        elif s.state == ABOVE:
                            s.trial <<= 129 - zext(s.threshold, 8)  # level(1 - T)
                            s.state <<= OUTSIDE if s.comparator else BELOW
                        else:
                            s.trial <<= MIDDLE
                            s.state <<= SEARCH
                    if s.go:
                        if (s.state == IDLE) | ((s.state == SEARCH) & s.trial[0] & ~s.full):
                            s.trial <<= MIDDLE
                            s.state <<= SEARCH
                            if s.ternary | (~s.unsigned_ & (s.threshold != 0)):
                                s.trial <<= zext(s.threshold, 8) | MIDDLE  # level(T)
                                s.state <<= ABOVE

    def line_trace(s):
        return f"{'iaboswz'[int(s.state)]}{s.trial}{'*' if s.full else ' '}"
