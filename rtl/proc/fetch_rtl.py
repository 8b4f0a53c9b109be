"""Fetch at RTL: requests for instructions along the path, and their words in order, without those of a left path."""

from pymtl3 import Bits32, Component, InPort, OutPort, Wire, update, update_ff, zext
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

IN_FLIGHT = 2  # requests without a response, at most


class Fetch(Component):
    """An offered request stays until it is accepted, also where its path is left; its word is then dropped."""

    def construct(s):
        # Interface
        s.req = SendIfcRTL(Bits32)
        s.resp = RecvIfcRTL(Bits32)
        s.leave = InPort()  # the path goes on at `target`, from this cycle on
        s.target = InPort(32)
        s.halted = InPort()  # no more requests
        s.free = InPort()  # the decoder accepts a word
        s.val = OutPort()
        s.word = OutPort(32)
        s.pc = OutPort(32)  # of the word

        # Components
        s.address = Wire(32)  # of the next request
        s.resume = Wire(32)  # the address after a stale request
        s.stale = Wire()  # the offered request is of a left path
        s.held = Wire()  # the request was offered in the cycle before, too
        s.flying = Wire(2)  # requests without a response
        s.drops = Wire(2)  # responses to drop
        s.req_go = Wire()
        s.resp_go = Wire()

        # Connections
        s.word //= s.resp.msg

        # Logic
        @update
        def up_streams():
            s.req.val @= (s.flying != IN_FLIGHT) & (~s.halted | s.held)
            s.req.msg @= s.address
            if s.leave & ~s.held:
                s.req.msg @= s.target
            s.resp.rdy @= s.halted | s.free | (s.drops != 0)
            s.req_go @= s.req.val & s.req.rdy
            s.resp_go @= s.resp.val & s.resp.rdy
            s.val @= s.resp_go & ~s.leave & ~s.halted & (s.drops == 0)

        @update_ff
        def up_path():
            if s.reset:
                s.address <<= 0
                s.resume <<= 0
                s.pc <<= 0
                s.stale <<= 0
                s.held <<= 0
                s.flying <<= 0
                s.drops <<= 0
            else:
                s.held <<= s.req.val & ~s.req.rdy
                s.flying <<= s.flying + zext(s.req_go, 2) - zext(s.resp_go, 2)
                if s.leave:
                    s.pc <<= s.target
                    s.resume <<= s.target
                    s.stale <<= s.held & ~s.req_go
                    s.drops <<= s.flying - zext(s.resp_go, 2) + zext(s.held & s.req_go, 2)
                    if ~s.held | s.req_go:
                        s.address <<= s.target
                        if ~s.held & s.req_go:
                            s.address <<= s.target + 4
                else:
                    if s.val:
                        s.pc <<= s.pc + 4
                    if s.req_go:
                        s.address <<= s.resume if s.stale else s.address + 4
                        s.stale <<= 0
                    s.drops <<= s.drops - zext(s.resp_go & (s.drops != 0), 2) + zext(s.req_go & s.stale, 2)

    def line_trace(s):
        return f"{s.req} {s.resp}"
