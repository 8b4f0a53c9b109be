"""PayloadPacker at RTL: a segment's samples in, the bytes of its payload out."""

from pymtl3 import Bits6, Bits7, Bits8, Bits34, Component, InPort, OutPort, Wire, concat, update, update_ff, zext

from talbot.rtl.run_length.token_rtl import TokenCoder


def declare_packer_ports(s) -> None:
    """Give the component ``s`` the ports of a packer."""
    s.restart = InPort()  # a segment starts: empty but for the coder's state
    s.push = InPort()  # the sample is taken; only while `ready`
    s.flush = InPort()  # the segment ends: fill up its last byte; only while `ready`
    s.ready = OutPort()
    s.coded = InPort()  # edge or ternary mode; else a sample is a byte
    s.signs = InPort()  # ternary mode: codes -1, 0 and 1
    s.threshold = InPort(Bits7)
    s.code = InPort(Bits8)
    s.val = OutPort()  # a byte is complete
    s.octet = OutPort(Bits8)
    s.rdy = InPort()  # a byte is taken


class PayloadPacker(Component):
    """A register of 34 bits gathers tokens, from the top: up to 7 bits that wait, and a token of 27 at most.

    Eight bits or more are a byte to send."""

    def new_coder(s):
        return TokenCoder()

    def construct(s):
        # Interface
        declare_packer_ports(s)

        # Components
        s.coder = s.new_coder()
        s.gathered = Wire(Bits34)
        s.count = Wire(Bits6)

        s.take = Wire()
        s.moved = Wire(Bits34)  # `gathered` after the byte is taken, and with the next token
        s.behind = Wire(Bits6)  # bits after the next token; at most 7 of them are before it

        # Connections
        s.coder.restart //= s.restart
        s.coder.push //= s.push
        s.coder.coded //= s.coded
        s.coder.signs //= s.signs
        s.coder.threshold //= s.threshold
        s.coder.code //= s.code
        s.octet //= s.gathered[26:34]

        # Logic
        @update
        def handshake():
            s.val @= s.count[3:6] != 0
            s.take @= s.val & s.rdy
            s.ready @= (s.count[3:6] == 0) | ((s.count[3:6] == 1) & s.rdy)
            s.behind @= zext(s.count[0:3], 6) + zext(s.coder.length, 6)
            s.moved @= s.gathered
            if s.take:
                s.moved @= concat(s.gathered[0:26], Bits8(0))
            if s.push:
                s.moved @= s.moved | (zext(s.coder.bits, 34) << zext(Bits6(34) - s.behind, 34))

        @update_ff
        def gather():
            if s.reset:
                s.gathered <<= 0
                s.count <<= 0
            else:
                if s.take:
                    s.count <<= s.count - 8
                if s.push:
                    s.count <<= s.behind
                if s.push | s.take:
                    s.gathered <<= s.moved
                if s.flush:
                    s.count <<= Bits6(8) if (s.count[0:3] != 0) | s.coder.open else Bits6(0)

    def line_trace(s):
        return f"{s.coder.line_trace()}b{s.count}"
