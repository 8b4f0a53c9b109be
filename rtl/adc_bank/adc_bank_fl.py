"""AdcBank at functional level: one step at a time, every lane converts by models.digital.sar.decisions."""

from collections import deque

from pymtl3 import Component, update, update_ff

from talbot.models.digital.sar import decisions
from talbot.rtl.adc_bank.ports import TERNARY, declare_ports
from talbot.rtl.messages import FRAME, SAMPLE, ScanMsg


class AdcBankFL(Component):
    """Functional level of AdcBank: the same ports and messages, from an unbounded queue."""

    def construct(s, lanes=8):
        declare_ports(s, lanes)

        s.runs = {}  # lane -> its decisions in progress
        s.done = {}  # lane -> (code, converted) of the current step
        s.queue = deque()  # (ScanMsg, converted or None)
        s.codes = [0] * lanes

        def convert():
            if s.hold:
                how = bool(s.unsigned_), int(s.threshold), s.mode == TERNARY
                s.runs = {lane: decisions(*how) for lane in range(lanes) if s.en[lane]}
                s.codes[:] = [next(s.runs[lane]) if lane in s.runs else code for lane, code in enumerate(s.codes)]
                return
            for lane, run in list(s.runs.items()):
                try:
                    s.codes[lane] = run.send(bool(s.comparator[lane]))
                except StopIteration as end:
                    s.done[lane] = end.value
                    del s.runs[lane]
            if s.done and not s.runs:
                for lane in sorted(s.done):
                    code, converted = s.done[lane]
                    last = lane == max(s.done)
                    s.queue.append((ScanMsg(SAMPLE, last << 9 | code & 0xFF), converted))
                s.done = {}

        def leave(msg, converted):
            if converted is not None:
                s.made <<= s.made + int(converted)
                s.left_out <<= s.left_out + int(not converted)
            elif msg.kind == FRAME:
                s.made <<= 0
                s.left_out <<= 0

        @update_ff
        def behave():
            taken = bool(s.step.val & s.step.rdy) and not s.reset
            starts = taken and s.step.msg.kind == SAMPLE
            if s.reset:
                s.runs, s.done, s.codes = {}, {}, [0] * lanes
                s.queue.clear()
                s.made <<= 0
                s.left_out <<= 0
            else:
                if s.scan.val & s.scan.rdy:
                    leave(*s.queue.popleft())
                convert()
            if starts:
                s.row <<= s.step.msg.row
                s.group <<= s.step.msg.group
                s.k <<= s.step.msg.k
                s.sub <<= s.step.msg.sub
                s.en <<= s.step.msg.en
            elif taken:
                s.queue.append((ScanMsg(s.step.msg.kind, s.step.msg.row), None))
            s.hold <<= starts
            s.step.rdy <<= not (starts or s.runs)
            s.idle <<= not (starts or s.runs)
            s.unsigned_ <<= s.mode[0:2] != 0
            s.dac <<= sum(code << 8 * lane for lane, code in enumerate(s.codes))
            s.scan.val <<= bool(s.queue)
            if s.queue:
                s.scan.msg <<= s.queue[0][0]

        @update
        def wakes():
            s.wake @= s.step.val & s.step.rdy & (s.step.msg.kind == SAMPLE)

    def line_trace(s):
        return f"{s.step} {len(s.runs)} {s.scan}"
