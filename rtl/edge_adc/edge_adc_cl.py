"""EdgeAdc at cycle level: the RTL's cycles and stalls, data by models.digital.sar.decisions."""

from pymtl3 import Bits7, Bits8, Component, InPort, OutPort, update_ff
from pymtl3.stdlib.stream.ifcs import SendIfcRTL

from models.digital.sar import BITS, decisions


class EdgeAdcCL(Component):
    """Same ports as EdgeAdc, and the same values on them in every cycle."""

    def construct(s):
        s.go = InPort()
        s.unsigned_ = InPort()
        s.threshold = InPort(Bits7)
        s.comparator = InPort()
        s.dac = OutPort(Bits8)
        s.free = OutPort()
        s.busy = OutPort()
        s.out = SendIfcRTL(Bits8)
        s.converted = OutPort()

        s.run = None        # the conversion under way
        s.left = 0          # decisions it takes at most from here
        s.waiting = None    # a result that finds the one before not taken yet
        s.result = None     # the result at the port

        @update_ff
        def behave():
            idle = s.run is None and s.waiting is None
            ending = s.left == 1 and s.result is None
            if s.out.val & s.out.rdy:
                s.result = None
            if s.run is not None:
                s.left -= 1
                try:
                    s.dac <<= s.run.send(bool(s.comparator))
                except StopIteration as end:
                    s.run, s.left, s.waiting = None, 0, end.value
            if s.waiting is not None and s.result is None:
                s.result, s.waiting = s.waiting, None
            if s.go and (idle or ending):
                window = 0 if s.unsigned_ else int(s.threshold)
                s.run = decisions(bool(s.unsigned_), window)
                s.left = BITS + 2 * bool(window)
                s.dac <<= next(s.run)
            if s.reset:
                s.run = s.waiting = s.result = None
                s.left = 0
            s.busy <<= s.run is not None or s.waiting is not None
            s.free <<= (s.run is None and s.waiting is None) or (0 < s.left <= 2 and s.result is None)
            s.out.val <<= s.result is not None
            if s.result is not None:
                code, converted = s.result
                s.out.msg <<= code & 0xFF
                s.converted <<= converted

    def line_trace(s):
        return f"{s.left:2d} {s.dac} {'*' if s.result else ' '}"
