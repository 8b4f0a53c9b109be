"""Proc at functional level: the golden execution at the ports, one request at a time."""

from pymtl3 import Component, update_ff

from talbot.rtl.messages import MemReq
from talbot.rtl.proc.golden import Access, Fetch, Receive, Send, execution
from talbot.rtl.proc.ports import declare_ports


class ProcFL(Component):
    """Functional level of Proc: the same ports and requests; the cycles differ."""

    def construct(s):
        declare_ports(s)
        s.execute = s.request = None
        s.waiting = False

        @update_ff
        def behave():
            imem, dmem = s.imem_req.val & s.imem_req.rdy, s.dmem_req.val & s.dmem_req.rdy
            if s.imem_resp.val & s.imem_resp.rdy:
                s.advance(int(s.imem_resp.msg))
            elif s.dmem_resp.val & s.dmem_resp.rdy:
                s.advance(int(s.dmem_resp.msg))
            elif s.from_manager.val & s.from_manager.rdy:
                s.advance(int(s.from_manager.msg))
            elif s.to_manager.val & s.to_manager.rdy:
                s.advance(0)
            elif imem | dmem:
                s.waiting = True  # for the response
            if s.reset:
                s.execute = execution(int(s.hart_id))
                s.request, s.waiting = next(s.execute), False
            fetch, access = isinstance(s.request, Fetch), isinstance(s.request, Access)
            s.imem_req.val <<= fetch and not s.waiting
            s.imem_resp.rdy <<= fetch and s.waiting
            s.dmem_req.val <<= access and not s.waiting
            s.dmem_resp.rdy <<= access and s.waiting
            s.from_manager.rdy <<= isinstance(s.request, Receive)
            s.to_manager.val <<= isinstance(s.request, Send)
            s.halted <<= s.request is None
            if fetch:
                s.imem_req.msg <<= s.request.address
            elif access:
                s.dmem_req.msg <<= MemReq(s.request.strobe, s.request.address, s.request.data)
            elif isinstance(s.request, Send):
                s.to_manager.msg <<= s.request.word

    def advance(s, answer):
        """Pass the answer of the request to the execution."""
        try:
            s.request, s.waiting = s.execute.send(answer), False
        except StopIteration:
            s.request = None

    def line_trace(s):
        return f"{s.request}"
