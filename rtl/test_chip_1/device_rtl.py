"""DeviceSwitch at RTL: the processor's data accesses, from address 0x8000 on to the sorter, else to memory."""

from pymtl3 import Bits12, Bits32, Component, Wire, update, update_ff, zext
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import MemReq
from talbot.rtl.test_chip_1.ports import SortReq


class DeviceSwitch(Component):
    """A store to the sorter starts it; a load waits until it is done. One access at a time."""

    def construct(s):
        # Interface
        s.req = RecvIfcRTL(MemReq)
        s.resp = SendIfcRTL(Bits32)
        s.mem_req = SendIfcRTL(MemReq)
        s.mem_resp = RecvIfcRTL(Bits32)
        s.sort_req = SendIfcRTL(SortReq)
        s.sort_resp = RecvIfcRTL(Bits12)

        # Components
        s.of_sorter = Wire()
        s.starts = Wire()
        s.stored = Wire()  # the response of a store to the sorter is due
        s.loads = Wire()  # that of a load

        # Connections
        s.mem_req.msg //= s.req.msg
        s.sort_req.msg.address //= s.req.msg.data[0:12]
        s.sort_req.msg.length //= s.req.msg.data[16:28]

        # Logic
        @update
        def up_requests():
            s.of_sorter @= s.req.msg.address[15]
            s.starts @= s.req.val & s.of_sorter & (s.req.msg.strobe != 0)
            s.sort_req.val @= s.starts
            s.mem_req.val @= s.req.val & ~s.of_sorter

        @update
        def up_ready():
            s.req.rdy @= s.mem_req.rdy
            if s.of_sorter:
                s.req.rdy @= s.sort_req.rdy | ~s.starts

        @update
        def up_responses():
            s.resp.val @= s.mem_resp.val
            s.resp.msg @= s.mem_resp.msg
            if s.stored:
                s.resp.val @= 1
            elif s.loads:
                s.resp.val @= s.sort_resp.val
                s.resp.msg @= zext(s.sort_resp.msg, 32)
            s.sort_resp.rdy @= s.loads & s.resp.rdy
            s.mem_resp.rdy @= ~s.stored & ~s.loads & s.resp.rdy

        @update_ff
        def up_due():
            if s.reset:
                s.stored <<= 0
                s.loads <<= 0
            else:
                s.stored <<= (s.starts & s.sort_req.rdy) | (s.stored & ~s.resp.rdy)
                s.loads <<= (s.req.val & s.of_sorter & ~s.starts) | (s.loads & ~(s.resp.val & s.resp.rdy))

    def line_trace(s):
        return f"{s.req} {s.resp}"
