"""EdgeAdc at functional level: models.digital.sar.decisions at the ports."""

from collections import deque

from pymtl3 import Component, update_ff

from talbot.models.digital.sar import decisions
from talbot.rtl.edge_adc.ports import declare_ports


class EdgeAdcFL(Component):
    """Functional level of EdgeAdc: one conversion at a time, the same results from an unbounded queue."""

    def construct(s):
        declare_ports(s)

        s.run, s.results = None, deque()

        @update_ff
        def behave():
            if s.out.val & s.out.rdy:
                s.results.popleft()
            if s.reset:
                s.run = None
                s.results.clear()
                s.dac <<= 0
                s.converted <<= 0
            elif s.run is not None:
                try:
                    s.dac <<= s.run.send(bool(s.comparator))
                except StopIteration as end:
                    s.run = None
                    s.results.append(end.value)
            elif s.go:
                s.run = decisions(bool(s.unsigned_), int(s.threshold), bool(s.ternary))
                s.dac <<= next(s.run)
            s.busy <<= s.run is not None
            s.free <<= s.run is None
            s.out.val <<= bool(s.results)
            if s.results:
                code, converted = s.results[0]
                s.out.msg <<= code & 0xFF
                s.converted <<= converted

    def line_trace(s):
        return f"{s.dac} {len(s.results)}"
