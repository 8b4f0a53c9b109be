"""Alu at RTL: results of register and immediate instructions, and comparisons of branches."""

from pymtl3 import Component, InPort, OutPort, Wire, sext, update, zext


class Alu(Component):
    """`alternative` turns an addition into a subtraction and a right shift into an arithmetic one."""

    def construct(s):
        # Interface
        s.funct3 = InPort(3)
        s.alternative = InPort()
        s.a = InPort(32)
        s.b = InPort(32)
        s.out = OutPort(32)
        s.taken = OutPort()  # of the branch with this funct3

        # Components
        s.difference = Wire(33)
        s.less = Wire()
        s.less_unsigned = Wire()
        s.shift = Wire(32)
        s.negative = Wire()
        s.sign = Wire(32)
        s.shifted = Wire(32)  # to the right
        s.holds = Wire()

        # Logic
        @update
        def up_compare():
            s.difference @= zext(s.a, 33) - zext(s.b, 33)
            s.less_unsigned @= s.difference[32]
            s.less @= s.less_unsigned ^ s.a[31] ^ s.b[31]

        @update
        def up_shift():
            s.shift @= zext(s.b[0:5], 32)
            s.negative @= s.a[31] & s.alternative
            s.sign @= sext(s.negative, 32)
            s.shifted @= ((s.a ^ s.sign) >> s.shift) ^ s.sign

        @update
        def up_out():
            s.out @= s.a + s.b
            if s.funct3 == 0:
                if s.alternative:
                    s.out @= s.difference[0:32]
            elif s.funct3 == 1:
                s.out @= s.a << s.shift
            elif s.funct3 == 2:
                s.out @= zext(s.less, 32)
            elif s.funct3 == 3:
                s.out @= zext(s.less_unsigned, 32)
            elif s.funct3 == 4:
                s.out @= s.a ^ s.b
            elif s.funct3 == 5:
                s.out @= s.shifted
            elif s.funct3 == 6:
                s.out @= s.a | s.b
            else:
                s.out @= s.a & s.b

        @update
        def up_taken():
            s.holds @= s.a == s.b
            if s.funct3[2] & s.funct3[1]:
                s.holds @= s.less_unsigned
            elif s.funct3[2]:
                s.holds @= s.less
            s.taken @= s.holds ^ s.funct3[0]

    def line_trace(s):
        return f"{s.a} {s.funct3} {s.b}"
