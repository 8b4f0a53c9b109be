"""AdcBank at RTL: steps in, samples out, lane by lane.

A step is at the pins (and is sampled), then its lanes convert, then its results leave. While the results of a
step leave, the next one converts.
"""

from pymtl3 import (Bits1, Bits2, Bits3, Bits7, Bits8, Bits10, Bits32, Component, InPort, OutPort, Wire, concat, mk_bits,
                    update, update_ff)
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from rtl.edge_adc import EdgeAdc
from rtl.messages import FRAME, SAMPLE, ScanMsg, step_msg


class AdcBank(Component):
    """lanes: a power of two in 1..32."""

    def construct(s, lanes=8):
        Lanes = mk_bits(lanes)

        # Interface
        s.step = RecvIfcRTL(step_msg(lanes))
        s.mode = InPort(Bits2)
        s.threshold = InPort(Bits7)
        s.comparator = InPort(Lanes)
        s.dac = OutPort(mk_bits(8 * lanes))
        s.hold = OutPort()
        s.row = OutPort(Bits10)
        s.group = OutPort(Bits8)
        s.k = OutPort(Bits3)
        s.sub = OutPort(Bits2)
        s.en = OutPort(Lanes)
        s.unsigned_ = OutPort()
        s.idle = OutPort()
        s.made = OutPort(Bits32)
        s.left_out = OutPort(Bits32)
        s.scan = SendIfcRTL(ScanMsg)

        # Components
        for i in range(lanes):          # not a list: PyMTL would join the ports in arrays, which Yosys calls memories
            setattr(s, f"lane{i}", EdgeAdc())
        s.at_pins = Wire()              # the message whose row and lanes are at the pins is not draining yet
        s.pins_kind = Wire(Bits2)
        s.mark = Wire()                 # FRAME, ROW or END is at the output
        s.mark_kind = Wire(Bits2)
        s.mark_row = Wire(Bits10)
        s.remaining = Wire(Lanes)       # lanes of the draining step whose results have not left

        s.go = Wire(Lanes)
        s.free = Wire(Lanes)
        s.busy = Wire(Lanes)
        s.ready = Wire(Lanes)           # results at the lanes
        s.taken = Wire(Lanes)
        s.converted = Wire(Lanes)
        s.codes = Wire(mk_bits(8 * lanes))
        s.first = Wire(Lanes)           # one-hot: the lane whose turn it is
        s.code = Wire(Bits8)
        s.last = Wire()
        s.sent = Wire()
        s.drained = Wire()
        s.take = Wire()
        s.convert = Wire()

        # Connections
        for i in range(lanes):
            lane = getattr(s, f"lane{i}")
            lane.go //= s.go[i]
            lane.unsigned_ //= s.unsigned_
            lane.threshold //= s.threshold
            lane.comparator //= s.comparator[i]
            lane.dac //= s.dac[8 * i:8 * i + 8]
            lane.free //= s.free[i]
            lane.busy //= s.busy[i]
            lane.out.val //= s.ready[i]
            lane.out.rdy //= s.taken[i]
            lane.out.msg //= s.codes[8 * i:8 * i + 8]
            lane.converted //= s.converted[i]

        # Logic: taking a step
        @update
        def status():
            s.unsigned_ @= s.mode != 0
            s.idle @= ~s.hold & (s.busy == 0)
            s.step.rdy @= ~s.hold & ~s.at_pins & (s.free == ~Lanes(0))
            for i in range(lanes):
                s.go[i] @= s.hold & s.en[i]

        @update
        def accept():
            s.take @= s.step.val & s.step.rdy
            s.convert @= s.take & (s.step.msg.kind == SAMPLE)

        # Logic: results, lane by lane
        @update
        def pick():
            s.first @= s.remaining & (~s.remaining + 1)
            s.last @= s.first == s.remaining

        if lanes == 1:
            s.code //= s.codes
        else:
            @update
            def choose():
                s.code @= 0
                for i in range(lanes):
                    if s.first[i]:
                        s.code @= s.codes[8 * i:8 * i + 8]

        @update
        def send():
            s.scan.val @= s.mark | ((s.first & s.ready) != 0)
            s.scan.msg.kind @= SAMPLE
            s.scan.msg.data @= concat(s.last, Bits1(0), s.code)
            if s.mark:
                s.scan.msg.kind @= s.mark_kind
                s.scan.msg.data @= s.mark_row

        @update
        def handshake():
            s.sent @= s.scan.val & s.scan.rdy
            s.drained @= (~s.mark & (s.remaining == 0)) | (s.sent & (s.mark | s.last))
            for i in range(lanes):
                s.taken[i] @= s.first[i] & s.scan.rdy

        @update_ff
        def pins():
            if s.reset:
                s.hold <<= 0
                s.row <<= 0
                s.group <<= 0
                s.k <<= 0
                s.sub <<= 0
                s.en <<= 0
                s.at_pins <<= 0
                s.pins_kind <<= 0
            else:
                s.hold <<= s.convert
                if s.take:
                    s.row <<= s.step.msg.row
                    s.group <<= s.step.msg.group
                    s.k <<= s.step.msg.k
                    s.sub <<= s.step.msg.sub
                    s.en <<= s.step.msg.en
                    s.at_pins <<= 1
                    s.pins_kind <<= s.step.msg.kind
                elif s.drained:
                    s.at_pins <<= 0

        @update_ff
        def drain():
            if s.reset:
                s.mark <<= 0
                s.mark_kind <<= 0
                s.mark_row <<= 0
                s.remaining <<= 0
                s.made <<= 0
                s.left_out <<= 0
            else:
                if s.sent:
                    if s.mark:
                        s.mark <<= 0
                        if s.mark_kind == FRAME:
                            s.made <<= 0
                            s.left_out <<= 0
                    else:
                        s.remaining <<= s.remaining & ~s.first
                        if (s.first & s.converted) != 0:
                            s.made <<= s.made + 1
                        else:
                            s.left_out <<= s.left_out + 1
                if s.drained & s.at_pins:
                    if s.pins_kind == SAMPLE:
                        s.remaining <<= s.en
                    else:
                        s.mark <<= 1
                        s.mark_kind <<= s.pins_kind
                        s.mark_row <<= s.row

    def line_trace(s):
        return f"{s.step} {'h' if s.hold else ' '}{s.en.bin()} {s.remaining.bin()} {s.scan}"
