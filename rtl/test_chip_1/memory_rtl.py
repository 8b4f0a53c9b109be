"""Memory at RTL: banks of SRAM with a port each for four requesters, an arbiter at each bank."""

from pymtl3 import (
    Bits4,
    Bits8,
    Bits32,
    Component,
    InPort,
    OutPort,
    Wire,
    clog2,
    concat,
    connect,
    update,
    update_ff,
    zext,
)
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import MemReq

BANKS, BANK_WORDS = 8, 512  # 2 KB a bank
REQUESTERS = "data", "fetch", "sort", "host"


class Sram(Component):
    """The behaviour of a single-port synchronous SRAM: `q` is the word of the cycle before, of a write not defined."""

    def construct(s, words):
        s.enable = InPort()
        s.strobe = InPort(4)  # bytes to write, 0: a read
        s.address = InPort(clog2(words))
        s.data = InPort(32)
        s.q = OutPort(32)

        s.words = [Wire(32) for _ in range(words)]
        s.now = Wire(32)
        s.next_ = Wire(32)

        @update
        def up_word():
            s.now @= s.words[s.address]
            s.next_ @= concat(
                s.data[24:32] if s.strobe[3] else s.now[24:32],
                s.data[16:24] if s.strobe[2] else s.now[16:24],
                s.data[8:16] if s.strobe[1] else s.now[8:16],
                s.data[0:8] if s.strobe[0] else s.now[0:8],
            )

        @update_ff
        def up_array():
            if s.enable:
                s.q <<= s.now
                if s.strobe != 0:
                    s.words[s.address] <<= s.next_

    def line_trace(s):
        return f"{s.address}" if s.enable else ""


class Arbiter(Component):
    """One grant a cycle: requests refused in the cycle before come first, in turn, then the first of REQUESTERS.

    The grant of data depends on no other new request: the address of fetch depends on it.
    """

    def construct(s):
        # Interface
        for name in REQUESTERS:
            setattr(s, f"{name}_asks", InPort())
            setattr(s, f"{name}_grant", OutPort())

        # Components
        s.refused = Wire(4)  # in the cycle before
        s.last = Wire(2)  # the one of them that had the last turn
        s.later = Wire(4)  # those of them after the last
        s.turn = Wire(4)
        s.fresh = Wire()  # none was refused

        # Logic
        @update
        def up_turn():
            s.fresh @= s.refused == 0
            s.later @= s.refused & ~((Bits4(2) << zext(s.last, 4)) - 1)
            s.turn @= s.refused & (~s.refused + 1)
            if s.later != 0:
                s.turn @= s.later & (~s.later + 1)

        @update
        def up_data():
            s.data_grant @= s.data_asks & (s.turn[0] | s.fresh)

        @update
        def up_others():
            s.fetch_grant @= s.fetch_asks & (s.turn[1] | (s.fresh & ~s.data_asks))
            s.sort_grant @= s.sort_asks & (s.turn[2] | (s.fresh & ~s.data_asks & ~s.fetch_asks))
            s.host_grant @= s.host_asks & (s.turn[3] | (s.fresh & ~s.data_asks & ~s.fetch_asks & ~s.sort_asks))

        @update_ff
        def up_refused():
            if s.reset:
                s.refused <<= 0
                s.last <<= 0
            else:
                s.refused <<= concat(
                    s.host_asks & ~s.host_grant,
                    s.sort_asks & ~s.sort_grant,
                    s.fetch_asks & ~s.fetch_grant,
                    s.data_asks & ~s.data_grant,
                )
                if ~s.fresh:
                    s.last <<= concat(s.turn[3] | s.turn[2], s.turn[3] | s.turn[1])

    def line_trace(s):
        return f"{s.refused}"


class Bank(Component):
    """An SRAM behind its arbiter."""

    def construct(s, words):
        # Interface
        for name in REQUESTERS:
            setattr(s, f"{name}_asks", InPort())
            setattr(s, f"{name}_grant", OutPort())
            setattr(s, f"{name}_msg", InPort(MemReq))
        s.q = OutPort(32)

        # Components
        s.arbiter = Arbiter()
        s.sram = Sram(words)
        s.request = Wire(MemReq)

        # Connections
        for name in REQUESTERS:
            connect(getattr(s, f"{name}_asks"), getattr(s.arbiter, f"{name}_asks"))
            connect(getattr(s, f"{name}_grant"), getattr(s.arbiter, f"{name}_grant"))
        s.sram.q //= s.q
        s.sram.strobe //= s.request.strobe
        s.sram.address //= s.request.address[5 : 5 + clog2(words)]
        s.sram.data //= s.request.data

        # Logic
        @update
        def up_request():
            s.sram.enable @= s.data_grant | s.fetch_grant | s.sort_grant | s.host_grant
            s.request @= s.data_msg
            if s.fetch_grant:
                s.request @= s.fetch_msg
            elif s.sort_grant:
                s.request @= s.sort_msg
            elif s.host_grant:
                s.request @= s.host_msg

    def line_trace(s):
        return f"{s.arbiter.line_trace()}{s.sram.line_trace()}"


class MemoryPort(Component):
    """A requester's port: a request waits for its bank and for room for its response."""

    def construct(s):
        # Interface
        s.req = RecvIfcRTL(MemReq)
        s.resp = SendIfcRTL(Bits32)
        s.asks = OutPort(BANKS)
        s.grants = InPort(BANKS)
        s.msg = OutPort(MemReq)
        for b in range(BANKS):
            setattr(s, f"q{b}", InPort(32))

        # Components
        s.bank = Wire(3)  # of the last request
        s.arrives = Wire()  # its word is at `q`
        s.holds = Wire()  # its word is in `word`
        s.word = Wire(32)
        s.q = [Wire(32) for _ in range(BANKS)]

        # Connections
        s.msg //= s.req.msg
        for b in range(BANKS):
            connect(s.q[b], getattr(s, f"q{b}"))

        # Logic
        @update
        def up_asks():
            s.asks @= 0
            if s.req.val & (~s.resp.val | s.resp.rdy):
                s.asks @= Bits8(1) << zext(s.req.msg.address[2:5], 8)

        @update
        def up_req():
            s.req.rdy @= s.grants != 0

        @update
        def up_resp():
            s.resp.val @= s.arrives | s.holds
            s.resp.msg @= s.q[s.bank] if s.arrives else s.word

        @update_ff
        def up_state():
            if s.reset:
                s.bank <<= 0
                s.arrives <<= 0
                s.holds <<= 0
                s.word <<= 0
            else:
                s.arrives <<= s.req.rdy
                s.holds <<= s.resp.val & ~s.resp.rdy
                s.word <<= s.resp.msg
                if s.req.rdy:
                    s.bank <<= s.req.msg.address[2:5]

    def line_trace(s):
        return f"{s.req} {s.resp}"
