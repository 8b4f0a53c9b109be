"""EdgeAdc at cycle level: the RTL's cycles and stalls, data from models.digital.sar.decisions."""

from pymtl3 import Component, update_ff

from talbot.models.digital.sar import BITS, decisions
from talbot.rtl.edge_adc.ports import declare_ports


class LaneCycles:
    """One lane without ports, a cycle a call; AdcBankCL has one per lane.

    dac: code at the DAC. result: (code, converted) at the output, or None.
    """

    def __init__(self) -> None:
        self.run = None  # the conversion in progress
        self.left = 0  # decisions left at most
        self.waiting = None  # a result while the previous one is not taken yet
        self.result = None
        self.dac = 0

    def tick(self, go: bool, unsigned: bool, threshold: int, ternary: bool, comparator: bool, taken: bool) -> None:
        """End a cycle with these inputs, in which ``result`` was ``taken`` or not."""
        startable = not self.busy or (self.left == 1 and self.result is None)
        if taken:
            self.result = None
        if self.run is not None:
            self.left -= 1
            try:
                self.dac = self.run.send(comparator)
            except StopIteration as end:
                self.run, self.left, self.waiting = None, 0, end.value
        if self.waiting is not None and self.result is None:
            self.result, self.waiting = self.waiting, None
        if go and startable:
            self.run = decisions(unsigned, threshold, ternary)
            self.left = BITS + (2 if ternary or threshold and not unsigned else 0)
            self.dac = next(self.run)

    @property
    def busy(self) -> bool:
        """True while a conversion runs or its result waits."""
        return self.run is not None or self.waiting is not None

    @property
    def free(self) -> bool:
        """True if a go is accepted in the next cycle."""
        return not self.busy or (0 < self.left <= 2 and self.result is None)


class EdgeAdcCL(Component):
    """Cycle level of EdgeAdc: the same ports, and the same values in every cycle."""

    def construct(s):
        declare_ports(s)

        s.lane = LaneCycles()

        @update_ff
        def behave():
            if s.reset:
                s.lane = LaneCycles()
                s.converted <<= 0
            else:
                s.lane.tick(
                    bool(s.go),
                    bool(s.unsigned_),
                    int(s.threshold),
                    bool(s.ternary),
                    bool(s.comparator),
                    bool(s.out.val & s.out.rdy),
                )
            s.dac <<= s.lane.dac
            s.busy <<= s.lane.busy
            s.free <<= s.lane.free
            s.out.val <<= s.lane.result is not None
            if s.lane.result is not None:
                code, converted = s.lane.result
                s.out.msg <<= code & 0xFF
                s.converted <<= converted

    def line_trace(s):
        return f"{s.lane.left:2d} {s.dac} {'*' if s.lane.result else ' '}"
