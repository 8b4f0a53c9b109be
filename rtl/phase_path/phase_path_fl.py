"""PhasePath at functional level: models.digital.phase.phase_samples at the ports."""

from collections import deque

from pymtl3 import Bits8, Component, InPort, update_ff
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.models.digital.phase import phase_samples
from talbot.models.parameters import ChipParameters
from talbot.rtl.messages import SAMPLE, ScanMsg


class PhasePathFL(Component):
    """Functional level of PhasePath: a message taken a cycle, the same messages from an unbounded queue."""

    def construct(s, lanes=8, divider="radix4", n_frac=8, iterations=10):
        chip = ChipParameters(lanes, divider, n_frac, iterations)
        s.recv = RecvIfcRTL(ScanMsg)
        s.on = InPort()
        s.noise_floor = InPort(Bits8)
        s.send = SendIfcRTL(ScanMsg)

        s.taps = [[]]  # samples of a step, a list per tap
        s.queue = deque()

        def take(kind, data):
            if kind != SAMPLE:
                s.queue.append(ScanMsg(kind, data))
            elif not s.on:
                s.queue.append(ScanMsg(kind, data & 0xFF))
            else:
                s.taps[-1].append(data & 0xFF)
                if data >> 9 and len(s.taps) == 4:
                    pairs = zip(*phase_samples(list(zip(*s.taps)), chip, int(s.noise_floor)))
                    s.queue.extend(ScanMsg(SAMPLE, int(value)) for pair in pairs for value in pair)
                    s.taps = [[]]
                elif data >> 9:
                    s.taps.append([])

        @update_ff
        def behave():
            if s.reset:
                s.taps = [[]]
                s.queue.clear()
            else:
                if s.send.val & s.send.rdy:
                    s.queue.popleft()
                if s.recv.val & s.recv.rdy:
                    take(int(s.recv.msg.kind), int(s.recv.msg.data))
            s.recv.rdy <<= ~s.reset
            s.send.val <<= bool(s.queue)
            if s.queue:
                s.send.msg <<= s.queue[0]

    def line_trace(s):
        return f"{s.recv} {len(s.queue)} {s.send}"
