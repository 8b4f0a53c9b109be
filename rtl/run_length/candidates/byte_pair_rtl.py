"""BytePairPacker at RTL: a byte of zeros before a value, and the value."""

from pymtl3 import Bits2, Bits8, Bits16, Component, Wire, concat, update, update_ff, zext

from talbot.rtl.run_length.packer_rtl import declare_packer_ports


class BytePairPacker(Component):
    def construct(s):
        # Interface
        declare_packer_ports(s)

        # Components
        s.run = Wire(Bits8)
        s.gathered = Wire(Bits16)
        s.count = Wire(Bits2)  # bytes

        s.magnitude = Wire(Bits8)
        s.zero = Wire()
        s.full = Wire()
        s.take = Wire()

        # Connections
        s.octet //= s.gathered[8:16]

        # Logic
        @update
        def handshake():
            s.val @= s.count != 0
            s.take @= s.val & s.rdy
            s.ready @= (s.count == 0) | ((s.count == 1) & s.rdy)
            s.magnitude @= ~s.code + 1 if s.code[7] else s.code
            s.zero @= (s.code == 0) | (s.magnitude < zext(s.threshold, 8))
            s.full @= s.run == 254

        @update_ff
        def gather():
            if s.reset | s.restart:
                s.run <<= 0
                s.gathered <<= 0
                s.count <<= 0
            else:
                if s.take:
                    s.gathered <<= concat(s.gathered[0:8], Bits8(0))
                    s.count <<= s.count - 1
                if s.push & ~s.coded:
                    s.gathered <<= concat(s.code, Bits8(0))
                    s.count <<= 1
                elif s.push & s.zero & ~s.full:
                    s.run <<= s.run + 1
                elif s.push:
                    s.gathered <<= Bits16(0xFF00) if s.zero else concat(s.run, s.code)
                    s.count <<= 2
                    s.run <<= 0
                elif s.flush & (s.run != 0):
                    s.gathered <<= concat(s.run, Bits8(0))
                    s.count <<= 2
                    s.run <<= 0

    def line_trace(s):
        return f"n{s.run}b{s.count}"
