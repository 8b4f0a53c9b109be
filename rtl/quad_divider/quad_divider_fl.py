"""QuadDivider at functional level: the golden functions at the ports."""

from typing import Any

from pymtl3 import Component, InPort, update_ff
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.models.digital.phase import divide
from talbot.rtl.messages import DivReq, div_resp
from talbot.rtl.quad_divider.variants import check_variant, ratio_bits


def response(variant: str, n_frac: int, iterations: int, request: Any, noise_floor: int) -> Any:
    """Return the DivResp of ``variant`` to the DivReq ``request``."""
    r = divide(variant, n_frac, iterations, request.x.int(), request.y.int(), int(noise_floor))
    return div_resp(ratio_bits(variant, n_frac))(
        int(r.octant), int(r.ratio), int(r.zero), int(r.phase), int(r.amp_valid), int(r.amp)
    )


class QuadDividerFL(Component):
    """Functional level of any variant: the same ports and responses, one request at a time."""

    def construct(s, variant, n_frac=8, iterations=10):
        check_variant(variant, n_frac, iterations)

        s.recv = RecvIfcRTL(DivReq)
        s.send = SendIfcRTL(div_resp(ratio_bits(variant, n_frac)))
        s.noise_floor = InPort(8)

        @update_ff
        def behave():
            if s.reset:
                s.recv.rdy <<= 1
                s.send.val <<= 0
            elif s.recv.val & s.recv.rdy:
                s.recv.rdy <<= 0
                s.send.val <<= 1
                s.send.msg <<= response(variant, n_frac, iterations, s.recv.msg, s.noise_floor)
            elif s.send.val & s.send.rdy:
                s.recv.rdy <<= 1
                s.send.val <<= 0

    def line_trace(s):
        return f"{s.recv}(){s.send}"
