"""Registers at RTL: x1 to x31, two read ports and a write port."""

from pymtl3 import Bits5, Bits32, Component, InPort, OutPort, Wire, update, update_ff


class Registers(Component):
    def construct(s):
        s.rs1 = InPort(Bits5)
        s.rs2 = InPort(Bits5)
        s.a = OutPort(Bits32)
        s.b = OutPort(Bits32)
        s.write = InPort()
        s.rd = InPort(Bits5)  # not 0 while `write`
        s.data = InPort(Bits32)

        s.x = [Wire(Bits32) for _ in range(32)]

        @update
        def up_read():
            s.a @= s.x[s.rs1]
            s.b @= s.x[s.rs2]

        @update_ff
        def up_write():
            if s.reset:
                for i in range(32):
                    s.x[i] <<= 0
            elif s.write:
                s.x[s.rd] <<= s.data

    def line_trace(s):
        return f"x{s.rd}={s.data}" if s.write else ""
