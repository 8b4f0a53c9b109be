"""PhasePath at RTL: a store of the taps, the divider, and the control that keeps the order."""

from pymtl3 import (
    Bits2,
    Bits6,
    Bits8,
    Bits9,
    Bits10,
    Bits17,
    Component,
    InPort,
    OutPort,
    Wire,
    concat,
    mk_bits,
    update,
    update_ff,
    zext,
)
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import SAMPLE, ScanMsg
from talbot.rtl.quad_divider import quad_divider
from talbot.rtl.sizes import check_size

IN_FLIGHT_MAX = 63  # more than any divider holds


class TapEntry(Component):
    """The registers of a sample in the store, and a link of the chain that reads the sample whose turn it is."""

    def construct(s):
        s.turn = InPort()
        s.write_x = InPort()
        s.write_y = InPort()
        s.x = InPort(Bits9)
        s.y = InPort(Bits8)
        s.chain_in = InPort(Bits17)
        s.chain_out = OutPort(Bits17)

        s.value_x = Wire(Bits9)  # i0 or i0 - i180, signed
        s.value_y = Wire(Bits8)  # i90

        @update
        def up_chain():
            s.chain_out @= s.chain_in
            if s.turn:
                s.chain_out @= concat(s.value_x, s.value_y)

        @update_ff
        def up_value():
            if s.reset:
                s.value_x <<= 0
                s.value_y <<= 0
            elif s.turn:
                if s.write_x:
                    s.value_x <<= s.x
                if s.write_y:
                    s.value_y <<= s.y


class TapStore(Component):
    """The values of the first three taps that the fourth one needs, for every sample of a step.

    lanes: samples of a step at most.
    """

    def construct(s, lanes):
        # Interface
        s.write = InPort()  # keep `sample` (taps 0 to 2)
        s.tap = InPort(Bits2)
        s.turn = InPort(lanes)  # one-hot: number of the sample in its step
        s.sample = InPort(Bits8)
        s.x = OutPort(Bits9)  # of the sample at tap 3
        s.y = OutPort(Bits9)

        # Components
        for i in range(lanes):
            setattr(s, f"entry{i}", TapEntry())
        s.none = Wire(Bits17)
        s.entry = Wire(Bits17)
        s.write_x = Wire()
        s.write_y = Wire()
        s.next_x = Wire(Bits9)
        s.wide = Wire(Bits9)

        # Connections
        chain = s.none
        for i in range(lanes):
            entry = getattr(s, f"entry{i}")
            entry.turn //= s.turn[i]
            entry.write_x //= s.write_x
            entry.write_y //= s.write_y
            entry.x //= s.next_x
            entry.y //= s.sample
            entry.chain_in //= chain
            chain = entry.chain_out
        s.none //= Bits17(0)
        s.entry //= chain

        # Logic
        @update
        def up_next():
            s.wide @= zext(s.sample, 9)
            s.x @= s.entry[8:17]
            s.y @= s.wide - zext(s.entry[0:8], 9)
            s.write_x @= s.write & (s.tap != 1)
            s.write_y @= s.write & (s.tap == 1)
            s.next_x @= s.x - s.wide if s.tap[1] else s.wide

    def line_trace(s):
        return f"{s.tap}:{s.turn} {s.x},{s.y}"


class PhasePath(Component):
    """Four taps to phase and amplitude (README.md). divider, n_frac, iterations: see rtl.quad_divider."""

    def construct(s, lanes=8, divider="radix4", n_frac=8, iterations=10):
        check_size(lanes=lanes, divider=divider, n_frac=n_frac, iterations=iterations)
        Lanes = mk_bits(lanes)
        FIRST = Lanes(1)

        # Interface
        s.recv = RecvIfcRTL(ScanMsg)
        s.on = InPort()
        s.noise_floor = InPort(Bits8)
        s.send = SendIfcRTL(ScanMsg)

        # Components
        s.store = TapStore(lanes)
        s.divider = quad_divider(divider, n_frac, iterations)
        s.full = Wire()  # `kind` and `data` hold a message
        s.kind = Wire(Bits2)
        s.data = Wire(Bits10)
        s.tap = Wire(Bits2)
        s.turn = Wire(Lanes)  # one-hot: number in its step of the sample in the register
        s.in_flight = Wire(Bits6)  # requests whose responses are not sent
        s.second = Wire()  # the phase of a response is sent, its amplitude is next

        s.sample = Wire()  # a tap is in the register
        s.fourth = Wire()
        s.passes = Wire()  # the message in the register passes unchanged
        s.asked = Wire()
        s.answered = Wire()
        s.consumed = Wire()

        # Connections
        s.store.tap //= s.tap
        s.store.turn //= s.turn
        s.store.sample //= s.data[0:8]
        s.store.x //= s.divider.recv.msg.x
        s.store.y //= s.divider.recv.msg.y
        s.divider.noise_floor //= s.noise_floor

        # Logic
        @update
        def up_sort():
            s.sample @= s.full & s.on & (s.kind == SAMPLE)
            s.fourth @= s.sample & (s.tap == 3)
            s.passes @= s.full & (~s.on | ((s.kind != SAMPLE) & (s.in_flight == 0)))
            s.store.write @= s.sample & (s.tap != 3)
            s.divider.recv.val @= s.fourth & (s.in_flight != IN_FLIGHT_MAX)

        @update
        def up_send():
            s.send.val @= s.divider.send.val | s.passes
            s.send.msg.kind @= SAMPLE
            s.send.msg.data @= zext(s.data[0:8], 10)
            if s.divider.send.val:
                s.send.msg.data @= zext(s.divider.send.msg.phase, 10)
                if s.second:
                    s.send.msg.data @= 0
                    if s.divider.send.msg.amp_valid:
                        s.send.msg.data @= zext(s.divider.send.msg.amp, 10)
            elif s.kind != SAMPLE:
                s.send.msg.kind @= s.kind
                s.send.msg.data @= s.data

        @update
        def up_answered():
            s.divider.send.rdy @= s.second & s.send.rdy
            s.answered @= s.divider.send.val & s.divider.send.rdy

        @update
        def up_consumed():
            s.asked @= s.divider.recv.val & s.divider.recv.rdy
            s.consumed @= s.store.write | s.asked | (s.passes & s.send.rdy)
            s.recv.rdy @= ~s.full | s.consumed

        @update_ff
        def up_register():
            if s.reset:
                s.full <<= 0
                s.kind <<= 0
                s.data <<= 0
            elif s.recv.rdy:
                s.full <<= s.recv.val
                if s.recv.val:
                    s.kind <<= s.recv.msg.kind
                    s.data <<= s.recv.msg.data

        @update_ff
        def up_position():
            if s.reset:
                s.tap <<= 0
                s.turn <<= FIRST
            elif s.store.write | s.asked:
                s.turn <<= s.turn << 1
                if s.data[9]:
                    s.turn <<= FIRST
                    s.tap <<= s.tap + 1

        @update_ff
        def up_divider():
            if s.reset:
                s.in_flight <<= 0
                s.second <<= 0
            else:
                s.in_flight <<= s.in_flight + zext(s.asked, 6) - zext(s.answered, 6)
                if s.divider.send.val & s.send.rdy:
                    s.second <<= ~s.second

    def line_trace(s):
        return f"{s.recv} {s.store.line_trace()} {s.in_flight} {s.send}"
