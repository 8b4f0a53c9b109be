"""TokenCoder at RTL: the state of a segment's coder, and the bits of the next sample (docs/stream.md, Payload)."""

from pymtl3 import (
    Bits1,
    Bits2,
    Bits3,
    Bits4,
    Bits5,
    Bits6,
    Bits7,
    Bits8,
    Bits9,
    Bits11,
    Bits12,
    Bits13,
    Bits27,
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
        s.signs = InPort()  # codes are -1, 0 and 1; constant in a segment
        s.threshold = InPort(Bits7)
        s.code = InPort(Bits8)
        s.bits = OutPort(Bits27)  # right-aligned
        s.length = OutPort(Bits5)
        s.open = OutPort()  # zeros wait for their token

        # Components: k, r2, run and credit as in models.digital.stream.payload
        s.k = Wire(Bits6)
        s.r2 = Wire(Bits3)
        s.run = Wire(Bits11)
        s.credit = Wire(Bits8)

        s.q = Wire(Bits4)
        s.r = Wire(Bits2)  # the order of the values' code, less 1
        s.dense = Wire()
        s.power = Wire(Bits13)  # 2**q
        s.single = Wire()  # tokens are single samples, q = 0
        s.span = Wire(Bits12)  # 2**(q - 1), or 0
        s.full = Wire()
        s.distance = Wire(Bits9)  # of the magnitude from the smallest one coded
        s.zero = Wire()
        s.literal = Wire()
        s.value = Wire(Bits8)
        s.top = Wire(Bits3)  # place of the value's leading one
        s.near = Wire()  # the value is below 2**(r + 1)
        s.ahead = Wire(Bits8)  # the one that is sent ahead of such a value
        s.width = Wire(Bits4)  # of the value in its token
        s.token = Wire(Bits27)
        s.after = Wire(Bits9)  # the credit after the token

        # Connections
        s.q //= s.k[2:6]
        s.single //= s.power[0]
        s.span //= s.power[1:13]
        s.r //= s.r2[1:3]

        # Logic
        @update
        def classify():
            s.open @= s.run != 0
            s.dense @= (s.threshold[2:7] == 0) & ~s.signs
            s.power @= Bits13(1) << zext(s.q, 13)
            s.full @= (zext(s.run, 12) + 1) == s.span
            s.literal @= ~s.coded | (~s.signs & ~s.open & (s.credit[2:8] < concat(Bits2(1), s.q)))
            s.distance @= ((zext(~s.code, 9) + 1) if s.code[7] else zext(s.code, 9)) - zext(s.threshold, 9)
            if s.threshold == 0:
                s.distance @= s.distance - 1
            s.zero @= s.distance[8]
            if s.signs:
                s.distance @= 0
                s.zero @= ~s.code[0]

        @update
        def code_value():
            s.value @= 0
            if ~s.zero:
                s.value @= concat(s.distance[0:7], ~s.code[7]) + zext(s.single, 8)
            s.top @= 0
            for i in range(8):
                if s.value[i]:
                    s.top @= Bits3(i)
            s.near @= s.top <= zext(s.r, 3)
            s.width @= zext(s.r, 4) + 2 if s.near else concat(s.top, Bits1(1)) - zext(s.r, 4)
            if s.signs:
                s.width @= 1
            s.token @= zext(s.span | zext(s.run, 12), 27) << zext(s.width, 27)
            s.ahead @= (Bits8(2) << zext(s.r, 8)) if s.near & ~s.signs else Bits8(0)

        @update
        def choose():
            s.bits @= 0
            s.length @= 0
            if s.literal:
                s.length @= 8
                if ~(s.coded & s.zero):
                    s.bits @= zext(s.code, 27)
            elif s.zero & ~s.single:
                s.length @= zext(s.full, 5)
            else:
                s.bits @= s.token | zext(s.value | s.ahead, 27)
                s.length @= zext(s.width, 5) + zext(s.q, 5)
            s.after @= zext(s.credit, 9) + 33 - concat(Bits2(0), s.length, Bits2(0))

        @update_ff
        def advance():
            if s.reset | s.restart:
                s.k <<= Bits6(8) if s.dense else Bits6(16)
                s.r2 <<= 2
                s.run <<= 0
                s.credit <<= 128
            elif s.push & s.coded:
                if s.length == 0:
                    s.run <<= s.run + 1
                else:
                    s.run <<= 0
                    s.credit <<= Bits8(255) if s.after[8] else s.after[0:8]
                    if ~s.literal:
                        if s.zero:
                            if s.k[4:6] != 3:
                                s.k <<= s.k + (Bits6(1) if s.dense else Bits6(4))
                        elif s.dense:
                            s.k <<= Bits6(0) if s.k == 0 else s.k - 1
                        else:
                            s.k <<= Bits6(4) if s.q < 3 else s.k - 8
                        if ~s.zero | s.single:
                            if s.near:
                                s.r2 <<= Bits3(0) if s.r2 == 0 else s.r2 - 1
                            elif (s.top > zext(s.r, 3) + 1) & (s.r2 != 7):
                                s.r2 <<= s.r2 + 1

    def line_trace(s):
        return f"k{s.k}r{s.r2}n{s.run}c{s.credit}"
