"""EdgeAdc at RTL: control of one successive-approximation lane with a zero window."""

from pymtl3 import Bits3, Bits7, Bits8, Component, InPort, OutPort, Wire, concat, update, update_ff, zext
from pymtl3.stdlib.stream.ifcs import SendIfcRTL

IDLE, ABOVE, BELOW, SEARCH, WAIT = range(5)
MIDDLE = 0x80                 # code 0 in offset binary, and the first trial of the search


class EdgeAdc(Component):

    def construct(s):
        # Interface
        s.go = InPort()
        s.unsigned_ = InPort()
        s.threshold = InPort(Bits7)
        s.comparator = InPort()
        s.dac = OutPort(Bits8)
        s.free = OutPort()
        s.busy = OutPort()
        s.out = SendIfcRTL(Bits8)
        s.converted = OutPort()

        # Components
        s.state = Wire(Bits3)
        s.trial = Wire(Bits8)       # at the DAC; holds the code (offset binary) in WAIT
        s.mask = Wire(Bits8)        # one-hot, the bit on trial
        s.above = Wire()            # first decision of the window
        s.full = Wire()             # `code` waits to be taken
        s.code = Wire(Bits8)
        s.was_converted = Wire()
        s.waits_converted = Wire()  # the flag of the code that waits in `trial`

        s.window = Wire()
        s.room = Wire()
        s.start = Wire()
        s.zero = Wire()           # the window says zero
        s.last = Wire()
        s.kept = Wire(Bits8)
        s.magnitude = Wire(Bits8)
        s.result = Wire(Bits8)

        # Connections
        s.dac //= s.trial
        s.out.msg //= s.code
        s.out.val //= s.full
        s.converted //= s.was_converted

        # Logic: status, from registers only
        @update
        def status():
            s.window @= ~s.unsigned_ & (s.threshold != 0)
            s.last @= (s.state == SEARCH) & s.mask[0]
            s.busy @= s.state != IDLE
            s.free @= (s.state == IDLE) | ((s.state == SEARCH) & (s.mask[0] | s.mask[1]) & ~s.full)

        @update
        def control():
            s.start @= s.go & ((s.state == IDLE) | (s.last & ~s.full))
            s.room @= ~s.full | s.out.rdy
            s.zero @= (s.state == BELOW) & s.comparator & ~s.above

        @update
        def outcome():
            s.kept @= s.trial & ~s.mask
            if s.comparator | (s.state == WAIT):
                s.kept @= s.trial
            s.result @= 0
            s.magnitude @= 0
            if s.last | (s.state == WAIT):      # the condition only spares simulators the work
                s.result @= s.kept
                if ~s.unsigned_:
                    s.result @= s.kept ^ MIDDLE
                    s.magnitude @= s.result if s.kept[7] else ~s.result + 1
                    if s.magnitude < zext(s.threshold, 8):
                        s.result @= 0

        @update_ff
        def advance():
            if s.reset:
                s.state <<= IDLE
                s.trial <<= 0
                s.mask <<= 0
                s.above <<= 0
                s.full <<= 0
                s.code <<= 0
                s.was_converted <<= 0
                s.waits_converted <<= 0
            else:
                if s.full & s.out.rdy:
                    s.full <<= 0
                if s.state == ABOVE:
                    s.above <<= s.comparator
                    s.trial <<= 129 - zext(s.threshold, 8)
                    s.state <<= BELOW
                elif (s.state == SEARCH) & ~s.mask[0]:
                    s.trial <<= s.kept | (s.mask >> 1)
                    s.mask <<= s.mask >> 1
                elif (s.state == BELOW) & ~s.zero:
                    s.trial <<= MIDDLE
                    s.state <<= SEARCH
                elif s.state != IDLE:       # a result: the window's zero, the last bit, or one that waits
                    if s.room:
                        s.code <<= s.result
                        s.was_converted <<= s.waits_converted if s.state == WAIT else s.last
                        s.full <<= 1
                        s.state <<= IDLE
                    else:
                        s.trial <<= MIDDLE if s.state == BELOW else s.kept
                        s.waits_converted <<= s.waits_converted if s.state == WAIT else s.last
                        s.state <<= WAIT
                if s.start:
                    s.trial <<= concat(s.window, s.threshold) if s.window else Bits8(MIDDLE)     # level(T), or the MSB
                    s.mask <<= MIDDLE
                    s.state <<= ABOVE if s.window else SEARCH

    def line_trace(s):
        return f"{'iabsw'[int(s.state)]}{s.trial}{'*' if s.full else ' '}"
