"""QuadDivider at cycle level: the cycles of each variant, data from the golden functions."""

from pymtl3 import Component, InPort, Wire, update, update_ff
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import DivReq, div_resp
from talbot.rtl.quad_divider.quad_divider_fl import response
from talbot.rtl.quad_divider.variants import ratio_bits, timing


class QuadDividerCL(Component):
    """Responses move through one slot per cycle of latency; the last slot is offered.

    All slots move together, unless the last one waits to be taken. An iterative variant fills one slot at a time.
    """

    def construct(s, variant, n_frac=8, iterations=10):
        latency, interval = timing(variant, n_frac, iterations)

        s.recv = RecvIfcRTL(DivReq)
        s.send = SendIfcRTL(div_resp(ratio_bits(variant, n_frac)))
        s.noise_floor = InPort(8)

        s.slots = [None] * latency
        s.empty = Wire()

        if interval == 1:

            @update
            def up_rdy():
                s.recv.rdy @= ~s.send.val | s.send.rdy
        else:
            s.recv.rdy //= s.empty

        @update_ff
        def up_slots():
            if s.reset:
                s.slots = [None] * latency
            elif s.slots[-1] is None or s.send.rdy:
                taken = s.recv.val & s.recv.rdy
                first = response(variant, n_frac, iterations, s.recv.msg, s.noise_floor) if taken else None
                s.slots = [first, *s.slots[:-1]]
            s.empty <<= all(slot is None for slot in s.slots)
            s.send.val <<= s.slots[-1] is not None
            if s.slots[-1] is not None:
                s.send.msg <<= s.slots[-1]

    def line_trace(s):
        return f"{s.recv}({''.join('.*'[slot is not None] for slot in s.slots)}){s.send}"
