"""The link: the frame's bytes, or those of the loop-back."""

from pymtl3 import Bits8, Component, InPort, update
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL


class Link(Component):
    """`send` is `loop` with `loop_enable`, else `frame`; the other one waits."""

    def construct(s):
        s.loop_enable = InPort()
        s.frame = RecvIfcRTL(Bits8)
        s.loop = RecvIfcRTL(Bits8)
        s.send = SendIfcRTL(Bits8)

        @update
        def up_link():
            s.send.msg @= s.frame.msg
            s.send.val @= s.frame.val
            s.frame.rdy @= s.send.rdy
            s.loop.rdy @= 0
            if s.loop_enable:
                s.send.msg @= s.loop.msg
                s.send.val @= s.loop.val
                s.frame.rdy @= 0
                s.loop.rdy @= s.send.rdy

    def line_trace(s):
        return f"{s.send}"
