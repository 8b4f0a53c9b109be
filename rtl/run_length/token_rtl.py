"""TokenCoder at RTL: the state of a segment's coder, and the bits of the next sample (docs/stream.md, Payload)."""

from pymtl3 import (
    Bits1,
    Bits2,
    Bits3,
    Bits4,
    Bits5,
    Bits7,
    Bits8,
    Bits9,
    Bits11,
    Bits12,
    Bits28,
    Component,
    InPort,
    OutPort,
    Wire,
    concat,
    update,
    update_ff,
    zext,
)


class TokenCoder(Component):
    def construct(s):
        # Interface
        s.restart = InPort()  # a segment starts
        s.push = InPort()  # the sample is taken
        s.coded = InPort()
        s.threshold = InPort(Bits7)
        s.code = InPort(Bits8)
        s.bits = OutPort(Bits28)  # right-aligned
        s.length = OutPort(Bits5)
        s.open = OutPort()  # zeros wait for their token

        # Components: k, r2, run and credit as in models.digital.stream.payload
        s.k = Wire(Bits4)
        s.r2 = Wire(Bits4)
        s.run = Wire(Bits11)
        s.credit = Wire(Bits8)

        s.r = Wire(Bits3)
        s.span = Wire(Bits12)  # 2**k
        s.full = Wire()
        s.distance = Wire(Bits9)  # of the magnitude from the smallest one coded
        s.zero = Wire()
        s.literal = Wire()
        s.value = Wire(Bits8)
        s.top = Wire(Bits3)  # place of the value's leading one
        s.prefix = Wire(Bits3)
        s.width = Wire(Bits4)  # of the value in its token
        s.token = Wire(Bits28)
        s.after = Wire(Bits9)  # the credit after the token

        # Connections
        s.r //= s.r2[1:4]

        # Logic
        @update
        def classify():
            s.open @= s.run != 0
            s.span @= Bits12(1) << zext(s.k, 12)
            s.full @= (zext(s.run, 12) + 1) == s.span
            s.literal @= ~s.coded | (~s.open & ((zext(s.credit[2:8], 7) + zext(s.r, 7)) < (zext(s.k, 7) + 17)))
            s.distance @= ((zext(~s.code, 9) + 1) if s.code[7] else zext(s.code, 9)) - zext(s.threshold, 9)
            if s.threshold == 0:
                s.distance @= s.distance - 1
            s.zero @= s.distance[8]

        @update
        def code_value():
            s.value @= s.distance[0:8] + (Bits8(1) << zext(s.r, 8))
            s.top @= 0
            for i in range(8):
                if s.value[i]:
                    s.top @= Bits3(i)
            s.prefix @= s.top - s.r
            s.width @= concat(s.top, Bits1(1)) - zext(s.r, 4)
            s.token @= zext(concat(s.span | zext(s.run, 12), s.code[7]), 28) << zext(s.width, 28)

        @update
        def choose():
            s.bits @= 0
            s.length @= 0
            if s.literal:
                s.length @= 8
                if ~(s.coded & s.zero):
                    s.bits @= zext(s.code, 28)
            elif s.zero:
                s.length @= zext(s.full, 5)
            else:
                s.bits @= s.token | zext(s.value, 28)
                s.length @= zext(s.width, 5) + zext(s.k, 5) + 2
            s.after @= zext(s.credit, 9) + 33 - concat(Bits2(0), s.length, Bits2(0))

        @update_ff
        def advance():
            if s.reset | s.restart:
                s.k <<= 3
                s.r2 <<= 4
                s.run <<= 0
                s.credit <<= 128
            elif s.push & s.coded:
                if s.length == 0:
                    s.run <<= s.run + 1
                else:
                    s.run <<= 0
                    s.credit <<= Bits8(255) if s.after[8] else s.after[0:8]
                if ~s.literal & s.zero & s.full & (s.k != 11):
                    s.k <<= s.k + 1
                elif ~s.literal & ~s.zero:
                    s.k <<= Bits4(0) if s.k < 2 else s.k - 2
                    if (s.prefix == 0) & (s.r2 != 0):
                        s.r2 <<= s.r2 - 1
                    elif (s.prefix > 1) & (s.r2 != 12):
                        s.r2 <<= s.r2 + 1

    def line_trace(s):
        return f"k{s.k}r{s.r2}n{s.run}c{s.credit}"
