"""QuadDivider: the three dividing variants."""

from pymtl3 import Bits4, Component, InPort, OutPort, Wire, mk_bits, update, update_ff, zext
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import DivReq, div_resp
from talbot.rtl.quad_divider.angle_rtl import Fold, PhaseIndex, Unfold
from talbot.rtl.quad_divider.digit_rtl import Radix2Digit, Radix4Digit, div_state
from talbot.rtl.quad_divider.iterative_rtl import IterativeDivider
from talbot.rtl.sizes import check_size


class Operands(Component):
    """The initial state of the division of a request."""

    def construct(s, quotient_bits):
        State, Quotient = div_state(quotient_bits), mk_bits(quotient_bits)
        s.msg = InPort(DivReq)
        s.noise_floor = InPort(8)
        s.state = OutPort(State)

        s.fold = Fold()

        s.fold.msg //= s.msg
        s.fold.noise_floor //= s.noise_floor

        @update
        def up_state():
            s.state @= State(s.fold.octant, s.fold.amp_valid, s.fold.larger, s.fold.smaller, Quotient(0))


class Result(Component):
    """The response of a finished division, with the phase from the table."""

    def construct(s, n_frac):
        s.octant = InPort(3)
        s.larger = InPort(9)
        s.amp_valid = InPort()
        s.ratio = InPort(n_frac)
        s.msg = OutPort(div_resp(n_frac))

        s.lookup = PhaseIndex(n_frac)
        s.unfold = Unfold(n_frac)

        s.lookup.ratio //= s.ratio
        s.unfold.octant //= s.octant
        s.unfold.larger //= s.larger
        s.unfold.amp_valid //= s.amp_valid
        s.unfold.ratio //= s.ratio
        s.unfold.index //= lambda: zext(s.lookup.index, 8)
        s.unfold.msg //= s.msg


class DividerDatapath(Component):
    """One state register that one digit updates in every cycle."""

    def construct(s, n_frac, Digit):
        digits = -(-n_frac // Digit.digit_bits)
        quotient_bits = digits * Digit.digit_bits
        State = div_state(quotient_bits)

        s.load = InPort()
        s.step = InPort()
        s.last = OutPort()
        s.recv_msg = InPort(DivReq)
        s.noise_floor = InPort(8)
        s.send_msg = OutPort(div_resp(n_frac))

        s.operands = Operands(quotient_bits)
        s.digit = Digit(quotient_bits)
        s.result = Result(n_frac)
        s.state = Wire(State)
        s.count = Wire(4)

        s.operands.msg //= s.recv_msg
        s.operands.noise_floor //= s.noise_floor
        s.digit.in_state //= s.state
        s.result.octant //= s.state.octant
        s.result.larger //= s.state.larger
        s.result.amp_valid //= s.state.amp_valid
        s.result.ratio //= s.state.quotient[quotient_bits - n_frac : quotient_bits]  # the last digit may be too long
        s.result.msg //= s.send_msg
        s.last //= lambda: s.count == Bits4(digits - 1)

        @update_ff
        def up_state():
            if s.reset:
                s.state <<= State()
                s.count <<= Bits4(0)
            elif s.load:
                s.state <<= s.operands.state
                s.count <<= Bits4(0)
            elif s.step:
                s.state <<= s.digit.out_state
                s.count <<= s.count + Bits4(1)


class QuadDividerRadix2(IterativeDivider):
    """One bit of the ratio a cycle: the smallest variant. n_frac: 4..16."""

    def construct(s, n_frac=8):
        check_size(n_frac=n_frac)
        super().construct(DividerDatapath(n_frac, Radix2Digit), n_frac)


class QuadDividerRadix4(IterativeDivider):
    """Two bits of the ratio a cycle. n_frac: 4..16."""

    def construct(s, n_frac=8):
        check_size(n_frac=n_frac)
        super().construct(DividerDatapath(n_frac, Radix4Digit), n_frac)


class PipelineRegister(Component):
    """A pipeline register with a valid bit. It moves while ``advance`` is high; without a division its bits stay."""

    def construct(s, quotient_bits):
        State = div_state(quotient_bits)
        s.advance = InPort()
        s.in_val = InPort()
        s.in_state = InPort(State)
        s.out_val = OutPort()
        s.out_state = OutPort(State)

        @update_ff
        def up_register():
            if s.reset:
                s.out_val <<= 0
                s.out_state <<= State()
            elif s.advance:
                s.out_val <<= s.in_val
                if s.in_val:
                    s.out_state <<= s.in_state


class QuadDividerPipelined(Component):
    """A stage per bit: one result a cycle. The whole pipeline stops while its result is not taken. n_frac: 4..16."""

    def construct(s, n_frac=8):
        check_size(n_frac=n_frac)

        s.recv = RecvIfcRTL(DivReq)
        s.send = SendIfcRTL(div_resp(n_frac))
        s.noise_floor = InPort(8)

        s.operands = Operands(n_frac)
        stages = [PipelineRegister(n_frac) for _ in range(n_frac + 1)]
        digits = [Radix2Digit(n_frac) for _ in range(n_frac)]
        # Not as lists: PyMTL would join their ports in arrays, which Yosys reads as memories.
        for i, stage in enumerate(stages):
            setattr(s, f"stage{i}", stage)
        for i, digit in enumerate(digits):
            setattr(s, f"digit{i}", digit)
        s.result = Result(n_frac)
        s.advance = Wire()
        s.unused_rest = Wire(9)

        s.operands.msg //= s.recv.msg
        s.operands.noise_floor //= s.noise_floor
        stages[0].in_val //= s.recv.val
        stages[0].in_state //= s.operands.state
        for before, digit, after in zip(stages, digits, stages[1:]):
            digit.in_state //= before.out_state
            after.in_val //= before.out_val
            after.in_state //= digit.out_state
        for stage in stages:
            stage.advance //= s.advance
        last = stages[-1]
        s.unused_rest //= last.out_state.rest
        s.result.octant //= last.out_state.octant
        s.result.larger //= last.out_state.larger
        s.result.amp_valid //= last.out_state.amp_valid
        s.result.ratio //= last.out_state.quotient
        s.recv.rdy //= s.advance
        s.send.val //= last.out_val
        s.send.msg //= s.result.msg

        @update
        def up_advance():
            s.advance @= ~s.send.val | s.send.rdy

    def line_trace(s):
        return f"{s.recv}({s.advance}){s.send}"
