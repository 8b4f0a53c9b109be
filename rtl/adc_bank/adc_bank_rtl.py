"""AdcBank at RTL: steps in, samples out, lane by lane.

A step is at the pins (and is sampled), then its lanes convert, then its results are sent. The results of a step are
sent while the next step converts.
"""

from pymtl3 import Bits1, Bits2, Bits8, Bits10, Component, InPort, OutPort, Wire, concat, mk_bits, update, update_ff

from talbot.rtl.adc_bank.ports import TERNARY, declare_ports
from talbot.rtl.edge_adc import EdgeAdc
from talbot.rtl.messages import FRAME, SAMPLE
from talbot.rtl.sizes import check_size


class LaneResult(Component):
    """A link of the chain that selects the result (val, converted, code) of the lane whose turn it is."""

    def construct(s):
        s.turn = InPort()
        s.val = InPort()
        s.converted = InPort()
        s.code = InPort(Bits8)
        s.chain_in = InPort(Bits10)
        s.chain_out = OutPort(Bits10)

        @update
        def up_chain():
            s.chain_out @= s.chain_in
            if s.turn:
                s.chain_out @= concat(s.val, s.converted, s.code)


class AdcBank(Component):
    """The converters of a row (README.md); lanes: a power of two in 1..32."""

    def construct(s, lanes=8):
        check_size(lanes=lanes)
        Lanes = mk_bits(lanes)

        # Interface
        declare_ports(s, lanes)

        # Components
        for i in range(lanes):  # not a list: PyMTL would join the ports in arrays, which Yosys reads as memories
            setattr(s, f"lane{i}", EdgeAdc())
            setattr(s, f"link{i}", LaneResult())
        s.at_pins = Wire()  # the message at the pins is not draining yet
        s.pins_kind = Wire(Bits2)
        s.mark = Wire()  # FRAME, ROW or END is at the output
        s.mark_kind = Wire(Bits2)
        s.mark_row = Wire(Bits10)
        s.remaining = Wire(Lanes)  # lanes of the draining step whose results are not sent

        s.ternary = Wire()
        s.go = Wire(Lanes)
        s.free = Wire(Lanes)
        s.busy = Wire(Lanes)
        s.taken = Wire(Lanes)
        s.first = Wire(Lanes)  # one-hot: the lane whose turn it is
        s.none = Wire(Bits10)
        s.result = Wire(Bits10)  # its result: val, converted, code
        s.last = Wire()
        s.sent = Wire()
        s.drained = Wire()
        s.take = Wire()

        # Connections
        chain = s.none
        for i in range(lanes):
            lane, link = getattr(s, f"lane{i}"), getattr(s, f"link{i}")
            lane.go //= s.go[i]
            lane.unsigned_ //= s.unsigned_
            lane.threshold //= s.threshold
            lane.ternary //= s.ternary
            lane.comparator //= s.comparator[i]
            lane.dac //= s.dac[8 * i : 8 * i + 8]
            lane.free //= s.free[i]
            lane.busy //= s.busy[i]
            lane.out.rdy //= s.taken[i]
            link.turn //= s.first[i]
            link.val //= lane.out.val
            link.converted //= lane.converted
            link.code //= lane.out.msg
            link.chain_in //= chain
            chain = link.chain_out
        s.none //= Bits10(0)
        s.result //= chain

        # Logic: accept a step
        @update
        def status():
            s.unsigned_ @= s.mode[0:2] != 0
            s.ternary @= s.mode == TERNARY
            s.idle @= ~s.hold & (s.busy == 0)
            s.step.rdy @= ~s.hold & ~s.at_pins & (s.free == ~Lanes(0))
            s.go @= s.en if s.hold else Lanes(0)

        @update
        def accept():
            s.take @= s.step.val & s.step.rdy
            s.wake @= s.take & (s.step.msg.kind == SAMPLE)

        # Logic: results, lane by lane
        @update
        def pick():
            s.first @= s.remaining & (~s.remaining + 1)
            s.last @= s.first == s.remaining

        @update
        def send():
            s.scan.val @= s.mark | s.result[9]
            s.scan.msg.kind @= SAMPLE
            s.scan.msg.data @= concat(s.last, Bits1(0), s.result[0:8])
            if s.mark:
                s.scan.msg.kind @= s.mark_kind
                s.scan.msg.data @= s.mark_row

        @update
        def handshake():
            s.sent @= s.scan.val & s.scan.rdy
            s.drained @= (~s.mark & (s.remaining == 0)) | (s.sent & (s.mark | s.last))
            s.taken @= s.first if s.scan.rdy else Lanes(0)

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
                s.hold <<= s.wake
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
                        if s.result[8]:
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
