"""RiceCoder at RTL: Golomb-Rice codes of runs and values, their parameters fixed or adaptive, in PayloadPacker."""

from pymtl3 import (
    Bits3,
    Bits4,
    Bits5,
    Bits7,
    Bits8,
    Bits9,
    Bits15,
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

from talbot.rtl.run_length.packer_rtl import PayloadPacker


class RiceCoder(Component):
    """Ports of TokenCoder. adaptive: the parameters follow the samples; else k = 4 and r = 3."""

    def construct(s, adaptive):
        # Interface
        s.restart = InPort()
        s.push = InPort()
        s.coded = InPort()
        s.threshold = InPort(Bits7)
        s.code = InPort(Bits8)
        s.bits = OutPort(Bits27)
        s.length = OutPort(Bits5)
        s.open = OutPort()

        # Components
        s.k = Wire(Bits3)
        s.r = Wire(Bits3)
        s.run = Wire(Bits7)

        s.span = Wire(Bits8)
        s.full = Wire()
        s.distance = Wire(Bits9)
        s.zero = Wire()
        s.quotient = Wire(Bits7)
        s.escape = Wire()
        s.ones = Wire(Bits8)
        s.value = Wire(Bits15)
        s.token = Wire(Bits27)
        s.width = Wire(Bits4)

        # Logic
        @update
        def classify():
            s.open @= s.run != 0
            s.span @= Bits8(1) << zext(s.k, 8)
            s.full @= (zext(s.run, 8) + 1) == s.span
            s.distance @= ((zext(~s.code, 9) + 1) if s.code[7] else zext(s.code, 9)) - zext(s.threshold, 9)
            if s.threshold == 0:
                s.distance @= s.distance - 1
            s.zero @= s.distance[8]

        @update
        def code_value():
            s.quotient @= s.distance[0:7] >> zext(s.r, 7)
            s.escape @= s.quotient[3:7] != 0
            s.ones @= (Bits8(1) << zext(s.quotient, 8)) - 1
            if s.escape:
                s.value @= concat(Bits8(0xFF), s.distance[0:7])
                s.width @= 15
            else:
                s.value @= ((zext(s.ones, 15) << 1) << zext(s.r, 15)) | zext(
                    s.distance[0:7] - (s.quotient << zext(s.r, 7)), 15
                )
                s.width @= s.quotient[0:4] + zext(s.r, 4) + 1
            s.token @= zext(concat(s.span | zext(s.run, 8), s.code[7]), 27) << zext(s.width, 27)

        @update
        def choose():
            s.bits @= 0
            s.length @= 0
            if ~s.coded:
                s.bits @= zext(s.code, 27)
                s.length @= 8
            elif s.zero:
                s.length @= zext(s.full, 5)
            else:
                s.bits @= s.token | zext(s.value, 27)
                s.length @= zext(s.width, 5) + zext(s.k, 5) + 2

        @update_ff
        def count():
            if s.reset | s.restart:
                s.run <<= 0
            elif s.push & s.coded:
                s.run <<= s.run + 1 if s.zero & ~s.full else Bits7(0)

        if adaptive:
            s.r2 = Wire(Bits4)
            s.r //= s.r2[1:4]

            @update_ff
            def adapt():
                if s.reset | s.restart:
                    s.k <<= 3
                    s.r2 <<= 4
                elif s.push & s.coded:
                    if s.zero & s.full & (s.k != 7):
                        s.k <<= s.k + 1
                    elif ~s.zero:
                        s.k <<= Bits3(0) if s.k < 2 else s.k - 2
                        if (s.quotient == 0) & (s.r2 != 0):
                            s.r2 <<= s.r2 - 1
                        elif (s.quotient > 1) & (s.r2 != 12):
                            s.r2 <<= s.r2 + 1
        else:
            s.k //= 4
            s.r //= 3

    def line_trace(s):
        return f"k{s.k}r{s.r}n{s.run}"


class FixedRicePacker(PayloadPacker):
    def new_coder(s):
        return RiceCoder(False)


class AdaptiveRicePacker(PayloadPacker):
    def new_coder(s):
        return RiceCoder(True)
