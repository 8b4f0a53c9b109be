"""NibblePacker at RTL: a nibble of zeros before a value, and one for a small value, three for a large one."""

from pymtl3 import Bits3, Bits4, Bits7, Bits8, Bits9, Bits12, Bits20, Component, Wire, concat, update, update_ff, zext

from talbot.rtl.run_length.packer_rtl import declare_packer_ports


class NibblePacker(Component):
    def construct(s):
        # Interface
        declare_packer_ports(s)

        # Components
        s.run = Wire(Bits4)
        s.gathered = Wire(Bits20)  # from the top
        s.count = Wire(Bits3)  # nibbles

        s.distance = Wire(Bits9)  # of the magnitude from the smallest one coded
        s.zero = Wire()
        s.take = Wire()
        s.odd = Wire()
        s.bits = Wire(Bits20)  # the token, from the top
        s.length = Wire(Bits3)

        # Connections
        s.octet //= s.gathered[12:20]
        s.odd //= s.count[0]

        # Logic
        @update
        def handshake():
            s.val @= s.count[1:3] != 0
            s.take @= s.val & s.rdy
            s.ready @= (s.count[1:3] == 0) | ((s.count[1:3] == 1) & s.rdy)

        @update
        def token():
            s.distance @= ((zext(~s.code, 9) + 1) if s.code[7] else zext(s.code, 9)) - zext(s.threshold, 9)
            if s.threshold == 0:
                s.distance @= s.distance - 1
            s.zero @= s.distance[8]
            if ~s.coded:
                s.bits @= concat(s.code, Bits12(0))
                s.length @= 2
            elif s.zero | ~s.push:  # the run is full, or the row ends
                s.bits @= concat(s.run + zext(s.push, 4), Bits8(0), Bits8(0))
                s.length @= 1
            elif s.distance < 7:
                s.bits @= concat(s.run, s.code[7], s.distance[0:3], Bits12(0))
                s.length @= 2
            else:
                s.bits @= concat(s.run, s.code[7], Bits7(0x70) | zext(s.code[4:8], 7), s.code[0:4], Bits4(0))
                s.length @= 4

        @update_ff
        def gather():
            if s.reset | s.restart:
                s.run <<= 0
                s.gathered <<= 0
                s.count <<= 0
            else:
                if s.take:
                    s.gathered <<= concat(s.gathered[0:12], Bits8(0))
                    s.count <<= s.count - 2
                if s.push & s.coded & s.zero & (s.run != 14):
                    s.run <<= s.run + 1
                elif s.push | (s.flush & (s.run != 0)):
                    s.gathered <<= (concat(s.gathered[0:12], Bits8(0)) if s.take else s.gathered) | (
                        concat(Bits4(0), s.bits[4:20]) if s.odd else s.bits
                    )
                    s.count <<= (zext(s.odd, 3) + s.length) if s.push else Bits3(2)
                    s.run <<= 0
                elif s.flush & s.odd:
                    s.count <<= 2

    def line_trace(s):
        return f"n{s.run}b{s.count}"
